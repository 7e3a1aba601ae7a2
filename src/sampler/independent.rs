//! Independent pseudo-random numbers.

use super::hash::{fork_key, mix, pixel_hash};
use super::unit;
use rand::Rng;
use rand_pcg::Pcg32;

/// PCG (O'Neill 2014): each sample of each pixel has its own state and stream; dimensions are successive numbers, to
/// which the generator jumps in logarithmic time.
#[derive(Clone, Debug)]
pub struct Independent {
    generator: Pcg32,
    dimension: u32,
    /// Hash of the seed, the pixel and the index.
    key: u64,
}

impl Independent {
    /// At dimension 0.
    #[inline]
    pub fn new(seed: u64, pixel: [u32; 2], index: u64) -> Self {
        Self::of_key(pixel_hash(seed, pixel, index))
    }

    #[inline]
    fn of_key(key: u64) -> Self {
        Self { generator: Pcg32::new(key, mix(!key)), dimension: 0, key }
    }

    /// Numbers independent of these, at dimension 0; others for every `branch`.
    #[inline]
    pub fn fork(&self, branch: u32) -> Self {
        Self::of_key(fork_key(self.key, branch))
    }

    /// The number at this dimension; goes on to the next.
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        self.dimension = self.dimension.wrapping_add(1);
        unit(self.generator.next_u32())
    }

    /// Two successive numbers.
    #[inline]
    pub fn next_2d(&mut self) -> [f32; 2] {
        [self.next_1d(), self.next_1d()]
    }

    /// Goes to `dimension`; back is the long way round the generator's period.
    #[inline]
    pub fn skip_to(&mut self, dimension: u32) {
        self.generator.advance((dimension as u64).wrapping_sub(self.dimension as u64));
        self.dimension = dimension;
    }

    /// The dimension that comes next.
    #[inline]
    pub fn dimension(&self) -> u32 {
        self.dimension
    }
}
