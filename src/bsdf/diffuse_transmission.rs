//! Diffuse light that leaves on the other side of a surface.

use super::Transport;
use super::lambert::{CoupledDiffuse, sample_cosine};
use super::smooth::{refraction_scale, relative_eta};
use crate::spectrum::Spectrum;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// What a diffuse base under a coat on both of its sides lets through: [`CoupledDiffuse`] to the other side, with the
/// transmitted share τ for ρ. With 1 − d of a base that reflects ρ and d of one that transmits τ the sum is reciprocal,
/// and all of it comes back where ρ = τ = 1.
///
/// Where the sides differ in index, f(a→b)/η_b² = f(b→a)/η_a² wants more than symmetry: of the flux τ passes into the
/// denser medium, and only τ/η² into the thinner one; the rest is lost.
#[derive(Clone, Copy, Debug)]
pub struct DiffuseTransmission {
    /// The base, with τ for its reflectance.
    pub base: CoupledDiffuse,
    /// Index of the inside (behind the normal) over the outside.
    pub eta: f32,
}

impl DiffuseTransmission {
    /// Share of the base's flux that passes, beside τ.
    #[inline]
    fn passes(&self, wo: Vec3) -> f32 {
        // Into the denser medium all of it.
        let eta = relative_eta(self.eta, wo).min(1.0);
        eta * eta
    }

    /// f \[1/sr\] and density \[1/sr\] of `wi`; nothing on the side of `wo`.
    #[inline]
    pub(super) fn eval(&self, wo: Vec3, wi: Vec3, mode: Transport) -> (Spectrum, f32) {
        if wo.z * wi.z >= 0.0 {
            return (Spectrum::ZERO, 0.0);
        }
        let scale = self.passes(wo) * refraction_scale(relative_eta(self.eta, wo), mode);
        (self.base.f(wo, wi) * scale, wi.z.abs() * FRAC_1_PI)
    }

    /// Draws `wi` by the cosine on the other side, and says which η it crossed.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, u: [f32; 2]) -> (Vec3, f32) {
        (sample_cosine(-wo, u), relative_eta(self.eta, wo))
    }

    /// Directional albedo.
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        self.base.albedo(wo) * self.passes(wo)
    }
}
