//! Rays, and origins that leave a surface without meeting it again.

use glam::Vec3A;

/// Half-line `o + t d`, 0 < t < `t_max`. The direction need not be of unit length: instances trace the same `t`.
///
/// What is in the space of a ray, be it the world or an object, is a `Vec3A`: one SIMD register, of which every operation
/// moves three coordinates. Local directions, whose cosine is looked at alone, are three floats, `Vec3`.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Origin \[m\].
    pub o: Vec3A,
    /// Direction.
    pub d: Vec3A,
    /// End of the open interval searched, in units of |d|.
    pub t_max: f32,
}

impl Ray {
    /// Ray without an end.
    #[inline]
    pub fn new(o: impl Into<Vec3A>, d: impl Into<Vec3A>) -> Self {
        Self { o: o.into(), d: d.into(), t_max: f32::INFINITY }
    }

    /// Point at parameter `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3A {
        self.o + self.d * t
    }
}

/// Origin for a ray that leaves the surface point `p` towards `w`: `p` moved along the unit normal `n` to the edge of
/// the box of its absolute errors `p_error`, then one float further, so that no scale needs an epsilon of its own
/// (PBRT 4th ed., section 6.8.6).
#[inline]
pub fn offset_origin(p: Vec3A, p_error: Vec3A, n: Vec3A, w: Vec3A) -> Vec3A {
    let d = n.abs().dot(p_error);
    let offset = n * d.copysign(w.dot(n));
    let q = p + offset;
    // A little more than the distance to the next float; for 0 too.
    let step = (q.abs() * f32::EPSILON).max(Vec3A::splat(f32::MIN_POSITIVE)).copysign(offset);
    q + Vec3A::select(offset.cmpeq(Vec3A::ZERO), Vec3A::ZERO, step)
}
