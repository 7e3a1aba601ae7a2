//! A report as a table for terminals.

use super::cells::{percent, probability};
use super::{Cells, Digest, Group, Report, Section, count, one_line};
use crate::stats::Check;
use crate::verify::Size;
use anstyle::{AnsiColor, Style};
use std::fmt::{self, Write};
use unicode_width::UnicodeWidthStr;

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
const COLUMNS: [usize; 7] = [4, 33, 5, 10, 21, 10, 8];

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
    let names = ["", "subject (its least likely check)", "check", "exact", "estimate ± SE", "z or p", "detects"];
    let cells = std::array::from_fn(|i| names[i].to_string());
    line(out, FAINT, &cells, FAINT)
}

fn write_group(out: &mut String, group: &Group, share: f64, detail: Detail) -> fmt::Result {
    let title = format!("{}  {}", group.topic.id, group.topic.title);
    for (i, part) in wrap(&title, WIDTH).iter().enumerate() {
        writeln!(out, "{}{STRONG}{part}{STRONG:#}", if i == 0 { "\n" } else { "" })?;
    }
    if detail == Detail::All && !group.topic.source.is_empty() {
        for part in wrap(group.topic.source, WIDTH - 4) {
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

/// Verdict and name to the left, numbers to the right; a name that is too long loses its end.
fn line(out: &mut String, verdict: Style, cells: &[String; 7], others: Style) -> fmt::Result {
    let mut text = String::new();
    for (i, (cell, width)) in cells.iter().zip(COLUMNS).enumerate().skip(1) {
        let cell = shorten(cell, width);
        let space = " ".repeat(width - cell.width());
        match i {
            1 => write!(text, " {cell}{space}")?,
            _ => write!(text, " {space}{cell}")?,
        }
    }
    let text = text.trim_end();
    let space = " ".repeat(COLUMNS[0].saturating_sub(cells[0].width()));
    writeln!(out, "  {verdict}{}{verdict:#}{space}{others}{text}{others:#}", cells[0])
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
    let size = match report.size {
        Size::Default => "default",
        Size::Thorough => "thorough",
    };
    writeln!(
        out,
        "\n{} checks of {} subjects share α = {}: |z| ≤ {:.2}, p ≥ {share:.1e} each",
        count(all),
        count(report.sections.len()),
        report.alpha,
        report.z_limit(),
    )?;
    let time = report.time.as_secs_f64();
    match failures {
        0 if all == 0 => write!(out, "{BAD}FAILED{BAD:#}: nothing was checked")?,
        0 => write!(out, "{GOOD}PASSED{GOOD:#}")?,
        n => write!(out, "{BAD}FAILED{BAD:#}: {} of {} checks", count(n), count(all))?,
    }
    writeln!(out, "; size {size}, seed {}, {time:.1} s", report.seed)
}

/// At most `width` columns, the last of them `…` where something is missing.
fn shorten(text: &str, width: usize) -> String {
    if text.width() <= width {
        return text.into();
    }
    let mut short = String::new();
    for c in text.chars() {
        if short.width() + c.to_string().width() + 1 > width {
            break;
        }
        short.push(c);
    }
    short + "…"
}

/// Lines of at most `width` columns, broken between words where that can be.
fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in one_line(text).split(' ') {
        match lines.last_mut() {
            Some(last) if last.width() + 1 + word.width() <= width => *last += &format!(" {word}"),
            _ => lines.push(word.into()),
        }
    }
    lines
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
        assert!(text.contains("reflects at most 0.94") && text.contains("FAILED: 1 of 5 checks; size default, seed 7"));
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
    fn what_terminals_obey_is_taken_out() {
        let text = plain(&example(false), Detail::All);
        assert!(!text.contains('\u{1b}') && text.contains("control �[31m�"), "{text}");
    }

    #[test]
    fn long_names_end_in_an_ellipsis() {
        assert_eq!([shorten("abcdef", 6), shorten("abcdef", 5), shorten("日本語", 5)], ["abcdef", "abcd…", "日本…"]);
        assert_eq!(wrap("one two three", 7), ["one two", "three"]);
    }
}
