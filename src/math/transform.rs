//! Affine maps with their inverses.

use glam::{Affine3A, Mat4, Vec3A};

/// An invertible affine map between an object's space and the world.
#[derive(Clone, Copy, Debug)]
pub struct Transform {
    /// Object → world.
    pub to_world: Affine3A,
    /// World → object.
    pub to_object: Affine3A,
}

impl Transform {
    /// From a 4×4 matrix; `None` where it is singular, projective or not finite.
    pub fn from_mat4(m: Mat4) -> Option<Self> {
        let affine = m.row(3) == glam::Vec4::W && m.is_finite();
        // Inverted in f64: scales of 1e-3 and offsets of 1e6 may meet in one matrix.
        let inverse = m.as_dmat4().inverse();
        (affine && m.as_dmat4().determinant() != 0.0 && inverse.is_finite())
            .then(|| Self { to_world: Affine3A::from_mat4(m), to_object: Affine3A::from_mat4(inverse.as_mat4()) })
    }

    /// A normal (covector) to the world, not normalised.
    #[inline]
    pub fn normal_to_world(&self, n: impl Into<Vec3A>) -> Vec3A {
        self.to_object.matrix3.transpose() * n.into()
    }

    /// True where the map mirrors: it turns a right-handed frame into a left-handed one.
    pub fn mirrors(&self) -> bool {
        self.to_world.matrix3.determinant() < 0.0
    }
}
