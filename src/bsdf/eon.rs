//! Rough diffuse reflection that keeps its energy.

use crate::math::safe_sqrt;
use crate::spectrum::Spectrum;
use glam::Vec3;
use std::f32::consts::{FRAC_1_PI, PI};

/// Matte, rough: plaster, clay, the moon.
///
/// Oren and Nayar's (1994) grooves in Fujii's form, and what a single reflection loses of them, after Portsmouth, Kutz &
/// Hill (2024, "EON: a practical energy-preserving rough diffuse BRDF"):
///
/// ```text
/// f = ρ/π A (1 + r s/t) + ρ_ms/π (1 − E(o)) (1 − E(i)) / (1 − E_avg)
/// s = o·i − cos o cos i,    t = max(cos o, cos i) if s > 0, else 1
/// A = 1/(1 + (1/2 − 2/(3π)) r),    E = A (1 + r G/π),    E_avg = A (1 + (2/3 − 28/(15π)) r)
/// ρ_ms = ρ² E_avg / (1 − ρ (1 − E_avg))
/// ```
///
/// E is the albedo of the first term at ρ = 1 and E_avg its mean, so that white reflects all, exactly. Two-sided.
#[derive(Clone, Copy, Debug)]
pub struct Eon {
    reflectance: Spectrum,
    roughness: f32,
    /// A.
    scale: f32,
    multiple: Spectrum,
}

impl Eon {
    /// Of albedo parameter ρ = `reflectance` in [0, 1]; `roughness` r in [0, 1], where 0 is Lambert's lobe.
    pub fn new(reflectance: Spectrum, roughness: f32) -> Self {
        let scale = 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * roughness);
        let kept = Self { reflectance, roughness, scale, multiple: Spectrum::ZERO };
        let average = kept.average();
        let series = (reflectance * reflectance * average).div_or_zero(Spectrum::ONE - reflectance * (1.0 - average));
        Self { multiple: series, ..kept }
    }

    /// E_avg.
    #[inline]
    fn average(&self) -> f32 {
        self.scale * (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * PI)) * self.roughness)
    }

    /// E towards the cosine `mu`, with
    /// G = sin θ (θ − sin θ cos θ) + ⅔ (tan θ (1 − sin³θ) − sin θ).
    #[inline]
    fn single(&self, mu: f32) -> f32 {
        let sin = safe_sqrt((1.0 - mu) * (1.0 + mu));
        // tan θ (1 − sin³θ), without the quotient that fails at the horizon: 1 − sin θ = cos²θ/(1 + sin θ).
        let steep = sin * mu * (1.0 + sin + sin * sin) / (1.0 + sin);
        let g = sin * (sin.atan2(mu) - sin * mu) + 2.0 / 3.0 * (steep - sin);
        self.scale * (1.0 + self.roughness * FRAC_1_PI * g)
    }

    /// f \[1/sr\] for directions on the same side.
    #[inline]
    pub(super) fn f(&self, wo: Vec3, wi: Vec3) -> Spectrum {
        let (o, i) = (wo.z.abs().min(1.0), wi.z.abs().min(1.0));
        let s = wo.x * wi.x + wo.y * wi.y;
        let groove = if s > 0.0 { s / o.max(i) } else { s };
        let single = self.reflectance * (self.scale * (1.0 + self.roughness * groove));
        let lost = (1.0 - self.single(o)).max(0.0) * (1.0 - self.single(i)).max(0.0);
        let average = 1.0 - self.average();
        let multiple = if average > 0.0 { lost / average } else { 0.0 };
        (single + self.multiple * multiple) * FRAC_1_PI
    }

    /// Directional albedo ρ E + ρ_ms (1 − E).
    #[inline]
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        let e = self.single(wo.z.abs().min(1.0));
        self.reflectance * e + self.multiple * (1.0 - e)
    }
}
