//! Independent pseudo-random numbers.

use super::hash::{mix, pixel_hash};
use super::unit;
use rand::Rng;
use rand_pcg::Pcg32;

/// PCG (O'Neill 2014): each sample of each pixel has its own state and stream; dimensions are successive numbers, to
/// which the generator jumps in logarithmic time.
#[derive(Clone, Debug)]
pub struct Independent {
    generator: Pcg32,
    dimension: u32,
}

impl Independent {
    /// At dimension 0.
    #[inline]
    pub fn new(seed: u64, pixel: [u32; 2], index: u64) -> Self {
        let state = pixel_hash(seed, pixel, index);
        Self { generator: Pcg32::new(state, mix(!state)), dimension: 0 }
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
