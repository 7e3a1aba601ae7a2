//! How far a render is.

use super::meter::{Meter, left, time};
use radianza::render::Progress;
use std::time::Duration;

/// Progress of a render.
pub(super) struct Report {
    meter: Meter,
    limit: Option<Duration>,
}

impl Report {
    /// `limit`: the time after which the render ends.
    pub(super) fn new(quiet: bool, limit: Option<Duration>) -> Self {
        Self { meter: Meter::new(quiet), limit }
    }

    /// Takes the news, from any thread.
    pub(super) fn update(&self, progress: &Progress) {
        let fraction = self.fraction(progress);
        self.meter.update(progress.elapsed, fraction, || line(progress, fraction));
    }

    /// Takes the bar away.
    pub(super) fn finish(&self) {
        self.meter.finish();
    }

    /// Of the samples or of the time, whichever ends first.
    fn fraction(&self, p: &Progress) -> f64 {
        let samples = p.samples as f64 / p.total.max(1) as f64;
        let time = self.limit.map_or(0.0, |limit| p.elapsed.as_secs_f64() / limit.as_secs_f64());
        samples.max(time).min(1.0)
    }
}

fn line(p: &Progress, fraction: f64) -> String {
    let left = match left(p.elapsed, fraction) {
        seconds if seconds > 0.0 => format!("{} left", time(seconds)),
        _ => "finishing the pass".into(),
    };
    let error =
        if p.relative_error.is_finite() { format!(", error {:.3} %", 100.0 * p.relative_error) } else { String::new() };
    format!("{}{error}, {left}", speed(p.samples, p.rays, p.elapsed))
}

/// Samples, and samples and rays per second.
pub(super) fn speed(samples: u64, rays: u64, elapsed: Duration) -> String {
    let per_second = |n: u64| n as f64 / elapsed.as_secs_f64().max(1e-9) / 1e6;
    let (s, r) = (per_second(samples), per_second(rays));
    format!("{:.1} Msamples, {s:.2} Msamples/s, {r:.2} Mrays/s", samples as f64 / 1e6)
}
