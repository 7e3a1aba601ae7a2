//! Orthonormal frames.

use glam::{Vec3, Vec3A};

/// Right-handed orthonormal basis; local z is `n`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local x in world space.
    pub s: Vec3A,
    /// Local y in world space.
    pub t: Vec3A,
    /// Local z in world space: the normal.
    pub n: Vec3A,
}

impl Frame {
    /// Any frame about the unit vector `n`, without branches or singularities (Duff et al. 2017, "Building an
    /// Orthonormal Basis, Revisited"): with σ the sign of n_z and v = n + σz it is
    ///
    /// ```text
    /// s = x − σ n_x/(σ + n_z) v,    t = σy − n_y/(σ + n_z) v
    /// ```
    #[inline]
    pub fn from_z(n: impl Into<Vec3A>) -> Self {
        let n = n.into();
        let sign = 1.0f32.copysign(n.z);
        let v = n + Vec3A::Z * sign;
        let a = -1.0 / v.z;
        Self { s: Vec3A::X + v * (sign * n.x * a), t: Vec3A::Y * sign + v * (n.y * a), n }
    }

    /// The frame about the unit vector `n` whose x is as near to `tangent` as orthogonality allows; any frame where
    /// the tangent is parallel to `n` or not finite. `handedness` < 0 mirrors y.
    #[inline]
    pub fn from_z_tangent(n: impl Into<Vec3A>, tangent: impl Into<Vec3A>, handedness: f32) -> Self {
        let (n, tangent) = (n.into(), tangent.into());
        if tangent == Vec3A::ZERO { Self::from_z(n) } else { Self::along_tangent(n, tangent, handedness) }
    }

    #[inline(never)]
    fn along_tangent(n: Vec3A, tangent: Vec3A, handedness: f32) -> Self {
        let s = tangent - n * n.dot(tangent);
        let length2 = s.length_squared();
        if !(length2 > 1e-12 * tangent.length_squared() && length2.is_finite()) {
            return Self::from_z(n);
        }
        let s = s / length2.sqrt();
        let t = n.cross(s);
        Self { s, t: if handedness < 0.0 { -t } else { t }, n }
    }

    /// World → local.
    #[inline]
    pub fn to_local(&self, v: impl Into<Vec3A>) -> Vec3 {
        let v = v.into();
        Vec3::new(self.s.dot(v), self.t.dot(v), self.n.dot(v))
    }

    /// Local → world.
    #[inline]
    pub fn to_world(&self, v: Vec3) -> Vec3A {
        self.s * v.x + self.t * v.y + self.n * v.z
    }
}
