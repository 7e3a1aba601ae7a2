//! What the battery says to a fault: found now, or kept from an earlier run.

use crate::battery::Outcome;
use crate::many::Many;
use crate::patch::{Patch, Result};
use crate::tree::Tree;
use crate::workshop::{Run, Workshop};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Which rows are run.
#[derive(Clone, Copy)]
pub(crate) enum Extent {
    /// Those that patches name: quickly, and in full where a quick look does not notice.
    Named,
    /// All of them quickly, and in full what patches name and a quick look does not notice.
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
    tree: Tree,
    workshop: Workshop,
    /// The program with many faults, once it is needed.
    many: Option<Many>,
    /// Where findings are kept.
    found: PathBuf,
    /// Findings of earlier trees count for faults.
    stale: bool,
}

impl Bench {
    pub(crate) fn new(root: &Path, patches: Vec<Patch>, stale: bool) -> Result<Self> {
        let folder = root.join("target/faults");
        let found = folder.join("found");
        fs::create_dir_all(&found).map_err(|e| format!("{}: {e}", found.display()))?;
        Ok(Self { patches, tree: Tree::new(root)?, workshop: Workshop::new(folder), many: None, found, stale })
    }

    /// What the battery says to a fault, or to none; from an earlier run where it met the same tree.
    pub(crate) fn outcome(
        &mut self,
        patch: Option<&Patch>,
        named: &[String],
        extent: Extent,
        limit: Option<Duration>,
    ) -> Result<Outcome> {
        let (name, key) = (patch.map_or("unmodified", |patch| &patch.name), extent.key(named));
        let mut file = self.found.join(format!("{name}-{:016x}{key}.json", self.tree.hash(patch)?));
        if self.stale && patch.is_some() && !file.exists() {
            file = self.earlier(name, &key)?.unwrap_or(file);
        }
        if let Some(found) = fs::read(&file).ok().and_then(|json| serde_json::from_slice(&json).ok()) {
            return Ok(found);
        }
        let outcome = self.ask(patch, named, extent, limit)?;
        let json = serde_json::to_vec(&outcome).map_err(|e| e.to_string())?;
        fs::write(&file, json).map_err(|e| format!("{}: {e}", file.display()))?;
        Ok(outcome)
    }

    /// Builds where need be, and runs.
    fn ask(
        &mut self,
        patch: Option<&Patch>,
        named: &[String],
        extent: Extent,
        limit: Option<Duration>,
    ) -> Result<Outcome> {
        if self.many.is_none() {
            let many = Many::build(&self.tree, &self.patches, &self.workshop)?;
            println!("{} of {} faults are in one program", many.numbers.len(), self.patches.len());
            self.many = Some(many);
        }
        let many = self.many.as_ref().ok_or("there is no program")?;
        let number = patch.map_or(Some(0), |patch| many.numbers.get(&patch.name).copied());
        let alone;
        let run = match (number, patch) {
            (None, Some(patch)) => {
                let planted = self.tree.planted(patch)?;
                alone = self.workshop.build("single", &self.tree, &planted)?.map_err(|broken| broken.message)?;
                Run { program: &alone, fault: 0, limit }
            }
            (number, _) => Run { program: &many.program, fault: number.unwrap_or(0), limit },
        };
        let rows = match extent {
            Extent::Whole => return self.workshop.run(run, &[], false),
            Extent::Named => named,
            Extent::Quick => &[],
        };
        let quick = self.workshop.run(run, rows, true)?;
        let missed: Vec<String> = named.iter().filter(|row| !quick.notices(row)).cloned().collect();
        if quick.ended.is_some() || missed.is_empty() {
            return Ok(quick);
        }
        Ok(quick.with(self.workshop.run(run, &missed, false)?))
    }

    /// What some earlier tree with this fault was found to do in these rows.
    fn earlier(&self, name: &str, rows: &str) -> Result<Option<PathBuf>> {
        let files = fs::read_dir(&self.found).map_err(|e| format!("{}: {e}", self.found.display()))?;
        let matches = |path: &PathBuf| {
            let file = path.file_name().unwrap_or_default().to_string_lossy();
            let hash =
                file.strip_prefix(&format!("{name}-")).and_then(|rest| rest.strip_suffix(&format!("{rows}.json")));
            hash.is_some_and(|hash| hash.len() == 16 && hash.chars().all(|c| c.is_ascii_hexdigit()))
        };
        Ok(files.filter_map(|entry| Some(entry.ok()?.path())).find(matches))
    }
}
