//! The topics: what opens to subjects, and those to checks; below them the figures.

use super::super::cells::percent;
use super::super::{Cells, Digest, Group, Section, count, one_line};
use super::badge;
use super::figures::Figures;
use crate::stats::Check;
use maud::{Markup, html};

/// Most checks that a page lists; beyond, each subject shows its least likely ones.
const ROWS: usize = 8000;

/// All topics, with what searches in them.
pub(super) fn all(groups: &[Group], figures: &Figures, share: f64) -> Markup {
    let checks: usize = groups.iter().map(|group| group.checks().count()).sum();
    let subjects: usize = groups.iter().map(|group| group.sections.len()).sum();
    let rows = if checks <= ROWS { usize::MAX } else { (ROWS / subjects.max(1)).max(4) };
    html! {
        section #topics {
            h2 { "Checks" }
            div.tools hidden {
                input #search type="search" placeholder="Search" aria-label="Search subjects and checks";
                label { input #failing type="checkbox"; " only failing" }
                button #toggle type="button" aria-expanded="false" { "Open all topics" }
                span #found .faint role="status" {}
            }
            @for (i, group) in groups.iter().enumerate() { (topic(i, group, figures, share, rows)) }
        }
    }
}

fn topic(i: usize, group: &Group, figures: &Figures, share: f64, rows: usize) -> Markup {
    let failing = group.checks().any(|check| check.p() < share);
    html! {
        details.topic id={ "t" (i) } open[failing] {
            summary { (badge(!failing)) span.id { (group.topic.id) } (group.topic.title) }
            div.inside {
                @for source in group.sources() { p.faint { (source) } }
                @for (j, section) in group.sections.iter().enumerate() {
                    (subject(&format!("t{i}s{j}"), section, share, rows))
                }
                (figures.section(i))
            }
        }
    }
}

fn subject(id: &str, section: &Section, share: f64, rows: usize) -> Markup {
    let digest = Digest::new(&section.checks, share);
    let fails = !digest.failures.is_empty();
    let worst = digest.worst.map_or(String::new(), |check| Cells::new(check, share).statistic);
    let mut checks: Vec<&Check> = section.checks.iter().collect();
    if checks.len() > rows {
        checks.sort_by(|a, b| a.p().total_cmp(&b.p()));
        checks.truncate(rows.max(digest.failures.len()));
    }
    html! {
        details.subject.fails[fails] id=(id) open[fails] {
            summary {
                (badge(!fails))
                span.name { (one_line(&section.subject)) }
                span.n { (count(digest.checks)) @if digest.checks == 1 { " check" } @else { " checks" } }
                span.n { (worst) }
                span.n { @if let Some(bias) = digest.detects { "detects " (percent(bias)) } }
            }
            @if !section.words.is_empty() {
                ul.words { @for words in &section.words { li { (sentence(words)) } } }
            }
            div.scroll tabindex="0" role="region" aria-label={ "Checks of " (one_line(&section.subject)) } {
                table { (head(None)) tbody { @for check in &checks { (row(check, share, None)) } } }
            }
            @if checks.len() < section.checks.len() {
                p.faint { (count(section.checks.len() - checks.len())) " likelier checks are left out here; --json has all." }
            }
        }
    }
}

/// A verdict with `names` in backticks set apart.
fn sentence(words: &str) -> Markup {
    let words = one_line(words);
    html! {
        @for (i, part) in words.split('`').enumerate() { @if i % 2 == 1 { code { (part) } } @else { (part) } }
    }
}

/// The head of a table of checks, with a column before them where it has a name.
pub(super) fn head(first: Option<&str>) -> Markup {
    html! {
        thead { tr {
            th { "" }
            @if let Some(first) = first { th { (first) } }
            th { "check" } th.n { "exact" } th.n { "estimate ± SE" } th.n { "z or p" } th.n { "detects" }
        } }
    }
}

/// A check, behind a link to its subject.
pub(super) fn row(check: &Check, share: f64, link: Option<(&str, &str)>) -> Markup {
    let Cells { exact, estimate, statistic, detects } = Cells::new(check, share);
    let fails = check.p() < share;
    html! {
        tr.fails[fails] {
            td { (badge(!fails)) }
            @if let Some((href, name)) = link { td.name { a href=(href) { (one_line(name)) } } }
            td.name { (one_line(&check.name)) }
            td.n { (exact) } td.n { (estimate) } td.n { (statistic) } td.n { (detects) }
        }
    }
}
