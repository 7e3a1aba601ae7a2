//! Lines with error bars.

use super::super::one_line;
use super::chart::{Chart, px};
use crate::verify::Curve;
use maud::{Markup, html};

/// Colours that are told apart by all eyes, on white and on black, and dashes where they come again (Okabe & Ito 2008,
/// the light ones darkened).
const COLORS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#c4689a", "#8c6d1f", "#6f5fd6", "#7f7f7f"];
const DASHES: [&str; 3] = ["none", "6 3", "2 3"];

/// Most points of a line that are drawn, and most lines.
const POINTS: usize = 128;
const LINES: usize = COLORS.len() * DASHES.len();

/// Standard errors to the end of a bar.
const BARS: f64 = 2.0;

type Line = (String, Vec<[f64; 3]>);

pub(super) fn draw(curve: &Curve) -> Markup {
    let lines = &curve.lines[..curve.lines.len().min(LINES)];
    let points = || lines.iter().flat_map(|(_, points)| points).filter(|p| drawable(p));
    let ends = |[_, y, se]: &[f64; 3]| [y - BARS * bar(*se), y + BARS * bar(*se)];
    let chart = Chart::around(points().map(|p| p[0]), points().flat_map(ends));
    let content = html! { @for (i, line) in lines.iter().enumerate() { (draw_line(&chart, i, line)) } };
    let missing = lines.iter().flat_map(|(_, points)| points).filter(|p| !drawable(p)).count();
    let description = format!("{}: {} against {}", one_line(&curve.title), curve.axes[1], curve.axes[0]);
    html! {
        (chart.draw(&description, curve.axes, &content))
        ul.legend {
            @for (i, (name, _)) in lines.iter().enumerate() {
                li {
                    svg viewBox="0 0 32 12" aria-hidden="true" {
                        line x1="0" x2="32" y1="6" y2="6" stroke=(color(i)) stroke-width="3" stroke-dasharray=(dash(i)) {}
                    }
                    (one_line(name))
                }
            }
        }
        @if points().any(|p| p[2] > 0.0) { p { "Bars: ± 2 standard errors." } }
        @if missing > 0 { p { (missing) " values are not finite." } }
        @if curve.lines.len() > LINES { p { (curve.lines.len() - LINES) " more lines are left out." } }
    }
}

fn draw_line(chart: &Chart, i: usize, (name, points): &Line) -> Markup {
    let stride = points.len().div_ceil(POINTS).max(1);
    let points: Vec<[f64; 3]> = points.iter().step_by(stride).copied().collect();
    // A value that is not finite is a gap.
    let runs = points.split(|p| !drawable(p)).filter(|run| !run.is_empty());
    let place = |p: &[f64; 3]| chart.at(p[0], p[1]).map(px).join(",");
    html! {
        g stroke=(color(i)) fill="none" {
            title { (one_line(name)) }
            @for run in runs {
                polyline points=(run.iter().map(place).collect::<Vec<_>>().join(" ")) stroke-width="1.6"
                    stroke-dasharray=(dash(i)) {}
                path stroke-width="1.2" d=(run.iter().map(|p| bar_path(chart, p)).collect::<String>()) {}
                // Lines of no length with round ends are dots.
                path stroke-width="4.5" stroke-linecap="round" d=(run.iter().map(|p| dot(chart, p)).collect::<String>()) {}
            }
        }
    }
}

fn bar_path(chart: &Chart, &[x, y, se]: &[f64; 3]) -> String {
    if bar(se) == 0.0 {
        return String::new();
    }
    let ([x, low], [_, high]) = (chart.at(x, y - BARS * se), chart.at(x, y + BARS * se));
    let (low, high) = (px(low), px(high));
    let [left, middle, right] = [x - 3.0, x, x + 3.0].map(px);
    format!("M{left},{low}H{right}M{left},{high}H{right}M{middle},{low}V{high}")
}

fn dot(chart: &Chart, p: &[f64; 3]) -> String {
    let [x, y] = chart.at(p[0], p[1]).map(px);
    format!("M{x},{y}h0")
}

fn drawable(p: &[f64; 3]) -> bool {
    p[0].is_finite() && p[1].is_finite()
}

fn bar(se: f64) -> f64 {
    if se.is_finite() { se.max(0.0) } else { 0.0 }
}

fn color(i: usize) -> &'static str {
    COLORS[i % COLORS.len()]
}

fn dash(i: usize) -> &'static str {
    DASHES[i / COLORS.len() % DASHES.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_bars_and_a_legend() {
        let points = vec![[0.0, 1.0, 0.1], [1.0, f64::NAN, 0.1], [2.0, 3.0, f64::INFINITY], [3.0, 3.0, 0.0]];
        let lines = vec![("a < b".to_string(), points), ("empty".to_string(), vec![])];
        let text = draw(&Curve { title: "t".into(), axes: ["x", "y"], lines }).into_string();
        assert_eq!((text.matches("<polyline").count(), text.matches("<li>").count()), (2, 2), "{text}");
        assert!(
            text.contains("1 values are not finite") && text.contains("a &lt; b") && !text.contains("NaN"),
            "{text}"
        );
    }

    #[test]
    fn long_lines_are_thinned() {
        let points = (0..10_000).map(|i| [i.into(), 0.5, 0.0]).collect();
        let text =
            draw(&Curve { title: "t".into(), axes: ["x", "y"], lines: vec![("a".into(), points)] }).into_string();
        assert!(text.len() < 8000, "{}", text.len());
    }
}
