//! Who asks for light.

use glam::Vec3A;

/// A point that light is drawn towards, with what is known of the directions that matter there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSampleContext {
    /// The point.
    pub p: Vec3A,
    /// What it faces.
    pub facing: Facing,
}

/// Directions from which light counts at a [`LightSampleContext`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Facing {
    /// All alike.
    All,
    /// The half-space of this unit vector, weighted by the cosine to it: what only reflects.
    Half(Vec3A),
    /// Both sides, weighted by the cosine to this unit vector: what transmits too.
    Both(Vec3A),
}

impl LightSampleContext {
    /// A point that light reaches from all directions alike.
    #[inline]
    pub fn anywhere(p: impl Into<Vec3A>) -> Self {
        Self { p: p.into(), facing: Facing::All }
    }
}
