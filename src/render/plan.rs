//! Which replicate of which pixels a round takes.

use super::schedule::Pixels;
use crate::film::Splats;

/// What a round does.
pub(super) struct Plan {
    pub(super) replicates: Replicates,
    /// Where paths bring light to other pixels than their own, if any of them do.
    pub(super) splats: Option<Splats>,
}

/// Numbers of replicates that pixels of the window have begun.
#[derive(Clone)]
pub(super) enum Replicates {
    Same(u32),
    /// Row by row. In a plan, `None` where a pixel is left out.
    Each(Vec<Option<u32>>),
}

impl Plan {
    /// Number of the replicate that the round takes of a pixel, the `i`th of the window; `None` if it takes none.
    pub(super) fn replicate(&self, i: usize) -> Option<u32> {
        match &self.replicates {
            Replicates::Same(replicate) => Some(*replicate),
            Replicates::Each(each) => each.get(i).copied().flatten(),
        }
    }
}

impl Replicates {
    /// Begins one more replicate of `pixels`, of so many in all, and says which of each.
    pub(super) fn advance(&mut self, pixels: Pixels, count: usize) -> Self {
        if let (Self::Same(begun), Pixels::All) = (&mut *self, &pixels) {
            *begun += 1;
            return Self::Same(*begun - 1);
        }
        if let Self::Same(begun) = *self {
            *self = Self::Each(vec![Some(begun); count]);
        }
        let Self::Each(each) = self else { return Self::Each(Vec::new()) };
        let chosen = |i: usize| match &pixels {
            Pixels::All => true,
            Pixels::These(these) => these.get(i).copied().unwrap_or(false),
        };
        let one = |(i, begun): (usize, &mut Option<u32>)| {
            let replicate = begun.filter(|_| chosen(i));
            *begun = begun.map(|n| n + u32::from(chosen(i)));
            replicate
        };
        Self::Each(each.iter_mut().enumerate().map(one).collect())
    }
}
