//! A report as a page that needs nothing but itself.

use super::{About, Report};
use maud::{DOCTYPE, html};

/// The page as text.
pub fn page(report: &Report, about: &About) -> String {
    let verdict = if report.passes() { "passed" } else { "failed" };
    html! { (DOCTYPE) html lang="en" { head { title { (about.what) ": " (verdict) } } body { pre { (report) } } } }
        .into_string()
}
