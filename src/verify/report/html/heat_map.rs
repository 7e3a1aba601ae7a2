//! Counts of a goodness-of-fit test: observed, expected, and how far they are apart.

use super::super::one_line;
use super::picture::{NONE, png};
use crate::verify::HeatMap;
use maud::{Markup, html};

/// |(observed − expected)/√expected| that has the full colour.
const FULL: f64 = 4.0;

/// Where nothing is expected, and nothing found.
const EMPTY: [u8; 3] = [128; 3];

/// From least to most (anchors of viridis; van der Walt & Smith 2015, in the public domain).
const COUNTS: [[u8; 3]; 5] = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];

/// From too few over as many as expected to too many.
const RESIDUALS: [[u8; 3]; 3] = [[33, 102, 172], [247, 247, 247], [178, 24, 43]];

pub(super) fn draw(map: &HeatMap) -> Markup {
    let columns = map.columns.max(1);
    let rows = map.observed.len().div_ceil(columns);
    let bins: Vec<[f64; 2]> = (0..columns * rows)
        .map(|i| [&map.observed, &map.expected].map(|counts| counts.get(i).copied().unwrap_or(f64::NAN)))
        .collect();
    let most = bins.iter().flatten().copied().filter(|c| c.is_finite()).fold(1.0, f64::max);
    let panel = |name: &str, color: &dyn Fn(&[f64; 2]) -> [u8; 3]| {
        let bytes: Vec<u8> = bins.iter().flat_map(color).collect();
        png([columns as u32, rows as u32], &bytes, "map", &format!("{}: {name}", one_line(&map.title)))
    };
    let count = |c: f64| if c.is_finite() { ramp(&COUNTS, c / most) } else { NONE };
    let most = format!("{most:.0}");
    let full = format!("{FULL}");
    html! {
        div.maps {
            div { "observed" (panel("observed", &|bin| count(bin[0]))) (scale(&COUNTS, ["0", &most])) }
            div { "expected" (panel("expected", &|bin| count(bin[1]))) (scale(&COUNTS, ["0", &most])) }
            div {
                "(o − e)/√e" (panel("residuals", &residual_color))
                (scale(&RESIDUALS, [&format!("−{full}"), &format!("+{full}")]))
            }
        }
        p { (columns) "×" (rows) " bins; across: " (map.axes[0]) ", down: " (map.axes[1]) "." (worst(&bins)) }
    }
}

/// The bin that is farthest from its expectation.
fn worst(bins: &[[f64; 2]]) -> Markup {
    let residual = |bin: &&[f64; 2]| ((bin[0] - bin[1]) / bin[1].sqrt()).abs();
    // Pearson's residual is nearly normal where at least 5 are expected.
    let worst = bins.iter().filter(|bin| bin[1] >= 5.0).max_by(|a, b| residual(a).total_cmp(&residual(b)));
    html! {
        @if let Some([observed, expected]) = worst {
            " Farthest: " (format!("{observed:.0} of {expected:.1}")) "."
        }
    }
}

fn residual_color(&[observed, expected]: &[f64; 2]) -> [u8; 3] {
    match (observed - expected) / expected.sqrt() {
        _ if observed == 0.0 && expected == 0.0 => EMPTY,
        residual if residual.is_finite() => ramp(&RESIDUALS, 0.5 + 0.5 * residual / FULL),
        _ => NONE,
    }
}

/// Between the two anchors beside `share`.
fn ramp<const N: usize>(anchors: &[[u8; 3]; N], share: f64) -> [u8; 3] {
    let at = share.clamp(0.0, 1.0) * (N - 1) as f64;
    let i = (at.floor() as usize).min(N - 2);
    let t = at - i as f64;
    std::array::from_fn(|c| (f64::from(anchors[i][c]) * (1.0 - t) + f64::from(anchors[i + 1][c]) * t).round() as u8)
}

/// The colours from end to end.
fn scale<const N: usize>(anchors: &[[u8; 3]; N], ends: [&str; 2]) -> Markup {
    const STEPS: u32 = 32;
    let bytes: Vec<u8> = (0..STEPS).flat_map(|i| ramp(anchors, f64::from(i) / f64::from(STEPS - 1))).collect();
    html! { div.scale { span { (ends[0]) } (png([STEPS, 1], &bytes, "scale", "colours from end to end")) span { (ends[1]) } } }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_say_more_and_less() {
        assert_eq!(residual_color(&[0.0, 0.0]), EMPTY);
        assert_eq!(residual_color(&[1.0, 0.0]), NONE);
        assert_eq!(residual_color(&[100.0, 100.0]), RESIDUALS[1]);
        assert_eq!([residual_color(&[0.0, 100.0]), residual_color(&[200.0, 100.0])], [RESIDUALS[0], RESIDUALS[2]]);
        assert_eq!(ramp(&COUNTS, 0.25), COUNTS[1]);
    }

    #[test]
    fn maps_of_any_size_are_drawn() {
        let map = |columns, observed: &[f64], expected: &[f64]| HeatMap {
            title: "t".into(),
            axes: ["φ", "θ"],
            columns,
            observed: observed.into(),
            expected: expected.into(),
        };
        let text = draw(&map(2, &[9.0, 30.0, 0.0], &[10.0, 10.0])).into_string();
        assert!(text.contains("2×2 bins; across: φ, down: θ. Farthest: 30 of 10.0."), "{text}");
        assert!(draw(&map(0, &[], &[])).into_string().contains("without pixels"));
    }
}
