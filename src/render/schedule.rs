//! What a render does next.

use super::Settings;
use crate::film::Film;
use std::fmt;

/// Decides which round follows. The decision is a pure function of merged sums, so that the image depends neither on the
/// number of threads nor on when they came; what only ends a render early (the time, an interrupt) stands apart.
pub enum Schedule {
    /// So many rounds of all pixels: nothing to decide, so that threads run ahead as far as there is work.
    Fixed(u32),
    /// Round r follows from the sums of the rounds before r − lag, and of no others; the first `lag` + 1 from those of none.
    /// With a lag of 1 threads work on round r − 1 while r is decided, so that none waits where rounds hold many tiles.
    ///
    /// Whoever averages the samples that the choice was made from is biased towards pixels that seemed done: the choice
    /// should look at other replicates than those that count, or at all alike.
    Adaptive {
        /// Rounds that may be under way while the next is decided.
        lag: u32,
        /// The decision.
        decide: Decide,
    },
}

/// What follows from the number of a round and the merged sums.
pub type Decide = Box<dyn Fn(u32, &Film) -> Next + Send + Sync>;

/// What follows a round.
#[derive(Clone, Debug, PartialEq)]
pub enum Next {
    /// Nothing: the image is done.
    Stop,
    /// One replicate more of these pixels.
    Sample(Pixels),
}

/// Pixels that a round samples.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// All of the window.
    All,
    /// Those that are true here, row by row; what is missing is not sampled. All, where paths bring light to other pixels than
    /// their own: a replicate is then of the whole window.
    These(Vec<bool>),
}

impl Schedule {
    /// All pixels, replicate by replicate, until there are `spp` samples of each.
    pub fn of(settings: &Settings) -> Self {
        Self::Fixed(settings.spp / settings.replicate.max(1))
    }
}

impl fmt::Debug for Schedule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fixed(rounds) => write!(f, "Fixed({rounds})"),
            Self::Adaptive { lag, .. } => write!(f, "Adaptive {{ lag: {lag} }}"),
        }
    }
}
