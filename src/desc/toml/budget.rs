//! How much memory a file may ask for. Groups of groups and mixtures of mixtures multiply: a few kilobytes of text could name
//! more objects or scattering models than any machine holds.

use super::read::Fault;
use std::ops::Range;

/// Memory of one sort that a scene may still take.
#[derive(Debug)]
pub(super) struct Budget {
    what: &'static str,
    limit: usize,
    spent: usize,
}

impl Budget {
    /// Objects and lights that instances place.
    pub(super) fn of_instances() -> Self {
        Self { what: "the instances", limit: 1 << 30, spent: 0 }
    }

    /// Scattering models of mixtures; each part of a mixture has a model of its own.
    pub(super) fn of_mixtures() -> Self {
        Self { what: "the mixtures", limit: 64 << 20, spent: 0 }
    }

    /// Takes `bytes` for what stands at `at`; an error where that is more than is left.
    pub(super) fn pay(&mut self, bytes: usize, at: &Range<usize>) -> Result<(), Fault> {
        self.spent = self.spent.saturating_add(bytes);
        if self.spent > self.limit {
            let Self { what, limit, .. } = self;
            return Err(Fault::new(at, format!("{what} would take more than {} MiB", *limit >> 20)));
        }
        Ok(())
    }
}
