//! A report as a table for terminals.

use super::cells::{percent, probability};
use super::{Cells, Digest, Group, Report, Section, count, one_line};
use crate::stats::Check;
use anstyle::{AnsiColor, Style};
use std::fmt::{self, Write};
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// Columns that a table takes.
pub const WIDTH: usize = 100;

/// How much of a report is said.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Detail {
    /// Checks that fail.
    Failures,
    /// The least likely check of each subject, and those that fail.
    #[default]
    Worst,
    /// Every check.
    All,
}

const STRONG: Style = Style::new().bold();
const FAINT: Style = Style::new().dimmed();
const GOOD: Style = AnsiColor::Green.on_default();
const BAD: Style = AnsiColor::Red.on_default().bold();

/// Widths of verdict, name, number of checks, exact value, estimate, statistic, detectable bias; a space between them
/// and two before them.
const COLUMNS: [usize; 7] = [4, 33, 6, 10, 21, 10, 8];

/// The table, coloured: print it through a stream that takes colours out where nobody sees them.
pub fn table(report: &Report, detail: Detail) -> String {
    let mut text = String::new();
    // A String takes everything.
    let _ = write_table(&mut text, report, detail);
    text
}

fn write_table(out: &mut String, report: &Report, detail: Detail) -> fmt::Result {
    let share = report.share();
    if detail != Detail::Failures {
        heading(out)?;
    }
    for group in report.groups() {
        let failing = group.sections.iter().any(|section| !Digest::new(&section.checks, share).failures.is_empty());
        if failing || detail != Detail::Failures {
            write_group(out, &group, share, detail)?;
        }
    }
    summary(out, report, share)
}

fn heading(out: &mut String) -> fmt::Result {
    let names = ["", "subject (its least likely check)", "checks", "exact", "estimate ± SE", "z or p", "detects"];
    let cells = std::array::from_fn(|i| names[i].to_string());
    line(out, FAINT, &cells, FAINT)
}

fn write_group(out: &mut String, group: &Group, share: f64, detail: Detail) -> fmt::Result {
    let title = format!("{}  {}", group.topic.id, group.topic.title);
    for (i, part) in wrap(&title, WIDTH).iter().enumerate() {
        writeln!(out, "{}{STRONG}{part}{STRONG:#}", if i == 0 { "\n" } else { "" })?;
    }
    if detail == Detail::All {
        for part in group.sources().iter().flat_map(|source| wrap(source, WIDTH - 4)) {
            writeln!(out, "    {FAINT}{part}{FAINT:#}")?;
        }
    }
    group.sections.iter().try_for_each(|section| write_section(out, section, share, detail))
}

fn write_section(out: &mut String, section: &Section, share: f64, detail: Detail) -> fmt::Result {
    let digest = Digest::new(&section.checks, share);
    if detail == Detail::Failures && digest.failures.is_empty() {
        return Ok(());
    }

    // The subject with its least likely check.
    let worst = digest.worst.map(|check| Cells::new(check, share)).unwrap_or_default();
    let cells = Cells { detects: digest.detects.map_or(String::new(), percent), ..worst };
    row(out, digest.failures.is_empty(), &section.subject, &count(digest.checks), cells)?;

    // Checks one by one: all, or those that fail.
    for check in &section.checks {
        let fails = check.p() < share;
        if fails {
            write_failure(out, check, share)?;
        } else if detail == Detail::All {
            row(out, true, &format!("  {}", check.name), "", Cells::new(check, share))?;
        }
    }
    for part in section.words.iter().flat_map(|words| wrap(words, WIDTH - 7)) {
        writeln!(out, "       {part}")?;
    }

    // Texts are not indented, and their lines not broken, so that they can be copied.
    for listing in section.listings() {
        writeln!(out, "       {}:\n", one_line(&listing.title))?;
        listing.text.lines().try_for_each(|line| writeln!(out, "{}", one_line(line)))?;
        writeln!(out)?;
    }
    Ok(())
}

/// A failing check with its whole name on a line of its own, however long.
fn write_failure(out: &mut String, check: &Check, share: f64) -> fmt::Result {
    for part in wrap(&check.name, WIDTH - 9) {
        writeln!(out, "  {BAD}FAIL{BAD:#}   {BAD}{part}{BAD:#}")?;
    }
    let Cells { exact, estimate, statistic, detects } = Cells::new(check, share);
    let exact = if exact.is_empty() { exact } else { format!("exact {exact}, ") };
    let found = if estimate.is_empty() { estimate } else { format!("found {estimate}, ") };
    let detects = if detects.is_empty() { detects } else { format!(", detects {detects}") };
    let statistic = if statistic.is_empty() { "beyond what rounding explains".into() } else { statistic };
    let p = if statistic.starts_with('z') { format!(" (p {})", probability(check.p())) } else { String::new() };
    writeln!(out, "         {exact}{found}{statistic}{p}{detects}")
}

fn row(out: &mut String, passes: bool, name: &str, checks: &str, cells: Cells) -> fmt::Result {
    let (verdict, style) = if passes { ("ok", GOOD) } else { ("FAIL", BAD) };
    let Cells { exact, estimate, statistic, detects } = cells;
    let cells = [verdict.into(), one_line(name), checks.into(), exact, estimate, statistic, detects];
    line(out, style, &cells, Style::new())
}

