//! Many checks in a line.

use super::{Section, Topic};
use crate::stats::{Check, Evidence};

/// The sections of one topic.
#[derive(Clone, Debug)]
pub struct Group<'a> {
    /// The topic; where several say one `id`, the first of them.
    pub topic: Topic,
    /// Its sections, in the order of their tasks.
    pub sections: Vec<&'a Section>,
}

impl<'a> Group<'a> {
    /// All its checks.
    pub fn checks(&self) -> impl Iterator<Item = &'a Check> {
        self.sections.iter().flat_map(|section| &section.checks)
    }

    /// Where what must hold comes from, each once.
    pub fn sources(&self) -> Vec<&'static str> {
        let mut sources = Vec::new();
        for source in self.sections.iter().map(|section| section.topic.source) {
            if !source.is_empty() && !sources.contains(&source) {
                sources.push(source);
            }
        }
        sources
    }
}

/// What many checks say together.
#[derive(Clone, Debug)]
pub struct Digest<'a> {
    /// How many there are.
    pub checks: usize,
    /// Those that fail.
    pub failures: Vec<&'a Check>,
    /// The least likely one.
    pub worst: Option<&'a Check>,
    /// Largest of their smallest detectable relative biases: what all of them would have found.
    pub detects: Option<f64>,
    /// Smallest of them: what the best check would have found.
    pub finest: Option<f64>,
}

impl<'a> Digest<'a> {
    /// Of checks that each pass with p ≥ `share`.
    pub fn new(checks: impl IntoIterator<Item = &'a Check>, share: f64) -> Self {
        let mut digest = Self { checks: 0, failures: Vec::new(), worst: None, detects: None, finest: None };
        let mut least = (f64::INFINITY, f64::INFINITY);
        for check in checks {
            digest.checks += 1;
            let rank = (check.p(), room(check));
            if rank.0 < share {
                digest.failures.push(check);
            }
            if digest.worst.is_none() || rank < least {
                (digest.worst, least) = (Some(check), rank);
            }
            if let Some(bias) = check.detects(share).filter(|bias| bias.is_finite()) {
                digest.detects = Some(digest.detects.map_or(bias, |most| most.max(bias)));
                digest.finest = Some(digest.finest.map_or(bias, |least| least.min(bias)));
            }
        }
        digest
    }

    /// True where no check fails, and there is one.
    pub fn passes(&self) -> bool {
        self.checks > 0 && self.failures.is_empty()
    }
}

/// What orders checks of equal p, which is mostly 0 or 1: estimates by how far they are off, identities by how close they
/// are to their bound, then what has nothing more to say.
fn room(check: &Check) -> f64 {
    match check.evidence {
        Evidence::Z { .. } => -1.0 - check.t().map_or(0.0, f64::abs),
        Evidence::Bound { worst, bound } => 1.0 - (worst / bound).min(2.0),
        Evidence::P { .. } => f64::MAX,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Family;

    #[test]
    fn the_worst_is_the_least_likely() {
        let mut family = Family::new("");
        family.bound("near", 9e-7, 1e-6);
        family.bound("far", 1e-8, 1e-6);
        let digest = Digest::new(family.checks(), 1e-4);
        assert_eq!(digest.worst.map(|check| &*check.name), Some("near"));
        family.estimate("off", 1.0, 1.03, 0.01);
        family.estimate("impossible", 0.0, 0.0, 0.01);
        let digest = Digest::new(family.checks(), 1e-4);
        assert_eq!((digest.worst.map(|check| &*check.name), digest.checks), (Some("off"), 4));
        assert!(digest.passes() && digest.detects.is_some_and(|d| (0.05..0.1).contains(&d)));
        assert!(!Digest::new([], 1e-4).passes());
    }
}
