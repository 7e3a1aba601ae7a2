//! Work that makes checks, and running it.

use super::report::{Report, Section};
use crate::stats::Family;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// What some checks are about: a row of the table of closed forms, or a part of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Topic {
    /// Short name that `--only` takes: `A1`, `F2`, `light`.
    pub id: &'static str,
    /// What must hold, in words and as a formula.
    pub title: &'static str,
    /// Where it comes from.
    pub source: &'static str,
}

/// How much work a run is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Size {
    /// An eighth of the default: a look while working. Large faults are found, small biases are not.
    Quick,
    /// About a minute on two cores.
    #[default]
    Default,
    /// A quarter of an hour on two cores: more members, smaller detectable biases.
    Thorough,
}

/// What a task knows when it runs.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Seed of this task alone: made of the run's seed and the task's name, so that no two tasks share numbers and none
    /// depends on which others run.
    pub seed: u64,
    /// How much work is wanted.
    pub size: Size,
}

impl Size {
    /// Its name in reports, and as a flag of the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Quick => "quick",
            Self::Default => "default",
            Self::Thorough => "thorough",
        }
    }
}

impl Trial {
    /// This trial with a seed for a part of the task, so that its parts share no numbers.
    pub fn part(&self, name: &str) -> Self {
        Self { seed: stream(self.seed, name), ..*self }
    }

    /// The one or the other, by size; what a quick run looks at is what the default one does.
    pub fn pick<T>(&self, default: T, thorough: T) -> T {
        match self.size {
            Size::Quick | Size::Default => default,
            Size::Thorough => thorough,
        }
    }

    /// A number of samples, rays, points, by size: an eighth in a quick run, but at least one.
    pub fn work<T: Amount>(&self, default: T, thorough: T) -> T {
        match self.size {
            Size::Quick => default.eighth(),
            _ => self.pick(default, thorough),
        }
    }

    /// A bias to detect, by size: what an eighth of the samples finds, √8 times as large, in a quick run.
    pub fn aim(&self, default: f64, thorough: f64) -> f64 {
        match self.size {
            Size::Quick => 8f64.sqrt() * default,
            _ => self.pick(default, thorough),
        }
    }
}

/// How much of something is done.
pub trait Amount: Copy {
    /// An eighth of it, at least one where it is counted.
    fn eighth(self) -> Self;
}

macro_rules! counted {
    ($($count:ty),*) => {
        $(impl Amount for $count {
            fn eighth(self) -> Self {
                (self / 8).max(1)
            }
        })*
    };
}

counted!(i32, u32, u64, usize);

impl Amount for f64 {
    fn eighth(self) -> Self {
        self / 8.0
    }
}

/// What a task found.
#[derive(Clone, Debug)]
pub struct Findings {
    /// The checks.
    pub checks: Family,
    /// What to look at.
    pub exhibits: Vec<Exhibit>,
    /// Verdicts in words, a sentence each.
    pub words: Vec<String>,
    /// Standard errors are widened on purpose, for rare events that no sample has met ([`super::tiles::unseen`]): the
    /// z of these checks spread less than the normal.
    pub guarded: bool,
}

impl Findings {
    /// Nothing found yet.
    pub fn new(name: impl Into<String>) -> Self {
        Self { checks: Family::new(name), exhibits: Vec::new(), words: Vec::new(), guarded: false }
    }
}

/// Something to look at in a report.
#[derive(Clone, Debug)]
pub enum Exhibit {
    /// Lines over a common abscissa.
    Curve(Curve),
    /// Counts of a goodness-of-fit test.
    HeatMap(HeatMap),
    /// Pixels.
    Picture(Picture),
    /// Text to be copied.
    Listing(Listing),
}

/// Lines over a common abscissa.
#[derive(Clone, Debug)]
pub struct Curve {
    /// What is shown.
    pub title: String,
    /// Names of the axes.
    pub axes: [&'static str; 2],
    /// Name and points (x, y, standard error of y) of each line.
    pub lines: Vec<(String, Vec<[f64; 3]>)>,
}

/// Counts of a goodness-of-fit test on a rectangle of bins, row by row.
#[derive(Clone, Debug)]
pub struct HeatMap {
    /// What is shown.
    pub title: String,
    /// What runs across and what runs down.
    pub axes: [&'static str; 2],
    /// Bins across.
    pub columns: usize,
    /// Counts that were observed.
    pub observed: Vec<f64>,
    /// Counts that the density promises.
    pub expected: Vec<f64>,
}

/// Linear RGB pixels, row by row.
#[derive(Clone, Debug)]
pub struct Picture {
    /// What is shown.
    pub title: String,
    /// Width and height.
    pub size: [u32; 2],
    /// Values; 1 is white.
    pub pixels: Vec<[f32; 3]>,
}

/// A text of several lines to be copied, such as a scene file.
#[derive(Clone, Debug)]
pub struct Listing {
    /// What it is.
    pub title: String,
    /// Its lines.
    pub text: String,
}

type Work = Box<dyn Fn(&Trial, &mut Findings) + Send + Sync>;

/// A piece of work that makes checks about one subject.
pub struct Task {
    /// What the checks are about.
    pub topic: Topic,
    /// What is checked: a lobe, a scene, a light and a place.
    pub subject: String,
    work: Work,
}

impl Task {
    /// A task that is not yet done.
    pub fn new(
        topic: Topic,
        subject: impl Into<String>,
        work: impl Fn(&Trial, &mut Findings) + Send + Sync + 'static,
    ) -> Self {
        Self { topic, subject: subject.into(), work: Box::new(work) }
    }

