//! How far a command is, on stderr: a bar on a terminal, now and then a line elsewhere.

use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::Duration;

/// To the first line, and between two, where stderr is no terminal.
const FIRST: Duration = Duration::from_secs(1);
const INTERVAL: Duration = Duration::from_secs(5);

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Where progress goes.
pub(super) enum Meter {
    /// Nowhere.
    Silent,
    /// To a terminal.
    Bar(ProgressBar),
    /// To a file or a pipe; when the next line is due, since the start.
    Lines(Mutex<Duration>),
}

impl Meter {
    pub(super) fn new(quiet: bool) -> Self {
        match quiet {
            true => Self::Silent,
            false if std::io::stderr().is_terminal() => {
                let bar = ProgressBar::new(STEPS);
                if let Ok(style) = ProgressStyle::with_template("{bar:24} {percent:>3} %  {wide_msg}") {
                    bar.set_style(style);
                }
                Self::Bar(bar)
            }
            false => Self::Lines(Mutex::new(FIRST)),
        }
    }

    /// Takes the news, from any thread: how much of it all is done after which time, and that in words.
    pub(super) fn update(&self, elapsed: Duration, fraction: f64, line: impl FnOnce() -> String) {
        match self {
            Self::Silent => {}
            Self::Bar(bar) => {
                bar.set_position((fraction * STEPS as f64) as u64);
                bar.set_message(line());
            }
            Self::Lines(due) => {
                let Ok(mut due) = due.try_lock() else { return };
                if elapsed >= *due {
                    *due = elapsed + INTERVAL;
                    eprintln!("{:.1} %  {}", 100.0 * fraction, line());
                }
            }
        }
    }

    /// Takes the bar away.
    pub(super) fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

/// Time that is left where `fraction` took `elapsed`, in seconds.
pub(super) fn left(elapsed: Duration, fraction: f64) -> f64 {
    elapsed.as_secs_f64() * (1.0 - fraction) / fraction.max(1e-9)
}

/// Seconds for people.
pub(super) fn time(seconds: f64) -> String {
    match seconds {
        s if s < 60.0 => format!("{s:.1} s"),
        s if s < 3600.0 => format!("{:.0} min {:02.0} s", (s / 60.0).floor(), (s % 60.0).floor()),
        s => format!("{:.0} h {:02.0} min", (s / 3600.0).floor(), (s % 3600.0 / 60.0).floor()),
    }
}
