//! What the battery says to a fault: found now, or kept from an earlier run.

use super::patch::{Patch, Result};
use crate::battery::{Asked, Outcome};
use crate::many::Many;
use crate::reach::Reach;
use crate::tree::Tree;
use crate::workshop::{Run, Workshop};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Which rows are run.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Extent {
    /// Those that patches name: quickly, and with more work where a quick look does not notice.
    Named,
    /// All of them quickly, and with more work what patches name and a quick look does not notice.
    Quick,
    /// All of them in full.
    Whole,
}

impl Extent {
    /// What is found with it is kept under this name.
    fn key(self, named: &[String]) -> String {
        match self {
            Self::Named => named.concat(),
            Self::Quick => format!("{}-quick", named.concat()),
            Self::Whole => String::new(),
        }
    }
}

/// Where faults are planted, and their programs built and run.
pub(crate) struct Bench {
    /// All faults.
    patches: Vec<Patch>,
    extent: Extent,
    tree: Tree,
    workshop: Workshop,
    /// The program with many faults, once it is needed.
    many: Option<Many>,
    /// Which subjects run which of them, once that is needed.
    reach: Option<Reach>,
    /// Where findings are kept.
    found: PathBuf,
    /// Findings of earlier trees count for faults.
    stale: bool,
}

impl Bench {
    pub(crate) fn new(root: &Path, patches: Vec<Patch>, extent: Extent, stale: bool) -> Result<Self> {
        let folder = root.join("target/faults");
        let found = folder.join("found");
        fs::create_dir_all(&found).map_err(|e| format!("{}: {e}", found.display()))?;
        let (tree, workshop) = (Tree::new(root)?, Workshop::new(folder));
        Ok(Self { patches, extent, tree, workshop, many: None, reach: None, found, stale })
    }

    /// What the battery says to the tree as it is: as faults are asked at first, or one row as it is asked again.
    pub(crate) fn sound(&mut self, row: Option<(&str, Asked)>) -> Result<Outcome> {
        let asked = row.map_or(Asked::Excerpt, |(_, asked)| asked);
        let key = match (row, self.extent) {
            (Some((row, asked)), _) => format!("{row}-{asked:?}").to_lowercase(),
            (None, Extent::Whole) => String::new(),
            (None, _) => String::from("-quick"),
        };
        let file = self.found.join(format!("unmodified-{:016x}{key}.json", self.tree.hash(None)?));
        if let Some(outcome) = kept(&file) {
            return Ok(outcome);
        }
        let run = Run { program: &self.many()?.program.clone(), fault: 0, limit: None };
        let only: Vec<String> = row.iter().map(|(row, _)| format!("{row}/")).collect();
        let full = asked == Asked::Full || row.is_none() && self.extent == Extent::Whole;
        keep(&file, self.workshop.run(run, &only, !full)?)
    }

    /// What the battery says to a fault; from an earlier run where it met the same tree. Of findings of an earlier tree, rows
    /// that they lack are asked now.
    pub(crate) fn outcome(&mut self, patch: &Patch, sound: &Outcome, limit: Duration) -> Result<Outcome> {
        let key = self.extent.key(&patch.rows);
        let file = self.found.join(format!("{}-{:016x}{key}.json", patch.name, self.tree.hash(Some(patch))?));
        if let Some(outcome) = kept(&file) {
            return Ok(outcome);
        }
        let earlier = if self.stale { self.earlier(&patch.name, &key)? } else { None };
        let known = earlier.as_deref().and_then(kept).unwrap_or_else(Outcome::nothing);
        let outcome = self.ask(patch, &known, sound, limit)?;
        keep(&earlier.unwrap_or(file), outcome)
    }