/// Verdict and name to the left, numbers to the right; what a name has too much goes on below it.
fn line(out: &mut String, verdict: Style, cells: &[String; 7], others: Style) -> fmt::Result {
    let mut name = wrap(&cells[1], COLUMNS[1]).into_iter();
    let mut text = format!(" {}", pad(&name.next().unwrap_or_default(), COLUMNS[1], ""));
    for (cell, width) in cells.iter().zip(COLUMNS).skip(2) {
        text += &format!(" {}", pad("", width.saturating_sub(cell.width()), cell));
    }
    let label = pad("", COLUMNS[0].saturating_sub(cells[0].width()), "");
    writeln!(out, "  {verdict}{}{verdict:#}{label}{others}{}{others:#}", cells[0], text.trim_end())?;
    name.try_for_each(|part| writeln!(out, "{:7}{part}", ""))
}

/// `left`, spaces up to `width` columns, `right`.
fn pad(left: &str, width: usize, right: &str) -> String {
    format!("{left}{}{right}", " ".repeat(width.saturating_sub(left.width())))
}

fn summary(out: &mut String, report: &Report, share: f64) -> fmt::Result {
    let (all, failures) = (report.checks().count(), report.failures().count());
    if failures > 0 {
        writeln!(out, "\nfailures:")?;
        for (section, check) in report.failures() {
            for part in wrap(&format!("{}: {}", section.name(), check.name), WIDTH - 4) {
                writeln!(out, "    {part}")?;
            }
        }
    }
    let size = report.size.name();
    writeln!(
        out,
        "\n{} checks of {} subjects share α = {}: |z| ≤ {:.2}, p ≥ {share:.1e} each",
        count(all),
        count(report.sections.len()),
        report.alpha,
        report.z_limit(),
    )?;
    for part in report.notes.iter().flat_map(|note| wrap(&format!("note: {note}"), WIDTH)) {
        writeln!(out, "{part}")?;
    }
    let time = report.time.as_secs_f64();
    match failures {
        0 if all == 0 => write!(out, "{BAD}FAILED{BAD:#}: nothing was checked")?,
        0 => write!(out, "{GOOD}PASSED{GOOD:#}")?,
        n => write!(out, "{BAD}FAILED{BAD:#}: {} of {} checks", count(n), count(all))?,
    }
    writeln!(out, "; size {size}, seed {}, {time:.1} s", report.seed)
}

/// Lines of at most `width` columns, broken between words where that can be.
fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut last = 0;
    for word in one_line(text).split_inclusive(' ') {
        if last + word.trim_end().width() > width && last > 0 {
            lines.push(String::new());
            last = 0;
        }
        // Only a word that is longer than a line is broken itself.
        for c in word.chars() {
            let wide = c.width().unwrap_or(0);
            if last + wide > width && c != ' ' {
                lines.push(String::new());
                last = 0;
            }
            if let Some(line) = lines.last_mut() {
                line.push(c);
            }
            last += wide;
        }
    }
    lines.into_iter().map(|line| line.trim_end().to_string()).collect()
}

impl fmt::Display for Report {
    /// The table without colours.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", anstream::adapter::strip_str(&table(self, Detail::Worst)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::example;
    use super::*;

    fn plain(report: &Report, detail: Detail) -> String {
        anstream::adapter::strip_str(&table(report, detail)).to_string()
    }

    #[test]
    fn a_line_a_subject_and_failures_in_full() {
        let text = plain(&example(true), Detail::Worst);
        for part in
            ["A1  Albedo", "FAIL paint", "FAIL   tail \"quoted\"", "z +10.00", "ok   second", "1.0e-7 (≤ 1.0e-6)"]
        {
            assert!(text.contains(part), "{part} in\n{text}");
        }
        assert!(text.contains("reflects at most 0.94") && text.contains("FAILED: 1 of 6 checks; size default, seed 7"));
        assert!(!text.contains("  mean") && text.lines().all(|line| line.width() <= WIDTH), "{text}");
        assert!(text.matches("A1  ").count() == 1, "a topic's subjects stand together\n{text}");
    }

    #[test]
    fn more_and_less() {
        let all = plain(&example(false), Detail::All);
        assert!(all.contains("  mean") && all.contains("Lambert 1760") && all.contains("PASSED"), "{all}");
        let failures = plain(&example(true), Detail::Failures);
        assert!(failures.contains("tail") && !failures.contains("second") && !failures.contains("B2"), "{failures}");
    }

    #[test]
    fn texts_can_be_copied_and_notes_stand_last() {
        let report = Report { notes: vec!["nothing was skipped".into()], ..example(false) };
        let text = plain(&report, Detail::Worst);
        assert!(text.contains("a file:\n\n[a]\nb = \"</pre>\u{fffd}\"\n"), "{text}");
        assert!(text.contains("\nnote: nothing was skipped\nPASSED"), "{text}");
    }

    #[test]
    fn what_terminals_obey_is_taken_out() {
        let text = plain(&example(false), Detail::All);
        assert!(!text.contains('\u{1b}') && text.contains("control �[31m�"), "{text}");
    }

    #[test]
    fn long_names_go_on_below() {
        assert_eq!(wrap("one two three", 7), ["one two", "three"]);
        assert_eq!(wrap("  ab abcdefgh", 4), ["  ab", "abcd", "efgh"]);
        assert_eq!(wrap("日本語 a", 5), ["日本", "語 a"]);
        assert_eq!(wrap("", 5), [""]);
        let mut text = String::new();
        row(&mut text, true, &"word ".repeat(10), "3", Cells { detects: "1 %".into(), ..Cells::default() }).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines.len() == 2 && lines[0].ends_with("1 %") && lines[1].trim() == "word word word word", "{text}");
    }
}
