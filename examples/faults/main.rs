//! Plants faults, one at a time, and looks whether the battery notices: a test that cannot fail shows nothing.
//!
//! ```text
//! cargo run --release --example faults                     # all of reference/faults/ against every row
//! cargo run --release --example faults -- mis-weights      # those named
//! cargo run --release --example faults -- --named-rows     # each against the rows that its patch names, which is quicker
//! cargo run --release --example faults -- --part 3/30      # every 30th, from the third
//! cargo run --release --example faults -- --write          # all, and reference/faults.md anew
//! ```
//!
//! Every row is asked as `verify --quick` asks it; one that the patch names and that notices nothing then, is asked again in
//! full (with `--whole` all are). Exit code 1 where a fault is caught by nothing or a row that its patch names does not notice it, where a patch does
//! not apply or build, where the unmodified tree fails, and, when all were planted, where a row notices none. What was
//! found for a tree is kept in `target/faults/found`, so that an interrupted run goes on.

mod battery;
mod matrix;
mod patch;
mod tree;

use battery::{Outcome, Workshop};
use clap::Parser;
use matrix::Matrix;
use patch::{Patch, Result};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;
use tree::Tree;

/// A fault may make the battery this many times slower before it counts as hanging.
const PATIENCE: f64 = 5.0;

/// Plants faults and looks whether the battery notices.
#[derive(Parser)]
struct Arguments {
    /// Faults to plant; all without
    names: Vec<String>,
    /// Print names and what is wrong, and do nothing
    #[arg(long)]
    list: bool,
    /// Of all faults every N-th, from the K-th (counted from 0, modulo N)
    #[arg(long, value_name = "K/N", value_parser = part, conflicts_with = "names")]
    part: Option<(usize, usize)>,
    /// Run only the rows that a patch names, for a quick look
    #[arg(long, conflicts_with = "whole")]
    named_rows: bool,
    /// Run every row in its default size, not an eighth of it
    #[arg(long)]
    whole: bool,
    /// Take what was found for a fault in earlier trees, where this one was not asked
    #[arg(long)]
    stale: bool,
    /// Write reference/faults.md
    #[arg(long, conflicts_with_all = ["names", "part"])]
    write: bool,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// True where all is as it should be.
fn run(arguments: &Arguments) -> Result<bool> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let patches = select(patch::load(&root.join("reference/faults"))?, arguments)?;
    if arguments.list {
        patches.iter().for_each(|p| println!("{} ({}): {}", p.name, p.rows.join(" "), p.what));
        return Ok(true);
    }

    // The tree as it is must pass: what fails there says nothing about a fault.
    let extent = Extent::of(arguments);
    let bench = Bench::new(root, arguments.stale)?;
    let mut named: Vec<String> = patches.iter().flat_map(|patch| patch.rows.clone()).collect();
    named.sort();
    named.dedup();
    let sound = bench.outcome(None, &named, extent, None)?;
    if let Some(first) = sound.first() {
        return Err(format!("the unmodified tree fails: {first}"));
    }
    println!("the unmodified tree passes {} rows in {:.0} s", sound.rows.len(), sound.seconds);

    let limit = Duration::from_secs_f64(PATIENCE * sound.seconds.max(10.0));
    let mut faults = Vec::new();
    for (i, patch) in patches.iter().enumerate() {
        let outcome = bench.outcome(Some(patch), &patch.rows, extent, Some(limit));
        let outcome = outcome.map_err(|e| format!("{}: {e}", patch.name))?;
        let first = outcome.first().unwrap_or("NOTHING NOTICES");
        println!("[{}/{}] {}: {first} ({:.0} s)", i + 1, patches.len(), patch.name, outcome.seconds);
        faults.push((patch, outcome));
    }

