//! Phong's lobe.

use super::ggx::reflect;
use crate::math::safe_sqrt;
use crate::spectrum::Spectrum;
use glam::Vec3;
use std::f32::consts::{PI, TAU};

/// A lobe about the mirror direction r of `wo` that is the same from everywhere,
///
/// ```text
/// f = ρ (n + 2)/(2π) cosⁿα,    cos α = max(0, r·wi)
/// ```
///
/// (Phong 1975, normalised by Lafortune & Willems 1994). r·wi is symmetric, so f is reciprocal; at normal incidence ρ is
/// the albedo, and at other angles less is left above the horizon. Two-sided.
#[derive(Clone, Copy, Debug)]
pub struct Phong {
    /// Albedo at normal incidence, ρ in [0, 1].
    pub reflectance: Spectrum,
    /// n ≥ 0.
    pub exponent: f32,
}

impl Phong {
    /// f \[1/sr\] and density \[1/sr\] of `wi`, (n + 1)/(2π) cosⁿα, which is that of `wo` seen from `wi`; nothing across the
    /// surface.
    #[inline]
    pub(super) fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32, f32) {
        if wo.z * wi.z <= 0.0 {
            return (Spectrum::ZERO, 0.0, 0.0);
        }
        // cos α = 1 − |wi − r|²/2, for narrow lobes need more digits than the cosine has.
        let off = 0.5 * (wi - reflect(wo, Vec3::Z)).length_squared();
        if off >= 1.0 {
            return (Spectrum::ZERO, 0.0, 0.0);
        }
        let lobe = (self.exponent * (-off).ln_1p()).exp() / TAU;
        let pdf = (self.exponent + 1.0) * lobe;
        (self.reflectance * ((self.exponent + 2.0) * lobe), pdf, pdf)
    }

    /// Draws `wi` by cos α = u^(1/(n + 1)); nothing where that is below the horizon.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, u: [f32; 2]) -> Option<Vec3> {
        // 1 − cos α from the logarithm, likewise.
        let off = -((1.0 - u[0]).ln() / (self.exponent + 1.0)).exp_m1();
        let sin = safe_sqrt(off * (2.0 - off));
        let (sin_phi, cos_phi) = (TAU * u[1]).sin_cos();
        let r = reflect(wo, Vec3::Z);
        let (x, y) = r.any_orthonormal_pair();
        let wi = (x * (sin * cos_phi) + y * (sin * sin_phi) + r * (1.0 - off)).normalize();
        (wi.z * wo.z > 0.0).then_some(wi)
    }

    /// Directional albedo. In rings of angle α about r the cosine is a + b cos φ, a = cos α cos θ, b = sin α sin θ, and
    ///
    /// ```text
    /// ∫ max(0, a + b cos φ) dφ = 2 (a φ₀ + b sin φ₀),    φ₀ = arccos(−a/b) in [0, π]
    /// ```
    ///
    /// which leaves one integral: over x of cos α = e^(−x²/(n + 1)), in which it is a smooth function times e^(−x²).
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        let (cos, sin) = (wo.z.abs().min(1.0), wo.truncate().length().min(1.0));
        let ring = |c: f32| {
            let (a, b) = (c * cos, safe_sqrt((1.0 - c) * (1.0 + c)) * sin);
            if a >= b {
                return PI * a;
            }
            let phi = (-a / b).acos();
            a * phi + b * phi.sin()
        };
        // Rings are cut from b = a on, where cos α = sin θ; beyond `END` nothing is left.
        const END: f32 = 4.2;
        let bend = (-(self.exponent + 1.0) * sin.ln()).max(0.0).sqrt().min(END);
        const N: u32 = 32;
        let mut sum = 0.0;
        for (from, to) in [(0.0, bend), (bend, END)] {
            for i in 0..N {
                let t = (i as f32 + 0.5) / N as f32;
                // t³(10 − 15t + 6t²) flattens both ends of a piece, where the ring has a root: an error of 10⁻⁶.
                let x = from + (to - from) * t.powi(3) * (10.0 - t * (15.0 - 6.0 * t));
                let dx = (to - from) * 30.0 * (t * (1.0 - t)).powi(2) / N as f32;
                sum += 2.0 * x * (-x * x).exp() * ring((-x * x / (self.exponent + 1.0)).exp()) * dx;
            }
        }
        self.reflectance * (sum * (self.exponent + 2.0) / ((self.exponent + 1.0) * PI))
    }
}
