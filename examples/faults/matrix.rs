//! Which row notices which fault.

use super::patch::Patch;
use crate::battery::Outcome;
use std::fmt::Write;

/// What stands at the top of the written matrix.
const HEAD: &str = "# Planted faults

Each is a small patch in `reference/faults/`. One at a time is planted in a copy of the tree, whose program verifies itself;
a fault counts as caught by the rows in which a check fails. The unmodified tree passes all of them.
Written by `cargo run --release --example faults -- --write`, which fails where a fault is caught by nothing, where a row
that a patch names does not notice it, or where a row notices none. ● has noticed, ○ has not. Every row was
asked as `verify --quick` asks it: a third of its subjects at an eighth of the work, so that a small effect may hide behind
a ○. A row whose subjects run no code that the fault changes cannot notice it. Where a row that the patch names noticed
nothing, it was asked again in all its subjects, and then in full. Findings of earlier trees count where `--stale` says so,
and then only rows that are younger were asked anew; where nothing stands, a row or a fault is younger than the last run.
";

/// The faults that were planted, and what the battery said to each.
pub(crate) struct Matrix<'a> {
    /// All rows of the battery, in its order.
    pub(crate) rows: Vec<String>,
    /// Outcome of each fault.
    pub(crate) faults: Vec<(&'a Patch, Outcome)>,
}

impl Matrix<'_> {
    /// Faults that nothing notices.
    pub(crate) fn uncaught(&self) -> Vec<&str> {
        self.faults.iter().filter(|(_, outcome)| !outcome.caught()).map(|(patch, _)| &*patch.name).collect()
    }

    /// Faults with rows that should have noticed them and did not. A program that ends early shows no row.
    pub(crate) fn unnoticed(&self) -> Vec<String> {
        let missing = |(patch, outcome): &(&Patch, Outcome)| {
            let failed = |row: &&String| !outcome.notices(row);
            let rows: Vec<&str> = patch.rows.iter().filter(failed).map(String::as_str).collect();
            (outcome.ended.is_none() && !rows.is_empty()).then(|| format!("{} by {}", patch.name, rows.join(", ")))
        };
        self.faults.iter().filter_map(missing).collect()
    }

    /// Rows that notice no fault.
    pub(crate) fn idle(&self) -> Vec<&str> {
        let notices = |row: &str| self.faults.iter().any(|(_, outcome)| outcome.notices(row));
        self.rows.iter().map(String::as_str).filter(|row| !notices(row)).collect()
    }

    /// As Markdown. Nothing in it depends on the day, the machine or its speed.
    pub(crate) fn markdown(&self) -> String {
        let mut text = String::from(HEAD);
        let columns = self.rows.join(" | ");
        let _ = writeln!(text, "\n{} faults, {} rows.\n", self.faults.len(), self.rows.len());
        let _ = writeln!(text, "| fault | {columns} |\n| --- |{}", " :-: |".repeat(self.rows.len()));
        for (patch, outcome) in &self.faults {
            let mark = |row: &String| match outcome.rows.iter().find(|run| run.id == *row) {
                Some(run) if run.failed > 0 => " ● |",
                Some(_) => " ○ |",
                None => " |",
            };
            let marks: String = self.rows.iter().map(mark).collect();
            let _ = writeln!(text, "| `{}` |{marks}", patch.name);
        }
        let _ = writeln!(text, "\n| fault | what is wrong | first to notice |\n| --- | --- | --- |");
        for (patch, outcome) in &self.faults {
            let first = outcome.first().unwrap_or("nothing").replace('|', "\\|");
            let _ = writeln!(text, "| `{}` | {} | {first} |", patch.name, patch.what);
        }
        text
    }

    /// For a terminal: a line a fault, a letter a row.
    pub(crate) fn table(&self) -> String {
        let width = self.faults.iter().map(|(patch, _)| patch.name.len()).max().unwrap_or(0);
        let longest = self.rows.iter().map(String::len).max().unwrap_or(0);
        let mut text = String::new();
        // Names of rows from top to bottom.
        for i in 0..longest {
            let letters: String = self.rows.iter().map(|row| row.chars().nth(i).unwrap_or(' ')).collect();
            let _ = writeln!(text, "{:width$}  {letters}", "");
        }
        for (patch, outcome) in &self.faults {
            let mark = |row: &String| if outcome.notices(row) { '#' } else { '.' };
            let marks: String = self.rows.iter().map(mark).collect();
            let _ = writeln!(text, "{:width$}  {}", patch.name, outcome.ended.as_ref().map_or(marks, String::clone));
        }
        text
    }
}
