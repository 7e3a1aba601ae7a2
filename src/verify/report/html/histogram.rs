//! All z of a run beside the standard normal that they should follow.

use super::super::{Report, count};
use super::chart::{Chart, px};
use crate::stats::{Moments, normal_cdf, two_sided_p};
use maud::{Markup, html};

/// Width of a bar, and how many there are to each side of 0.
const WIDTH: f64 = 0.25;
const HALF: usize = 24;

/// What z-values there are: those of checks that chance decides, and whose errors are not widened on purpose.
struct Sample {
    /// Finite and not 0: 0 is what rounding makes of equal numbers.
    z: Vec<f64>,
    /// Exactly 0.
    zero: usize,
    /// Infinite, or not a number.
    beyond: usize,
    /// Of checks whose errors are widened.
    guarded: usize,
}

impl Sample {
    fn new(report: &Report) -> Self {
        let mut sample = Self { z: Vec::new(), zero: 0, beyond: 0, guarded: 0 };
        for (section, z) in report.checks().filter_map(|(section, check)| Some((section, check.z()?))) {
            match z {
                _ if section.guarded => sample.guarded += 1,
                0.0 => sample.zero += 1,
                z if z.is_finite() => sample.z.push(z),
                _ => sample.beyond += 1,
            }
        }
        sample
    }

    /// Counts by bar; the outermost ones hold what lies beyond them.
    fn counts(&self) -> [usize; 2 * HALF] {
        let mut counts = [0; 2 * HALF];
        for z in &self.z {
            let bar = (z / WIDTH).floor() + HALF as f64;
            counts[bar.clamp(0.0, (2 * HALF - 1) as f64) as usize] += 1;
        }
        counts
    }

    /// Share beyond a |z|, and what the normal promises.
    fn beyond(&self, limit: f64) -> [f64; 2] {
        let n = self.z.iter().filter(|z| z.abs() > limit).count();
        [n as f64 / self.z.len().max(1) as f64, two_sided_p(limit)].map(|share| 100.0 * share)
    }
}

/// The figure with what it shows in numbers.
pub(super) fn section(report: &Report) -> Markup {
    let sample = Sample::new(report);
    let (n, limit) = (sample.z.len(), report.z_limit());
    let moments: Moments = sample.z.iter().copied().filter(|z| z.abs() <= limit).collect();
    html! {
        section #distribution {
            h2 { "Distribution of z" }
            @if n == 0 { p { "No check of this run has a z." } } @else {
                p {
                    (count(n)) " values of z; " (count(moments.n() as usize)) " are within the limit, with mean "
                    (format!("{:+.3}", moments.mean())) " and standard deviation "
                    (format!("{:.3}", moments.variance().sqrt())) ". Of right checks they follow the standard normal (the line). "
                    @for limit in [2.0, 3.0] {
                        @let [found, promised] = sample.beyond(limit);
                        "|z| > " (limit) ": " (format!("{found:.2}")) " %, promised " (format!("{promised:.2}")) " %. "
                    }
                    "Checks that share samples are not independent."
                }
                (draw(&sample, limit))
            }
            @if sample.zero > 0 { p.faint { (count(sample.zero)) " checks differ by rounding at most and are left out." } }
            @if sample.guarded > 0 {
                p.faint {
                    (count(sample.guarded)) " checks of rendered images are left out: their errors are widened for events that no "
                    "sample has met, so that their z spread less."
                }
            }
            @if sample.beyond > 0 { p { (count(sample.beyond)) " checks have a z that is not finite." } }
        }
    }
}

fn draw(sample: &Sample, limit: f64) -> Markup {
    let n = sample.z.len() as f64;
    let end = HALF as f64 * WIDTH;
    let counts = sample.counts();
    let density = |z: f64| n * (normal_cdf(z + 0.5 * WIDTH) - normal_cdf(z - 0.5 * WIDTH));
    let most = counts.iter().map(|&c| c as f64).fold(density(0.0), f64::max);
    let chart = Chart::around([-end, end].into_iter(), [0.0, most].into_iter());
    let law: Vec<String> =
        (-60..=60).map(|i| chart.at(0.1 * f64::from(i), density(0.1 * f64::from(i))).map(px).join(",")).collect();
    let content = html! {
        @for (i, &bar) in counts.iter().enumerate().filter(|(_, bar)| **bar > 0) {
            @let from = (i as f64 - HALF as f64) * WIDTH;
            @let [left, top] = chart.at(from, bar as f64);
            @let [right, bottom] = chart.at(from + WIDTH, 0.0);
            rect.bar x=(px(left + 0.5)) y=(px(top)) width=(px(right - left - 1.0)) height=(px(bottom - top)) {
                title { (format!("{from} to {}: {bar}, expected {:.1}", from + WIDTH, density(from + 0.5 * WIDTH))) }
            }
        }
        polyline.law points=(law.join(" ")) {}
        @for limit in [-limit, limit].into_iter().filter(|limit| limit.abs() <= end) {
            @let [x, bottom] = chart.at(limit, 0.0).map(px);
            line.limit x1=(x) x2=(x) y1=(bottom) y2="12" { title { "limit of |z|" } }
        }
    };
    chart.draw("Histogram of z with the standard normal", ["z (dashed: the limit)", "checks"], &content)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_go_to_their_bars() {
        let sample = Sample { z: vec![-100.0, -0.1, 0.1, 0.2, 100.0], zero: 0, beyond: 0, guarded: 0 };
        let counts = sample.counts();
        assert_eq!([0, HALF - 1, HALF, 2 * HALF - 1].map(|i| counts[i]), [1, 1, 2, 1]);
        assert_eq!(counts.iter().sum::<usize>(), 5);
        assert!((sample.beyond(2.0)[0] - 40.0).abs() < 1e-9);
    }
}
