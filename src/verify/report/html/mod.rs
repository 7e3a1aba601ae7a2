//! A report as a page that needs nothing but itself: no other file, no network, and no right to any.
//!
//! Every name in it is escaped by [`maud`], which escapes all that is not said to be markup; and the page's own policy lets
//! no script or style run but those whose hash it carries.

mod chart;
mod curve;
mod figures;
mod heat_map;
mod histogram;
mod picture;
mod topic;

use super::cells::percent;
use super::{About, Cells, Digest, Group, Report, SOFTWARE, count, one_line};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use figures::Figures;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use sha2::{Digest as _, Sha256};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// The page as text.
pub fn page(report: &Report, about: &About) -> String {
    let (share, groups) = (report.share(), report.groups());
    let figures = Figures::choose(&groups, share);
    let body = html! {
        (header(report, about))
        main {
            (overview(&groups, share))
            (failures(&groups, share))
            (histogram::section(report))
            (topic::all(&groups, &figures, share))
        }
        footer { p.faint { "Written by " (SOFTWARE) "." } }
    };
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy());
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (verdict(report)) ": " (one_line(&about.what)) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                (body)
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    page.into_string()
}

/// Nothing but the style and the script above, and pictures that are in the page.
fn policy() -> String {
    let hash = |text: &str| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text)));
    format!(
        "default-src 'none'; img-src data:; style-src {}; script-src {}; base-uri 'none'; form-action 'none'",
        hash(STYLE),
        hash(SCRIPT)
    )
}

fn verdict(report: &Report) -> &'static str {
    if report.passes() { "passed" } else { "FAILED" }
}

fn badge(passes: bool) -> Markup {
    html! { span.badge.(if passes { "ok" } else { "bad" }) { (if passes { "ok" } else { "FAIL" }) } }
}

fn header(report: &Report, about: &About) -> Markup {
    let (all, failures) = (report.checks().count(), report.failures().count());
    let size = report.size.name();
    let facts = [
        ("checks", count(all)),
        ("failures", count(failures)),
        ("subjects", count(report.sections.len())),
        ("α, shared by all", report.alpha.to_string()),
        ("limit of |z|", format!("{:.2}", report.z_limit())),
        ("limit of p", format!("{:.1e}", report.share())),
        ("seed", report.seed.to_string()),
        ("size", size.into()),
        ("time", format!("{:.1} s", report.time.as_secs_f64())),
        ("version", SOFTWARE.into()),
    ];
    html! {
        header {
            h1 {
                span.badge.(if report.passes() { "ok" } else { "bad" }) { (verdict(report)) }
                " " (one_line(&about.what))
            }
            p {
                "Each check is a hypothesis test. Correct code fails one such run in " (count((1.0 / report.alpha) as usize))
                "; a bias of at least what a check “detects” is found with probability 0.99."
            }
            dl.facts {
                @for (name, value) in facts { div { dt { (name) } dd { (value) } } }
                @for note in &report.notes { div.wide { dt { "note" } dd { (one_line(note)) } } }
                div.wide { dt { "do it again" } dd { code { (one_line(&about.command)) } } }
            }
        }
    }
}

/// A line a topic.
fn overview(groups: &[Group], share: f64) -> Markup {
    html! {
        section #overview {
            h2 { "Topics" }
            div.scroll tabindex="0" role="region" aria-label="Topics" {
                table {
                    thead { tr {
                        th { "" } th { "topic" } th.n { "subjects" } th.n { "checks" } th.n { "fail" } th.n { "worst" }
                        th.n title="of the best check and of the worst" { "detects" }
                    } }
                    tbody { @for (i, group) in groups.iter().enumerate() { (overview_row(i, group, share)) } }
                }
            }
        }
    }
}

fn overview_row(i: usize, group: &Group, share: f64) -> Markup {
    let digest = Digest::new(group.checks(), share);
    html! {
        tr {
            td { (badge(digest.failures.is_empty())) }
            td.name { a href={ "#t" (i) } { (group.topic.id) } " " (group.topic.title) }
            td.n { (count(group.sections.len())) }
            td.n { (count(digest.checks)) }
            td.n { (count(digest.failures.len())) }
            td.n { (digest.worst.map_or(String::new(), |check| Cells::new(check, share).statistic)) }
            td.n { @if let (Some(best), Some(worst)) = (digest.finest, digest.detects) { (percent(best)) " … " (percent(worst)) } }
        }
    }
}

/// Every check that fails, together.
fn failures(groups: &[Group], share: f64) -> Markup {
    let failing = |group: &Group| group.checks().any(|check| check.p() < share);
    html! {
        @if groups.iter().any(failing) {
            section #failures {
                h2 { "Failures" }
                div.scroll tabindex="0" role="region" aria-label="Failures" {
                    table {
                        (topic::head(Some("subject")))
                        tbody {
                            @for (i, group) in groups.iter().enumerate() {
                                @for (j, section) in group.sections.iter().enumerate() {
                                    @for check in section.checks.iter().filter(|check| check.p() < share) {
                                        (topic::row(check, share, Some((&format!("#t{i}s{j}"), &section.name()))))
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{about, example};
    use super::*;

    #[test]
    fn every_name_is_escaped() {
        let page = page(&example(true), &about());
        assert!(page.contains("paint &lt;script&gt;alert(1)&lt;/script&gt;"), "{page}");
        assert!(!page.contains("<script>alert") && !page.contains("<b>scene") && !page.contains("</title>\""));
        assert_eq!(page.matches("<script").count(), 1, "the page's own");
        assert_eq!(page.matches("</title>").count(), page.matches("<title").count());
        assert!(!page.contains("http:") && !page.contains("https:"), "nothing from elsewhere");
    }

    #[test]
    fn all_sections_are_there() {
        let (good, bad) = (page(&example(false), &about()), page(&example(true), &about()));
        for id in ["overview", "distribution", "topics", "t0", "t1", "t0s1"] {
            assert!(good.contains(&format!("id=\"{id}\"")), "{id} in\n{good}");
        }
        assert!(bad.contains("id=\"failures\"") && !good.contains("id=\"failures\""));
        assert!(bad.contains("FAILED") && good.contains("passed"));
        assert!(
            good.contains("<code>paint</code>: reflects at most 0.94") && good.matches("data:image/png").count() >= 4
        );
    }

    #[test]
    fn style_and_script_cannot_end_themselves() {
        assert!(!STYLE.contains("</") && !SCRIPT.contains("</"));
    }
}
