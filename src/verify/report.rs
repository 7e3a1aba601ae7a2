//! What a run found.

use super::task::{Exhibit, Size, Topic};
use crate::stats::{Check, Evidence, sidak};
use std::time::Duration;

/// The findings of one task.
#[derive(Clone, Debug)]
pub struct Section {
    /// What they are about.
    pub topic: Topic,
    /// What was checked.
    pub subject: String,
    /// The checks.
    pub checks: Vec<Check>,
    /// What to look at.
    pub exhibits: Vec<Exhibit>,
    /// Verdicts in words.
    pub words: Vec<String>,
    /// Time from the task's beginning to its end; others may have run on the same thread meanwhile.
    pub time: Duration,
}

/// What a run found, in the order of its tasks.
#[derive(Clone, Debug)]
pub struct Report {
    /// How much work it was.
    pub size: Size,
    /// Seed of all of it.
    pub seed: u64,
    /// Significance that all checks share.
    pub alpha: f64,
    /// A section a task.
    pub sections: Vec<Section>,
    /// Wall-clock time.
    pub time: Duration,
}

impl Report {
    /// All checks with their sections.
    pub fn checks(&self) -> impl Iterator<Item = (&Section, &Check)> {
        self.sections.iter().flat_map(|section| section.checks.iter().map(move |check| (section, check)))
    }

    /// The checks that chance could fail: what Šidák's correction counts.
    pub fn random(&self) -> usize {
        self.checks().filter(|(_, check)| !matches!(check.evidence, Evidence::Bound { .. })).count()
    }

    /// Smallest p with which a check passes.
    pub fn share(&self) -> f64 {
        sidak(self.alpha, self.random())
    }

    /// The checks that fail.
    pub fn failures(&self) -> impl Iterator<Item = (&Section, &Check)> {
        let share = self.share();
        self.checks().filter(move |(_, check)| check.p() < share)
    }

    /// True where no check fails. A run without checks has shown nothing and does not pass.
    pub fn passes(&self) -> bool {
        self.checks().next().is_some() && self.failures().next().is_none()
    }
}
