//! A report for programs.
//!
//! One object ([`Document`]): what was run and how, the verdict, then every section with every check. Numbers that are
//! not finite are `null`; JSON has no others. Of the exhibits, which are for the eye, it has the texts.

use super::{About, Digest, Report, SOFTWARE};
use crate::stats::{Check, Evidence};
use serde::{Deserialize, Serialize};

/// All of it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Document {
    /// Program and version.
    pub software: String,
    /// What was checked: the program itself, or a scene.
    pub about: String,
    /// The command that does it again.
    pub command: String,
    /// `quick`, `default` or `thorough`.
    pub size: String,
    /// Seed of all of it.
    pub seed: u64,
    /// Significance that all checks share.
    pub alpha: f64,
    /// Smallest p with which a check passes.
    pub p_limit: f64,
    /// Largest |z| with which a check passes.
    pub z_limit: f64,
    /// Wall-clock time \[s\].
    pub seconds: f64,
    /// True where no check fails, and there is one.
    pub passes: bool,
    /// How many checks there are.
    pub checks: usize,
    /// How many of them fail.
    pub failures: usize,
    /// What each task found.
    pub sections: Vec<Section>,
    /// What is to be known of the run as a whole; no verdicts.
    #[serde(default)]
    pub notes: Vec<String>,
}

/// What one task found.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Section {
    /// Short name of what the checks are about.
    pub topic: String,
    /// What must hold.
    pub title: String,
    /// Where that comes from.
    pub source: String,
    /// What was checked.
    pub subject: String,
    /// Time from its beginning to its end \[s\].
    pub seconds: f64,
    /// True where no check fails, and there is one.
    pub passes: bool,
    /// Verdicts in words.
    pub words: Vec<String>,
    /// Texts to be copied, such as the smallest scene that fails.
    #[serde(default)]
    pub listings: Vec<String>,
    /// The checks.
    pub checks: Vec<Entry>,
}

/// One check. Which numbers it has depends on `kind`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Entry {
    /// What is checked.
    pub name: String,
    /// True where p ≥ `p_limit`.
    pub passes: bool,
    /// Its p-value; of an identity 1 within its bound and 0 beyond.
    pub p: f64,
    /// Smallest relative bias found with probability 0.99; of an identity its bound; `null` where that says nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub detects: Option<f64>,
    /// What speaks for or against it.
    #[serde(flatten)]
    pub kind: Kind,
}

/// What speaks for or against a check, told apart by the member `kind`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Kind {
    /// An estimate against its exact value.
    Z {
        /// The closed form, or the other estimate.
        exact: Option<f64>,
        /// The estimate.
        estimate: Option<f64>,
        /// Its standard error.
        se: Option<f64>,
        /// Degrees of freedom of that; `null` where it is known and not estimated.
        dof: Option<f64>,
        /// Largest absolute error of arithmetic, granted before z is taken.
        rounding: Option<f64>,
        /// The standard normal's quantile that is as unlikely.
        z: Option<f64>,
    },
    /// Another test's p-value.
    P,
    /// An identity that arithmetic alone limits.
    Bound {
        /// Largest relative deviation found.
        worst: Option<f64>,
        /// Largest one allowed.
        bound: Option<f64>,
    },
}

impl Document {
    /// Of a report.
    pub fn new(report: &Report, about: &About) -> Self {
        let share = report.share();
        let failures = report.failures().count();
        Self {
            software: SOFTWARE.into(),
            about: about.what.clone(),
            command: about.command.clone(),
            size: report.size.name().into(),
            seed: report.seed,
            alpha: report.alpha,
            p_limit: share,
            z_limit: report.z_limit(),
            seconds: report.time.as_secs_f64(),
            passes: report.passes(),
            checks: report.checks().count(),
            failures,
            sections: report.sections.iter().map(|section| Section::new(section, share)).collect(),
            notes: report.notes.clone(),
        }
    }
}

impl Section {
    fn new(section: &super::Section, share: f64) -> Self {
        Self {
            topic: section.topic.id.into(),
            title: section.topic.title.into(),
            source: section.topic.source.into(),
            subject: section.subject.clone(),
            seconds: section.time.as_secs_f64(),
            passes: Digest::new(&section.checks, share).passes(),
            words: section.words.clone(),
            listings: section.listings().map(|listing| listing.text.clone()).collect(),
            checks: section.checks.iter().map(|check| Entry::new(check, share)).collect(),
        }
    }
}

impl Entry {
    fn new(check: &Check, share: f64) -> Self {
        let kind = match check.evidence {
            Evidence::Z { exact, estimate, se, dof, rounding } => Kind::Z {
                exact: Some(exact),
                estimate: Some(estimate),
                se: Some(se),
                dof: Some(dof).filter(|dof| dof.is_finite()),
                rounding: Some(rounding),
                z: check.z(),
            },
            Evidence::P { .. } => Kind::P,
            Evidence::Bound { worst, bound } => Kind::Bound { worst: Some(worst), bound: Some(bound) },
        };
        let (name, p) = (check.name.clone(), check.p());
        Self { name, passes: p >= share, p, detects: check.detects(share), kind }
    }
}

/// The document as text, indented, with a line end.
pub fn text(report: &Report, about: &About) -> serde_json::Result<String> {
    serde_json::to_string_pretty(&Document::new(report, about)).map(|text| text + "\n")
}

#[cfg(test)]
mod tests {
    use super::super::tests::{about, example};
    use super::*;
    use serde_json::Value;

    #[test]
    fn what_was_written_is_read_again() {
        let report = example(true);
        let text = text(&report, &about()).unwrap();
        let document: Document = serde_json::from_str(&text).unwrap();
        assert!(!document.passes && document.checks == 6 && document.failures == 1 && document.seed == 7);
        assert_eq!(document.p_limit, report.share());
        let wrong: Vec<&Entry> = document.sections.iter().flat_map(|s| &s.checks).filter(|c| !c.passes).collect();
        assert_eq!(wrong.len(), 1);
        assert_eq!(document.sections[2].listings.len(), 1);
        let Kind::Z { exact, estimate, z, dof, .. } = wrong[0].kind else { panic!("{text}") };
        assert_eq!((exact, estimate, dof), (Some(0.5), Some(0.6), None));
        assert!((z.unwrap() - 10.0).abs() < 1e-9);
    }

    #[test]
    fn kinds_are_told_apart_by_a_member() {
        let value: Value = serde_json::from_str(&text(&example(false), &about()).unwrap()).unwrap();
        let kind = |section: usize, check: usize| value["sections"][section]["checks"][check]["kind"].clone();
        assert_eq!([kind(0, 0), kind(0, 2), kind(1, 0)], ["z", "p", "bound"]);
        assert_eq!(value["sections"][1]["checks"][0]["bound"], 1e-6);
    }
}
