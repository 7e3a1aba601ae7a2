//! Rays, and origins that leave a surface without meeting it again.

use super::select;
use glam::Vec3;

/// Half-line `o + t d`, 0 < t < `t_max`. The direction need not be of unit length: instances trace the same `t`.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Origin \[m\].
    pub o: Vec3,
    /// Direction.
    pub d: Vec3,
    /// End of the open interval searched, in units of |d|.
    pub t_max: f32,
}

impl Ray {
    /// Ray without an end.
    #[inline]
    pub fn new(o: Vec3, d: Vec3) -> Self {
        Self { o, d, t_max: f32::INFINITY }
    }

    /// Point at parameter `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.o + self.d * t
    }
}

/// Origin for a ray that leaves the surface point `p` towards `w`: `p` moved along the unit normal `n` to the edge of
/// the box of its absolute errors `p_error`, then one float further, so that no scale needs an epsilon of its own
/// (PBRT 4th ed., section 6.8.6).
#[inline]
pub fn offset_origin(p: Vec3, p_error: Vec3, n: Vec3, w: Vec3) -> Vec3 {
    let d = n.abs().dot(p_error);
    let offset = n * d.copysign(w.dot(n));
    let q = p + offset;
    // A little more than the distance to the next float; for 0 too.
    let away = |q: f32, o: f32| {
        let step = (q.abs() * f32::EPSILON).max(f32::MIN_POSITIVE).copysign(o);
        q + select(o == 0.0, 0.0, step)
    };
    Vec3::new(away(q.x, offset.x), away(q.y, offset.y), away(q.z, offset.z))
}
