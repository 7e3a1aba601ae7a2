//! What the battery said, row by row.

use super::patch::Result;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;
use std::process::ExitStatus;

/// What the battery said.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Outcome {
    /// Every row that was run, in its order.
    pub(crate) rows: Vec<Row>,
    /// Names of all subjects that were run, each behind its row: `A1/lambert`.
    #[serde(default)]
    pub(crate) subjects: Vec<String>,
    /// Where there was no verdict: how the program ended instead.
    pub(crate) ended: Option<String>,
    /// Wall-clock time \[s\].
    pub(crate) seconds: f64,
}

/// One row of the battery.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Row {
    /// A1, F2, …
    pub(crate) id: String,
    /// Checks that failed, and how many there are.
    pub(crate) failed: usize,
    /// All checks.
    pub(crate) checks: usize,
    /// The first that failed, with its z or p.
    pub(crate) first: Option<String>,
    /// How it was asked.
    #[serde(default)]
    pub(crate) asked: Asked,
}

/// How a row is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) enum Asked {
    /// Every third subject, with an eighth of the work.
    #[default]
    Excerpt,
    /// All subjects, with an eighth of the work.
    Quick,
    /// All subjects, in full.
    Full,
}

impl Outcome {
    /// Where nothing was run.
    pub(crate) fn nothing() -> Self {
        Self { rows: Vec::new(), subjects: Vec::new(), ended: None, seconds: 0.0 }
    }

    /// Where a program ended without findings.
    pub(crate) fn ended(how: String, seconds: f64) -> Self {
        Self { ended: Some(how), seconds, ..Self::nothing() }
    }

    /// The findings of a run, row by row.
    pub(crate) fn read(json: &[u8], seconds: f64) -> Result<Self> {
        let document: Document =
            serde_json::from_slice(json).map_err(|e| format!("the findings cannot be read: {e}"))?;
        let name = |section: &Section| format!("{}/{}", section.topic, section.subject);
        let subjects = document.sections.iter().map(name).collect();
        Ok(Self { rows: by_row(&document), subjects, ended: None, seconds })
    }

    /// With the rows of `sound` that were not run, because the fault's code is not run in them: nothing is noticed there.
    pub(crate) fn filled(mut self, sound: &Self) -> Self {
        let run = |row: &&Row| self.rows.iter().any(|known| known.id == row.id);
        let rest: Vec<Row> = sound.rows.iter().filter(|row| !run(row)).cloned().collect();
        self.rows.extend(rest);
        self
    }

    /// What was found of the battery, and what of some of its rows again, with more work: the latter counts there.
    pub(crate) fn with(mut self, again: Self, asked: Asked) -> Self {
        for row in again.rows.into_iter().map(|row| Row { asked, ..row }) {
            match self.rows.iter_mut().find(|known| known.id == row.id) {
                Some(known) => *known = row,
                None => self.rows.push(row),
            }
        }
        Self { ended: self.ended.or(again.ended), seconds: self.seconds + again.seconds, ..self }
    }

    /// The rows in which a check failed.
    pub(crate) fn failed(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.failed > 0)
    }

    /// True where a check of this row failed.
    pub(crate) fn notices(&self, row: &str) -> bool {
        self.failed().any(|failed| failed.id == row)
    }

    /// True where something was noticed, be it a crash.
    pub(crate) fn caught(&self) -> bool {
        self.ended.is_some() || self.failed().next().is_some()
    }

    /// What was noticed first.
    pub(crate) fn first(&self) -> Option<&str> {
        self.ended.as_deref().or_else(|| self.failed().find_map(|row| row.first.as_deref()))
    }
}

/// Of the program's findings, what is read here.
#[derive(Deserialize)]
struct Document {
    sections: Vec<Section>,
}

#[derive(Deserialize)]
struct Section {
    topic: String,
    subject: String,
    checks: Vec<Check>,
}

#[derive(Deserialize)]
struct Check {
    name: String,
    passes: bool,
    p: f64,
    z: Option<f64>,
    worst: Option<f64>,
    bound: Option<f64>,
}

/// How a program ended that gave no findings.
pub(crate) fn crash(status: ExitStatus, complaints: &Path) -> String {
    let text = fs::read_to_string(complaints).unwrap_or_default();
    // A panic's place is in the line with that word, its message in the next.
    let panic = text.lines().skip_while(|line| !line.contains("panicked")).nth(1);
    let last = panic.or(text.lines().last()).unwrap_or_default();
    format!("crashes: {status}, {last}")
}

/// The rows of findings, in their order.
fn by_row(document: &Document) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    for section in &document.sections {
        let index = rows.iter().position(|row| row.id == section.topic).unwrap_or_else(|| {
            rows.push(Row { id: section.topic.clone(), failed: 0, checks: 0, first: None, asked: Asked::Excerpt });
            rows.len() - 1
        });
        let row = &mut rows[index];
        row.checks += section.checks.len();
        for check in section.checks.iter().filter(|check| !check.passes) {
            row.failed += 1;
            let first = || format!("{}/{}, {}: {}", section.topic, section.subject, check.name, check.evidence());
            row.first.get_or_insert_with(first);
        }
    }
    rows
}

impl Check {
    /// z, p or the deviation, in words.
    fn evidence(&self) -> String {
        match (self.z, self.worst, self.bound) {
            (Some(z), ..) => format!("z = {z:.1}"),
            (_, Some(worst), Some(bound)) => format!("off by {worst:.1e}, allowed {bound:.0e}"),
            _ => format!("p = {:.0e}", self.p),
        }
    }
}
