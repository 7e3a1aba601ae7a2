//! From density over area to density over solid angle, and where shadow rays end.

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

    /// Where a shadow ray may end: before it meets the light's own surface, whichever way its origin, its direction
    /// and the surface were rounded. Shifting any of them by δ along the light's normal moves the hit by δ/|cos θ|
    /// along the ray. δ counts the offset of the origin and the error of a point interpolated in a triangle, 16 ulp
    /// of either point, and 4 ulp of the distance for the direction.
    #[inline]
    pub(super) fn shadow_end(&self, reference: Vec3A, p: Vec3A, ng: Vec3A) -> f32 {
        let coordinates = (reference.abs() + p.abs()).dot(ng.abs());
        let delta = UNIT_ROUNDOFF * (16.0 * coordinates + 4.0 * self.distance);
        (self.distance - delta / self.cos.abs()).max(0.0)
    }
}
