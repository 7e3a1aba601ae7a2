//! Axes.

use maud::{Markup, html};

/// The drawing, in its own units, and the room for what stands beside the axes.
const SIZE: [f64; 2] = [380.0, 260.0];
const LEFT: f64 = 64.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 44.0;

/// Steps between ticks, at most.
const TICKS: f64 = 6.0;

/// What the axes span.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chart {
    x: Axis,
    y: Axis,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Axis {
    from: f64,
    to: f64,
    step: f64,
}

impl Axis {
    /// Around what is finite of `values`; grown to whole steps of 1, 2 or 5 times a power of ten.
    fn around(values: impl Iterator<Item = f64>) -> Self {
        let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.filter(|value| value.is_finite()) {
            (from, to) = (from.min(value), to.max(value));
        }
        if from > to {
            (from, to) = (0.0, 1.0);
        }
        // One value, or several that rounding alone tells apart.
        if to - from <= 1e-9 * from.abs().max(to.abs()) {
            let around = if to == 0.0 { 1.0 } else { 0.01 * to.abs() };
            (from, to) = (from - around, to + around);
        }
        let rough = (to - from) / TICKS;
        let power = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|k| k * power).into_iter().find(|step| *step >= rough).unwrap_or(rough);
        Self { from: (from / step).floor() * step, to: (to / step).ceil() * step, step }
    }

    fn ticks(&self) -> Vec<(f64, String)> {
        let n = ((self.to - self.from) / self.step).round() as usize;
        let decimals = (-self.step.log10().floor()).clamp(0.0, 9.0) as usize;
        let tick = |i| {
            let value = self.from + i as f64 * self.step;
            // Rounding of 0 has no sign.
            let value = if value.abs() < 1e-6 * self.step { 0.0 } else { value };
            (value, if value.abs() >= 1e5 { format!("{value:.1e}") } else { format!("{value:.decimals$}") })
        };
        (0..=n.min(2 * TICKS as usize)).map(tick).collect()
    }

    fn share(&self, value: f64) -> f64 {
        (value - self.from) / (self.to - self.from)
    }
}

impl Chart {
    /// Axes around all finite values.
    pub(super) fn around(x: impl Iterator<Item = f64>, y: impl Iterator<Item = f64>) -> Self {
        Self { x: Axis::around(x), y: Axis::around(y) }
    }

    /// Place of a point in the drawing.
    pub(super) fn at(&self, x: f64, y: f64) -> [f64; 2] {
        let [w, h] = SIZE;
        [LEFT + self.x.share(x) * (w - LEFT - RIGHT), h - BOTTOM - self.y.share(y) * (h - TOP - BOTTOM)]
    }

    /// The drawing: grid, ticks, names of the axes, and `content` within.
    pub(super) fn draw(&self, description: &str, axes: [&str; 2], content: &Markup) -> Markup {
        let [w, h] = SIZE;
        let [left, right, top, bottom] = [LEFT, w - RIGHT, TOP, h - BOTTOM].map(px);
        html! {
            svg.chart viewBox={ "0 0 " (w) " " (h) } role="img" aria-label=(description) {
                @for (x, label) in self.x.ticks() {
                    @let [at, _] = self.at(x, self.y.from).map(px);
                    line.grid x1=(at) x2=(at) y1=(top) y2=(bottom) {}
                    text x=(at) y=(px(h - BOTTOM + 16.0)) text-anchor="middle" { (label) }
                }
                @for (y, label) in self.y.ticks() {
                    @let [_, at] = self.at(self.x.from, y);
                    line.grid x1=(left) x2=(right) y1=(px(at)) y2=(px(at)) {}
                    text x=(px(LEFT - 5.0)) y=(px(at + 4.0)) text-anchor="end" { (label) }
                }
                text x=(px(0.5 * (LEFT + w - RIGHT))) y=(px(h - 8.0)) text-anchor="middle" { (axes[0]) }
                text transform={ "translate(11 " (px(0.5 * (TOP + h - BOTTOM))) ") rotate(-90)" } text-anchor="middle" {
                    (axes[1])
                }
                (content)
            }
        }
    }
}

/// A coordinate, short.
pub(super) fn px(x: f64) -> String {
    format!("{x:.1}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(values: &[f64]) -> Vec<String> {
        Axis::around(values.iter().copied()).ticks().into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_numbers_around_all() {
        assert_eq!(labels(&[0.0, 1.0]), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(&[-0.03, 0.03]), ["-0.03", "-0.02", "-0.01", "0.00", "0.01", "0.02", "0.03"]);
        assert_eq!(labels(&[0.99991, 1.00004]).first().map(String::as_str), Some("0.99990"));
        assert_eq!(labels(&[f64::NAN, 0.0, 90.0]).len(), 6);
    }

    #[test]
    fn axes_without_extent_are_given_one() {
        for values in [&[][..], &[f64::NAN], &[0.0], &[1.0, 1.0 + 1e-12], &[-5.0], &[f64::INFINITY, 1e300]] {
            let axis = Axis::around(values.iter().copied());
            assert!(axis.from < axis.to && axis.step > 0.0 && !axis.ticks().is_empty(), "{values:?} {axis:?}");
        }
    }
}
