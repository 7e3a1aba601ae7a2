//! Plants faults, one at a time, and looks whether the battery notices: a test that cannot fail shows nothing.
//!
//! ```text
//! cargo run --release --example faults                     # all of reference/faults/ against every row
//! cargo run --release --example faults -- mis-weights      # those named
//! cargo run --release --example faults -- --named-rows     # each against the rows that its patch names, which is quicker
//! cargo run --release --example faults -- --budget 720 --from 40    # as many as begin within 720 s, from the 40th on
//! cargo run --release --example faults -- --write          # all, and reference/faults.md anew
//! ```
//!
//! One program holds all faults that change bodies of functions alone, and each run chooses one of them
//! ([`schemata`]); the others are built one by one.
//!
//! Every row is asked as `verify --quick` asks it, in the subjects that run the fault's code; one that the patch names and
//! that notices nothing then, is asked again in all its subjects, and then in full (with `--whole` all are). Exit code 1 where
//! a fault is caught by nothing or a row that its patch names does not notice it, where a patch does not apply or build, where
//! the unmodified tree fails, where a budget is too short for any fault, and, when all were planted, where a row notices none.
//! What was found for a tree is kept in `target/faults/found`, so that an interrupted run goes on.

mod battery;
mod bench;
mod many;
mod matrix;
mod patch;
mod reach;
mod schemata;
mod tree;
mod workshop;

use battery::Asked;
use bench::{Bench, Extent};
use clap::Parser;
use matrix::Matrix;
use patch::{Patch, Result};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

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
    /// Begin with the K-th fault (counted from 0, modulo their number), and go round
    #[arg(long, value_name = "K", default_value_t = 0)]
    from: usize,
    /// Plant no further fault after so many seconds
    #[arg(long, value_name = "SECONDS")]
    budget: Option<u64>,
    /// Run only the rows that a patch names, for a quick look
    #[arg(long, conflicts_with = "whole")]
    named_rows: bool,
    /// Run every row in its default size, not an eighth of it
    #[arg(long)]
    whole: bool,
    /// Take what was found for a fault in an earlier tree, where this one was not asked, and ask only rows that are younger
    #[arg(long)]
    stale: bool,
    /// Write reference/faults.md
    #[arg(long, conflicts_with_all = ["names", "budget"])]
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
    let start = Instant::now();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let all = patch::load(&root.join("reference/faults"))?;
    let patches = select(&all, arguments)?;
    if arguments.list {
        patches.iter().for_each(|p| println!("{} ({}): {}", p.name, p.rows.join(" "), p.what));
        return Ok(true);
    }

    // The tree as it is must pass: what fails there says nothing about a fault.
    let mut bench = Bench::new(root, all.clone(), Extent::of(arguments), arguments.stale)?;
    let sound = bench.sound(None)?;
    if let Some(first) = sound.first() {
        return Err(format!("the unmodified tree fails: {first}"));
    }
    println!("the unmodified tree passes {} rows in {:.0} s", sound.rows.len(), sound.seconds);

    let limit = Duration::from_secs_f64(PATIENCE * sound.seconds.max(10.0));
    let budget = arguments.budget.map(Duration::from_secs);
    let mut faults = Vec::new();
    for (i, patch) in patches.iter().enumerate() {
        if budget.is_some_and(|budget| start.elapsed() >= budget) {
            println!("the time is up: {} of {} faults were not planted", patches.len() - i, patches.len());
            break;
        }
        let outcome = bench.outcome(patch, &sound, limit);
        let outcome = outcome.map_err(|e| format!("{}: {e}", patch.name))?;
        let first = outcome.first().unwrap_or("NOTHING NOTICES");
        println!("[{}/{}] {}: {first} ({:.0} s)", i + 1, patches.len(), patch.name, outcome.seconds);
        faults.push((*patch, outcome));
    }

    // A row that a fault was asked for with more work must pass without it too.
    let rows = faults.iter().flat_map(|(_, outcome)| &outcome.rows).filter(|row| row.asked != Asked::Excerpt);
    let again: BTreeSet<(String, Asked)> = rows.map(|row| (row.id.clone(), row.asked)).collect();
    for (row, asked) in again {
        if let Some(first) = bench.sound(Some((&row, asked)))?.first() {
            return Err(format!("the unmodified tree fails where {row} is asked again: {first}"));
        }
    }

    faults.sort_by(|(a, _), (b, _)| a.name.cmp(&b.name));
    let matrix = Matrix { rows: sound.rows.into_iter().map(|row| row.id).collect(), faults };
    println!("\n{}", matrix.table());
    if arguments.write {
        let path = root.join("reference/faults.md");
        fs::write(&path, matrix.markdown()).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(verdict(&matrix, matrix.faults.len() == all.len()))
}

/// Says what is wrong with the battery, of which rows that notice nothing only where all faults were planted.
fn verdict(matrix: &Matrix, complete: bool) -> bool {
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
    right && !matrix.faults.is_empty()
}

/// The patches that the arguments ask for, in the order in which they are planted.
fn select<'a>(all: &'a [Patch], arguments: &Arguments) -> Result<Vec<&'a Patch>> {
    if let Some(name) = arguments.names.iter().find(|name| !all.iter().any(|p| p.name == **name)) {
        return Err(format!("there is no fault `{name}`; --list names all"));
    }
    let asked = |p: &&Patch| arguments.names.is_empty() || arguments.names.contains(&p.name);
    let mut patches: Vec<&Patch> = all.iter().filter(asked).collect();
    let from = arguments.from % patches.len().max(1);
    patches.rotate_left(from);
    Ok(patches)
}

impl Extent {
    fn of(arguments: &Arguments) -> Self {
        match arguments {
            Arguments { named_rows: true, .. } => Self::Named,
            Arguments { whole: true, .. } => Self::Whole,
            _ => Self::Quick,
        }
    }
}
