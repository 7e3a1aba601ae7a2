//! Which subjects of the battery can notice a fault at all: those that run a function that it changes. In all others the
//! program does the same with the fault as without, to the bit, and need not be asked.

use super::patch::Result;
use crate::many::Many;
use crate::schemata::Number;
use crate::workshop::Workshop;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Subject → the faults whose functions it runs.
pub(crate) struct Reach(BTreeMap<String, BTreeSet<Number>>);

impl Reach {
    /// Runs each subject alone and without a fault, or reads what an earlier run has written to `file`.
    pub(crate) fn record(many: &Many, subjects: &[String], workshop: &Workshop, file: &Path) -> Result<Self> {
        if let Some(known) = fs::read(file).ok().and_then(|json| serde_json::from_slice(&json).ok()) {
            return Ok(Self(known));
        }
        let one = |subject: &String| Ok((subject.clone(), workshop.record(&many.program, subject)?));
        let reached: BTreeMap<_, _> = subjects.iter().map(one).collect::<Result<_>>()?;
        let json = serde_json::to_vec(&reached).map_err(|e| e.to_string())?;
        fs::write(file, json).map_err(|e| format!("{}: {e}", file.display()))?;
        Ok(Self(reached))
    }

    /// The subjects that run a function which the fault changes; all for a fault that is in a program of its own.
    pub(crate) fn subjects(&self, fault: Option<Number>) -> impl Iterator<Item = &String> {
        let reaches = move |reached: &BTreeSet<Number>| fault.is_none_or(|fault| reached.contains(&fault));
        self.0.iter().filter(move |(_, reached)| reaches(reached)).map(|(subject, _)| subject)
    }
}
