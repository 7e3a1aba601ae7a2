//! Perfectly smooth interfaces: delta lobes.

use super::fresnel::{dielectric, refract};
use super::{Fresnel, Transport};
use crate::spectrum::Spectrum;
use glam::Vec3;

/// Reflects into the mirror direction.
#[derive(Clone, Debug)]
pub struct Mirror {
    /// Reflectance over the angle.
    pub fresnel: Fresnel,
}

/// Interface between two dielectrics.
#[derive(Clone, Copy, Debug)]
pub struct SmoothDielectric {
    /// Index of the inside (behind the normal) over the outside.
    pub eta: f32,
    /// Factor on transmitted light.
    pub tint: Spectrum,
}

/// Infinitely thin sheet that lets through, unbent, what its coat does not reflect: tint (1 − F).
#[derive(Clone, Debug)]
pub struct ThinTransmission {
    /// What the coat reflects, by a lobe of its own.
    pub fresnel: Fresnel,
    /// Factor on transmitted light.
    pub tint: Spectrum,
}

/// A delta direction: probability with which the lobe draws it, f |cos θi| without that probability, and η crossed.
#[derive(Clone, Copy, Debug)]
pub struct Delta {
    /// The direction.
    pub wi: Vec3,
    /// Share of the energy that goes there; of radiance, in radiance transport.
    pub weight: Spectrum,
    /// Probability of this direction among those of the lobe.
    pub probability: f32,
    /// η of the side of `wi` over η of the side of `wo`.
    pub eta: f32,
}

/// Relative index η_t/η_i for light that arrives along −`wo`.
#[inline]
pub(super) fn relative_eta(eta: f32, wo: Vec3) -> f32 {
    if wo.z > 0.0 { eta } else { 1.0 / eta }
}

/// What refraction does to the quantity carried: radiance is scaled by (η_o/η_i)², importance not (Veach 1997, 5.2).
#[inline]
pub(super) fn refraction_scale(eta: f32, mode: Transport) -> f32 {
    match mode {
        Transport::Radiance => 1.0 / (eta * eta),
        Transport::Importance => 1.0,
    }
}

impl Mirror {
    /// The mirror direction.
    #[inline]
    pub(super) fn deltas(&self, wo: Vec3) -> [Option<Delta>; 2] {
        let weight = self.fresnel.eval(wo.z.abs().min(1.0));
        [Some(Delta { wi: Vec3::new(-wo.x, -wo.y, wo.z), weight, probability: 1.0, eta: 1.0 }), None]
    }
}

impl SmoothDielectric {
    /// The mirrored and, below the critical angle, the refracted direction (Snell), with the shares F and 1 − F.
    #[inline]
    pub(super) fn deltas(&self, wo: Vec3, mode: Transport) -> [Option<Delta>; 2] {
        let eta = relative_eta(self.eta, wo);
        let cos = wo.z.abs().min(1.0);
        let (f, cos_t) = dielectric(cos, eta);
        let reflected =
            Delta { wi: Vec3::new(-wo.x, -wo.y, wo.z), weight: Spectrum::splat(f), probability: f, eta: 1.0 };
        let wi = refract(wo, Vec3::new(0.0, 0.0, 1f32.copysign(wo.z)), cos, cos_t, eta);
        let refracted =
            Delta { wi, weight: self.tint * ((1.0 - f) * refraction_scale(eta, mode)), probability: 1.0 - f, eta };
        [Some(reflected).filter(|_| f > 0.0), Some(refracted).filter(|d| f < 1.0 && d.wi.z * wo.z < 0.0)]
    }

    /// Directional albedo F + (1 − F) tint.
    #[inline]
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        let (f, _) = dielectric(wo.z.abs().min(1.0), relative_eta(self.eta, wo));
        Spectrum::splat(f) + self.tint * (1.0 - f)
    }
}

impl ThinTransmission {
    /// Straight through.
    #[inline]
    pub(super) fn deltas(&self, wo: Vec3) -> [Option<Delta>; 2] {
        [Some(Delta { wi: -wo, weight: self.albedo(wo), probability: 1.0, eta: 1.0 }), None]
    }

    /// tint (1 − F).
    #[inline]
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        self.tint * (Spectrum::ONE - self.fresnel.eval(wo.z.abs().min(1.0)))
    }
}
