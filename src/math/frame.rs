//! Orthonormal frames.

use glam::Vec3;

/// Right-handed orthonormal basis; local z is `n`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local x in world space.
    pub s: Vec3,
    /// Local y in world space.
    pub t: Vec3,
    /// Local z in world space: the normal.
    pub n: Vec3,
}

impl Frame {
    /// Any frame about the unit vector `n`, without branches or singularities (Duff et al. 2017, "Building an
    /// Orthonormal Basis, Revisited").
    #[inline]
    pub fn from_z(n: Vec3) -> Self {
        let sign = 1.0f32.copysign(n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        Self {
            s: Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            t: Vec3::new(b, sign + n.y * n.y * a, -n.y),
            n,
        }
    }

    /// The frame about the unit vector `n` whose x is as near to `tangent` as orthogonality allows; any frame where
    /// the tangent is parallel to `n` or not finite. `handedness` < 0 mirrors y.
    #[inline]
    pub fn from_z_tangent(n: Vec3, tangent: Vec3, handedness: f32) -> Self {
        if tangent == Vec3::ZERO { Self::from_z(n) } else { Self::along_tangent(n, tangent, handedness) }
    }

    #[inline(never)]
    fn along_tangent(n: Vec3, tangent: Vec3, handedness: f32) -> Self {
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
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(self.s.dot(v), self.t.dot(v), self.n.dot(v))
    }

    /// Local → world.
    #[inline]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.s * v.x + self.t * v.y + self.n * v.z
    }
}