    /// `A5/white conductor α 0.1`: what filters match and seeds are made of.
    pub fn name(&self) -> String {
        format!("{}/{}", self.topic.id, self.subject)
    }

    /// True where one of the patterns is part of the name, whatever the case; every task matches no patterns at all.
    pub fn matches(&self, patterns: &[String]) -> bool {
        let name = self.name().to_lowercase();
        patterns.is_empty() || patterns.iter().any(|pattern| name.contains(&pattern.to_lowercase()))
    }
}

/// How far a run is.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Tasks done.
    pub done: usize,
    /// Tasks in all.
    pub total: usize,
    /// The task that ended last.
    pub last: &'a Task,
}

impl std::fmt::Debug for Task {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Task").field(&self.name()).finish()
    }
}

/// Does all tasks on the threads of the current rayon pool. The checks depend on `seed` and `size` alone.
pub fn run(tasks: &[Task], size: Size, seed: u64, alpha: f64, progress: &(dyn Fn(&Progress) + Sync)) -> Report {
    let start = Instant::now();
    let done = AtomicUsize::new(0);
    let one = |task: &Task| {
        let begin = Instant::now();
        let mut findings = Findings::new(task.name());
        (task.work)(&Trial { seed: stream(seed, &task.name()), size }, &mut findings);
        progress(&Progress { done: done.fetch_add(1, Ordering::Relaxed) + 1, total: tasks.len(), last: task });
        Section {
            topic: task.topic,
            subject: task.subject.clone(),
            checks: findings.checks.into_checks(),
            exhibits: findings.exhibits,
            words: findings.words,
            guarded: findings.guarded,
            time: begin.elapsed(),
        }
    };
    let sections = tasks.par_iter().with_max_len(1).map(one).collect();
    Report { size, seed, alpha, sections, notes: Vec::new(), time: start.elapsed() }
}

/// A seed of (seed, name): FNV-1a over the name, mixed with the seed (Steele, Lea & Flood 2014, the finaliser of
/// SplitMix).
fn stream(seed: u64, name: &str) -> u64 {
    let hash =
        name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |h, byte| (h ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
    let mut x = hash ^ seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOPIC: Topic = Topic { id: "X9", title: "", source: "" };

    fn task(subject: &str, estimate: f64) -> Task {
        Task::new(TOPIC, subject, move |trial, found| {
            found.checks.estimate("one", 1.0, estimate, 0.01);
            found.checks.holds("seeded", trial.seed != 0);
        })
    }

    #[test]
    fn a_run_fails_by_its_worst_check() {
        let good = run(&[task("a", 1.01), task("b", 0.99)], Size::Default, 1, 1e-4, &|_| {});
        assert!(good.passes() && good.checks().count() == 4);
        let bad = run(&[task("a", 1.01), task("b", 1.1)], Size::Default, 1, 1e-4, &|_| {});
        assert_eq!(
            bad.failures().map(|(section, check)| (&*section.subject, &*check.name)).collect::<Vec<_>>(),
            [("b", "one")]
        );
        assert!(!run(&[], Size::Default, 1, 1e-4, &|_| {}).passes(), "nothing checked is nothing shown");
    }

    #[test]
    fn tasks_have_streams_of_their_own() {
        assert_ne!(stream(1, "A1/a"), stream(1, "A1/b"));
        assert_ne!(stream(1, "A1/a"), stream(2, "A1/a"));
    }

    #[test]
    fn patterns_match_parts_of_names() {
        let task = task("White conductor", 1.0);
        assert!(task.matches(&[]) && task.matches(&["x9".into()]) && task.matches(&["nothing".into(), "WHITE".into()]));
        assert!(!task.matches(&["black".into()]));
    }
}
