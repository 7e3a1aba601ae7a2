//! How a point of a surface is seen: densities over area and solid angle, planes seen edge-on, where shadow rays end.

use crate::math::UNIT_ROUNDOFF;
use glam::Vec3A;

/// How a point of a surface is seen from a reference point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sight {
    /// Unit direction to the point.
    pub wi: Vec3A,
    /// Distance \[m\].
    pub distance: f32,
    /// Cosine at the seen surface: positive where its front is seen.
    pub cos: f32,
}

impl Sight {
    /// `None` where the points coincide or the surface is seen edge-on.
    #[inline(always)]
    pub(super) fn new(reference: Vec3A, p: Vec3A, ng: Vec3A) -> Option<Self> {
        let to = p - reference;
        let distance = to.length();
        let wi = to * distance.recip();
        let cos = -wi.dot(ng);
        // Also false for NaN.
        (distance > 0.0 && distance.is_finite() && cos.abs() > 0.0).then_some(Self { wi, distance, cos })
    }

    /// pω = p_A r²/|cos θ| (PBRT 4th ed., equation 4.15).
    #[inline]
    pub(super) fn solid_angle_pdf(&self, area_pdf: f32) -> f32 {
        area_pdf * self.distance * self.distance / self.cos.abs()
    }

    /// Whether the reference point lies off the tangent plane of the point as far as rounding can tell: in it the cosine, and
    /// with that a density over area, is noise.
    #[inline]
    pub(super) fn is_off_plane(&self, reference: Vec3A, p: Vec3A, ng: Vec3A) -> bool {
        self.distance * self.cos.abs() > in_plane(reference, p, ng)
    }

    /// By how much a shadow ray ends before the point, which lies off the surface by up to `error` along the normal. So much,
    /// and 8 u of the distance for the direction and the length of the ray, moves the hit by 1/|cos θ| of it.
    #[inline]
    pub(super) fn margin(&self, error: f32) -> f32 {
        (error + 8.0 * UNIT_ROUNDOFF * self.distance) / self.cos.abs()
    }
}

/// Height over the plane through `p` up to which `reference` may lie in it: 16 u of either, as far as rounding moves a hit.
#[inline]
pub(super) fn in_plane(reference: Vec3A, p: Vec3A, ng: Vec3A) -> f32 {
    16.0 * UNIT_ROUNDOFF * (reference.abs() + p.abs()).dot(ng.abs())
}
