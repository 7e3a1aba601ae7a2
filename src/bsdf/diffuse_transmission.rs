//! Diffuse light that leaves on the other side of a surface: what a diffuse base under a coat on both of its sides lets
//! through, [`super::CoupledDiffuse`] to the other side, with the transmitted share τ for ρ. With 1 − d of a base that
//! reflects ρ and d of one that transmits τ the sum is reciprocal, and all of it comes back where ρ = τ = 1.
//!
//! Where the sides differ in index, f(a→b)/η_b² = f(b→a)/η_a² wants more than symmetry: of the flux τ passes into the
//! denser medium, and only τ/η² into the thinner one; the rest is lost.

use super::Transport;
use super::lambert::sample_cosine;
use super::smooth::{refraction_scale, relative_eta};
use glam::Vec3;

/// Share of the base's flux that passes, beside τ; of radiance, in radiance transport. `eta` is the index of the inside over
/// the outside.
#[inline]
pub(super) fn passed(eta: f32, wo: Vec3, mode: Transport) -> f32 {
    let eta = relative_eta(eta, wo);
    // Into the denser medium all of it.
    let thinner = eta.min(1.0);
    thinner * thinner * refraction_scale(eta, mode)
}

/// Draws `wi` by the cosine on the other side, and says which η it crossed.
#[inline]
pub(super) fn sample(eta: f32, wo: Vec3, u: [f32; 2]) -> (Vec3, f32) {
    (sample_cosine(-wo, u), relative_eta(eta, wo))
}
