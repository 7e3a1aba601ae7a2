//! What a run found, and its forms: for people ([`text`], [`html`]) and for programs ([`json`], [`junit`]).

mod cells;
mod digest;
pub mod html;
pub mod json;
pub mod junit;
pub mod text;

pub use cells::Cells;
pub use digest::{Digest, Group};

use super::task::{Exhibit, Listing, Size, Topic};
use crate::stats::{Check, Evidence, sidak, t_limit};
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
    /// Standard errors are widened on purpose: see [`Findings::guarded`](super::Findings::guarded).
    pub guarded: bool,
    /// Time from the task's beginning to its end; others may have run on the same thread meanwhile.
    pub time: Duration,
}

impl Section {
    /// The texts among its exhibits.
    pub fn listings(&self) -> impl Iterator<Item = &Listing> {
        self.exhibits.iter().filter_map(|exhibit| match exhibit {
            Exhibit::Listing(listing) => Some(listing),
            _ => None,
        })
    }

    /// The name of its task.
    pub fn name(&self) -> String {
        format!("{}/{}", self.topic.id, self.subject)
    }
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
    /// What is to be known of the run as a whole, a sentence each; no verdicts.
    pub notes: Vec<String>,
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

    /// Largest |z| with which a check passes.
    pub fn z_limit(&self) -> f64 {
        t_limit(self.share(), f64::INFINITY)
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

    /// Its sections by topic, in the order in which the topics come first.
    pub fn groups(&self) -> Vec<Group<'_>> {
        let mut groups: Vec<Group> = Vec::new();
        for section in &self.sections {
            match groups.iter_mut().find(|group| group.topic.id == section.topic.id) {
                Some(group) => group.sections.push(section),
                None => groups.push(Group { topic: section.topic, sections: vec![section] }),
            }
        }
        groups
    }
}

/// What was run, for whoever reads a report without having run it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct About {
    /// What was checked: the program itself, or a scene.
    pub what: String,
    /// The command that does it again.
    pub command: String,
}

/// The program and its version, as reports name it.
pub const SOFTWARE: &str = concat!("radianza ", env!("CARGO_PKG_VERSION"));

/// A name as one line of text: what it has of control characters, which terminals obey and XML forbids, is replaced.
pub fn one_line(name: &str) -> String {
    let forbidden = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}' | '\u{2028}'..='\u{202e}');
    name.chars().map(|c| if forbidden(c) { '\u{fffd}' } else { c }).collect()
}

/// A number with its thousands apart: `12,345`.
pub fn count(n: usize) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::verify::{Curve, HeatMap, Picture, Task, run};

    /// Two topics, all kinds of evidence and exhibits, hostile names; fails where `wrong`.
    pub(in crate::verify) fn example(wrong: bool) -> Report {
        const A: Topic = Topic { id: "A1", title: "Albedo & <energy>", source: "Lambert 1760" };
        const B: Topic = Topic { id: "B2", title: "Something else", source: "" };
        let tasks = [
            Task::new(A, "paint <script>alert(1)</script>", move |_, found| {
                found.checks.estimate("mean", 1.0, 1.01, 0.01);
                found.checks.estimate("tail \"quoted\" & 'so'", 0.5, if wrong { 0.6 } else { 0.5 }, 0.01);
                found.checks.p("χ²", 0.25);
                found.words.push("`paint`: reflects at most 0.94.".into());
                found.exhibits.push(Exhibit::Curve(Curve {
                    title: "albedo </title>".into(),
                    axes: ["cos θ", "albedo"],
                    lines: vec![("α 0.1".into(), vec![[0.0, 0.5, 0.01], [1.0, 0.75, 0.0]])],
                }));
            }),
            Task::new(B, "control \u{1b}[31m\u{0}", |_, found| {
                found.checks.bound("identity", 1e-7, 1e-6);
                found.exhibits.push(Exhibit::HeatMap(HeatMap {
                    title: "counts".into(),
                    axes: ["φ", "θ"],
                    columns: 2,
                    observed: vec![10.0, 12.0, 0.0, 3.0],
                    expected: vec![11.0, 11.0, 0.0, 3.0],
                }));
                found.exhibits.push(Exhibit::Picture(Picture {
                    title: "pixels".into(),
                    size: [2, 1],
                    pixels: vec![[1.0, 0.5, 0.0], [f32::NAN; 3]],
                }));
            }),
            Task::new(B, "text", |_, found| {
                found.checks.holds("yes", true);
                let text = "[a]\nb = \"</pre>\u{1b}\"\n".into();
                found.exhibits.push(Exhibit::Listing(Listing { title: "a file".into(), text }));
            }),
            Task::new(A, "second", |_, found| found.checks.holds("yes", true)),
        ];
        run(&tasks, Size::Default, 7, 1e-4, &|_| {})
    }

    /// How it was run.
    pub(in crate::verify) fn about() -> About {
        About { what: "a <b>scene</b>".into(), command: "radianza verify 'a&b.glb'".into() }
    }

    #[test]
    fn topics_come_together() {
        let report = example(false);
        let groups = report.groups();
        assert_eq!(groups.iter().map(|g| (g.topic.id, g.sections.len())).collect::<Vec<_>>(), [("A1", 2), ("B2", 2)]);
        assert_eq!(report.random(), 5);
        assert!(report.passes() && !example(true).passes());
    }

    #[test]
    fn thousands_are_grouped() {
        assert_eq!([0, 12, 999, 1000, 1_234_567].map(count), ["0", "12", "999", "1,000", "1,234,567"]);
    }

    #[test]
    fn names_are_one_line() {
        assert_eq!(one_line("a\u{1b}[31m\nb"), "a\u{fffd}[31m\u{fffd}b");
    }
}
