//! How far a render is, on stderr: a bar on a terminal, now and then a line elsewhere.

use indicatif::{ProgressBar, ProgressStyle};
use radianza::render::Progress;
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::Duration;

/// To the first line, and between two, where stderr is no terminal.
const FIRST: Duration = Duration::from_secs(1);
const INTERVAL: Duration = Duration::from_secs(5);

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Where progress goes.
pub(super) struct Report {
    sink: Sink,
    limit: Option<Duration>,
}

enum Sink {
    Silent,
    Bar(ProgressBar),
    /// When the next line is due, since the start.
    Lines(Mutex<Duration>),
}

impl Report {
    /// `limit`: the time after which the render ends.
    pub(super) fn new(quiet: bool, limit: Option<Duration>) -> Self {
        let sink = match quiet {
            true => Sink::Silent,
            false if std::io::stderr().is_terminal() => {
                let bar = ProgressBar::new(STEPS);
                if let Ok(style) = ProgressStyle::with_template("{bar:24} {percent:>3} %  {msg}") {
                    bar.set_style(style);
                }
                Sink::Bar(bar)
            }
            false => Sink::Lines(Mutex::new(FIRST)),
        };
        Self { sink, limit }
    }

    /// Takes the news, from any thread.
    pub(super) fn update(&self, progress: &Progress) {
        match &self.sink {
            Sink::Silent => {}
            Sink::Bar(bar) => {
                bar.set_position((self.fraction(progress) * STEPS as f64) as u64);
                bar.set_message(self.line(progress));
            }
            Sink::Lines(due) => {
                let Ok(mut due) = due.try_lock() else { return };
                if progress.elapsed >= *due {
                    *due = progress.elapsed + INTERVAL;
                    eprintln!("{:.1} %  {}", 100.0 * self.fraction(progress), self.line(progress));
                }
            }
        }
    }

    /// Takes the bar away.
    pub(super) fn finish(&self) {
        if let Sink::Bar(bar) = &self.sink {
            bar.finish_and_clear();
        }
    }

    /// Of the samples or of the time, whichever ends first.
    fn fraction(&self, p: &Progress) -> f64 {
        let samples = p.samples as f64 / p.total.max(1) as f64;
        let time = self.limit.map_or(0.0, |limit| p.elapsed.as_secs_f64() / limit.as_secs_f64());
        samples.max(time).min(1.0)
    }

    fn line(&self, p: &Progress) -> String {
        let fraction = self.fraction(p);
        let left = match p.elapsed.as_secs_f64() * (1.0 - fraction) / fraction.max(1e-9) {
            seconds if seconds > 0.0 => format!("{} left", time(seconds)),
            _ => "finishing the pass".into(),
        };
        let error = if p.relative_error.is_finite() {
            format!(", error {:.3} %", 100.0 * p.relative_error)
        } else {
            String::new()
        };
        format!("{}{error}, {left}", speed(p.samples, p.rays, p.elapsed))
    }
}

/// Samples, and samples and rays per second.
pub(super) fn speed(samples: u64, rays: u64, elapsed: Duration) -> String {
    let per_second = |n: u64| n as f64 / elapsed.as_secs_f64().max(1e-9) / 1e6;
    let (s, r) = (per_second(samples), per_second(rays));
    format!("{:.1} Msamples, {s:.2} Msamples/s, {r:.2} Mrays/s", samples as f64 / 1e6)
}

/// Seconds for people.
pub(super) fn time(seconds: f64) -> String {
    match seconds {
        s if s < 60.0 => format!("{s:.1} s"),
        s if s < 3600.0 => format!("{:.0} min {:02.0} s", (s / 60.0).floor(), (s % 60.0).floor()),
        s => format!("{:.0} h {:02.0} min", (s / 3600.0).floor(), (s % 3600.0 / 60.0).floor()),
    }
}