    let matrix = Matrix { rows: sound.rows.into_iter().map(|row| row.id).collect(), faults };
    println!("\n{}", matrix.table());
    if arguments.write {
        let path = root.join("reference/faults.md");
        fs::write(&path, matrix.markdown()).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(verdict(&matrix, arguments))
}

/// Says what is wrong with the battery.
fn verdict(matrix: &Matrix, arguments: &Arguments) -> bool {
    let complete = arguments.names.is_empty() && arguments.part.is_none();
    let (uncaught, unnoticed) = (matrix.uncaught(), matrix.unnoticed());
    let idle = if complete { matrix.idle() } else { Vec::new() };
    if !uncaught.is_empty() {
        println!("caught by nothing: {}", uncaught.join(", "));
    }
    if !unnoticed.is_empty() {
        println!("not noticed where it should be: {}", unnoticed.join("; "));
    }
    if !idle.is_empty() {
        println!("rows that notice no fault: {}", idle.join(", "));
    }
    let right = uncaught.is_empty() && unnoticed.is_empty() && idle.is_empty();
    if right {
        println!("{} faults, every one caught", matrix.faults.len());
    }
    right
}

/// The patches that the arguments ask for.
fn select(mut patches: Vec<Patch>, arguments: &Arguments) -> Result<Vec<Patch>> {
    if let Some(name) = arguments.names.iter().find(|name| !patches.iter().any(|p| p.name == **name)) {
        return Err(format!("there is no fault `{name}`; --list names all"));
    }
    if !arguments.names.is_empty() {
        patches.retain(|p| arguments.names.contains(&p.name));
    }
    if let Some((k, n)) = arguments.part {
        patches = patches.into_iter().skip(k % n).step_by(n).collect();
    }
    Ok(patches)
}

/// `K/N`.
fn part(text: &str) -> Result<(usize, usize)> {
    let (k, n) = text.split_once('/').ok_or("expected K/N")?;
    let number = |text: &str| text.parse::<usize>().map_err(|e| format!("`{text}`: {e}"));
    match (number(k)?, number(n)?) {
        (_, 0) => Err("N is at least 1".into()),
        part => Ok(part),
    }
}

/// Which rows are run.
#[derive(Clone, Copy)]
enum Extent {
    /// Those that patches name.
    Named,
    /// All of them quickly, and in full what patches name and a quick look does not notice.
    Quick,
    /// All of them in full.
    Whole,
}

impl Extent {
    fn of(arguments: &Arguments) -> Self {
        match arguments {
            Arguments { named_rows: true, .. } => Self::Named,
            Arguments { whole: true, .. } => Self::Whole,
            _ => Self::Quick,
        }
    }

    /// What is found with it is kept under this name.
    fn key(self, named: &[String]) -> String {
        match self {
            Self::Named => named.concat(),
            Self::Quick => format!("{}-quick", named.concat()),
            Self::Whole => String::new(),
        }
    }
}

/// Where faults are planted and their trees built and run.
struct Bench {
    tree: Tree,
    workshop: Workshop,
    found: PathBuf,
    /// Findings of earlier trees count for faults.
    stale: bool,
}

impl Bench {
    fn new(root: &Path, stale: bool) -> Result<Self> {
        let folder = root.join("target/faults");
        let found = folder.join("found");
        fs::create_dir_all(&found).map_err(|e| format!("{}: {e}", found.display()))?;
        let tree = Tree::new(root, folder.join("tree"))?;
        Ok(Self { tree, workshop: Workshop { build: folder.join("build"), scratch: folder }, found, stale })
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

    /// What the battery says to a fault, or to none; from an earlier run where it met the same tree.
    fn outcome(
        &self,
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
        if let Some(patch) = patch {
            self.tree.plant(patch)?;
        }
        let built = self.workshop.build(&self.tree.copy);
        let run = |rows: &[String], quick: bool| self.workshop.run(&self.tree.copy, rows, quick, limit);
        let outcome = built.and_then(|()| match extent {
            Extent::Named => run(named, false),
            Extent::Whole => run(&[], false),
            Extent::Quick => {
                let quick = run(&[], true)?;
                let missed: Vec<String> = named.iter().filter(|row| !quick.notices(row)).cloned().collect();
                if quick.ended.is_some() || missed.is_empty() {
                    return Ok(quick);
                }
                Ok(quick.with(run(&missed, false)?))
            }
        });
        self.tree.restore()?;
        let outcome = outcome?;
        let json = serde_json::to_vec(&outcome).map_err(|e| e.to_string())?;
        fs::write(&file, json).map_err(|e| format!("{}: {e}", file.display()))?;
        Ok(outcome)
    }
}