    /// Builds where need be, and runs the rows that are not known.
    fn ask(&mut self, patch: &Patch, known: &Outcome, sound: &Outcome, limit: Duration) -> Result<Outcome> {
        let young = |row: &str| !known.rows.iter().any(|known| known.id == row);
        if known.ended.is_some() || !sound.rows.iter().any(|row| young(&row.id)) {
            return Ok(known.clone());
        }
        let (mut program, fault) = {
            let many = self.many()?;
            (many.program.clone(), many.numbers.get(&patch.name).copied())
        };
        if fault.is_none() {
            let built = self.workshop.build("single", &self.tree, &self.tree.planted(patch)?)?;
            program = built.map_err(|broken| broken.message)?;
        }
        let run = Run { program: &program, fault: fault.unwrap_or(0), limit: Some(limit) };
        if self.extent == Extent::Whole {
            return self.workshop.run(run, &[], false);
        }

        // Quickly, in all subjects that may notice.
        let all = self.extent == Extent::Quick;
        let asked = |row: &str| young(row) && (all || patch.rows.iter().any(|named| named == row));
        let reach = self.reach(&sound.subjects)?;
        let subjects = reach.subjects(fault).filter(|subject| subject.split('/').next().is_some_and(asked));
        let only: Vec<String> = subjects.cloned().collect();
        let mut outcome = known.clone();
        if !only.is_empty() {
            outcome = outcome.with(self.workshop.run(run, &only, true)?, Asked::Excerpt);
        }
        if all && outcome.ended.is_none() {
            outcome = outcome.filled(sound);
        }

        // Rows that should have noticed and have not: all their subjects, then in full.
        for asked in [Asked::Quick, Asked::Full] {
            let missed = patch.rows.iter().filter(|row| young(row) && !outcome.notices(row));
            let missed: Vec<String> = missed.map(|row| format!("{row}/")).collect();
            if !missed.is_empty() && outcome.ended.is_none() {
                let again = self.workshop.run(run, &missed, asked != Asked::Full)?;
                outcome = outcome.with(again, asked);
            }
        }
        outcome.rows.sort_by_key(|row| sound.rows.iter().position(|known| known.id == row.id));
        Ok(outcome)
    }

    fn many(&mut self) -> Result<&Many> {
        if self.many.is_none() {
            let many = Many::build(&self.tree, &self.patches, &self.workshop)?;
            println!("{} of {} faults are in one program", many.numbers.len(), self.patches.len());
            self.many = Some(many);
        }
        self.many.as_ref().ok_or_else(|| "there is no program".into())
    }

    fn reach(&mut self, subjects: &[String]) -> Result<&Reach> {
        if self.reach.is_none() {
            let (tree, faults) = (self.tree.hash(None)?, self.many()?.hash);
            let file = self.found.join(format!("reach-{tree:016x}-{faults:016x}.json"));
            let many = self.many.as_ref().ok_or("there is no program")?;
            self.reach = Some(Reach::record(many, subjects, &self.workshop, &file)?);
        }
        self.reach.as_ref().ok_or_else(|| "nothing is known of the subjects".into())
    }

    /// What the last earlier tree with this fault was found to do in these rows.
    fn earlier(&self, name: &str, rows: &str) -> Result<Option<PathBuf>> {
        let files = fs::read_dir(&self.found).map_err(|e| format!("{}: {e}", self.found.display()))?;
        let matches = |path: &PathBuf| {
            let file = path.file_name().unwrap_or_default().to_string_lossy();
            let hash =
                file.strip_prefix(&format!("{name}-")).and_then(|rest| rest.strip_suffix(&format!("{rows}.json")));
            hash.is_some_and(|hash| hash.len() == 16 && hash.chars().all(|c| c.is_ascii_hexdigit()))
        };
        let newest = |path: &PathBuf| fs::metadata(path).and_then(|data| data.modified()).ok();
        Ok(files.filter_map(|entry| Some(entry.ok()?.path())).filter(matches).max_by_key(newest))
    }
}

fn kept(file: &Path) -> Option<Outcome> {
    serde_json::from_slice(&fs::read(file).ok()?).ok()
}

fn keep(file: &Path, outcome: Outcome) -> Result<Outcome> {
    let json = serde_json::to_vec(&outcome).map_err(|e| e.to_string())?;
    fs::write(file, json).map_err(|e| format!("{}: {e}", file.display()))?;
    Ok(outcome)
}
