//! Bounding volume hierarchies behind two questions: what is the nearest hit, and is anything in the way?
//!
//! obvhs builds a binary tree; `build.rs` collapses it to eight children a node by the surface area heuristic; the
//! kernels in `kernel/` walk it with eight lanes at a time. [`TriangleBvh`] holds triangles and answers in any
//! space; [`BoxBvh`] holds whatever has a box (instances, quadrics) and asks a closure at its leaves.

mod boxes;
mod build;
mod fragments;
mod kernel;
mod node;
mod obstacle;
mod triangles;

pub use boxes::BoxBvh;
pub use build::Quality;
pub use kernel::Isa;
pub use obstacle::{Obstacle, PASSAGES, Passages, Passing};
pub use triangles::{TriangleBvh, TriangleHit, TriangleRef};

use glam::Vec3;

/// Axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Least corner.
    pub min: Vec3,
    /// Greatest corner.
    pub max: Vec3,
}

impl Aabb {
    /// Holds nothing.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// Smallest box about points.
    pub fn of(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self { min: b.min.min(p), max: b.max.max(p) })
    }

    /// Smallest box about both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Holds nothing.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The eight corners.
    pub fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|i| {
            let pick = |axis: usize| if i >> axis & 1 == 0 { self.min[axis] } else { self.max[axis] };
            Vec3::new(pick(0), pick(1), pick(2))
        })
    }
}
