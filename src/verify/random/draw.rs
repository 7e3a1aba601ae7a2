//! Random choices: the whole scene is a function of the seed and the index that the numbers come from.

use crate::sampler::{Kind, Sampler, mix};
use glam::Vec3;

/// A stream of random choices.
#[derive(Clone, Debug)]
pub(super) struct Draw(Sampler);

impl Draw {
    /// The stream of scene `index` of `seed`.
    pub(super) fn new(seed: u64, index: u64) -> Self {
        Self(Sampler::new(Kind::Independent, mix(seed) ^ index, [0x5c, 0xe9], 0, 1))
    }

    /// Uniform in [0, 1).
    pub(super) fn unit(&mut self) -> f32 {
        self.0.next_1d()
    }

    /// Uniform in [a, b).
    pub(super) fn between(&mut self, a: f32, b: f32) -> f32 {
        a + (b - a) * self.unit()
    }

    /// True with probability `p`.
    pub(super) fn chance(&mut self, p: f32) -> bool {
        self.unit() < p
    }

    /// Uniform below `n`.
    pub(super) fn below(&mut self, n: usize) -> usize {
        ((self.unit() * n as f32) as usize).min(n - 1)
    }

    /// One of a list.
    pub(super) fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }

    /// Linear RGB with every channel in [a, b).
    pub(super) fn rgb(&mut self, a: f32, b: f32) -> [f32; 3] {
        std::array::from_fn(|_| self.between(a, b))
    }

    /// A point in a box about the origin.
    pub(super) fn within(&mut self, half: Vec3) -> Vec3 {
        Vec3::from_array(self.rgb(-1.0, 1.0)) * half
    }

    /// A unit vector, uniform over the sphere.
    pub(super) fn direction(&mut self) -> Vec3 {
        crate::warp::uniform_sphere([self.unit(), self.unit()])
    }
}
