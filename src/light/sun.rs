//! A bright disk at infinity.

use super::LightSample;
use crate::bsdf::Pdf;
use crate::math::{Frame, sqr};
use crate::spectrum::Spectrum;
use crate::warp::{one_minus_cos_of_sin2, uniform_cone, uniform_cone_pdf};
use glam::{Vec3, Vec3A};
use std::f32::consts::PI;

/// Light of constant radiance from the directions of a narrow cone: E⊥ = L π sin²α with its half-angle α, exactly as of
/// parallel light along its axis wherever all of the cone is above the horizon.
#[derive(Clone, Copy, Debug)]
pub struct SunLight {
    frame: Frame,
    irradiance: Spectrum,
    radiance: Spectrum,
    /// 1 − cos α.
    one_minus_cos: f32,
}

impl SunLight {
    /// Shines along the unit vector `direction`, with linear RGB irradiance on what faces it \[W/m²\], from a disk of this
    /// angular diameter \[rad\], between 0 and π.
    pub fn new(direction: Vec3, irradiance: [f32; 3], diameter: f32) -> Self {
        let sin2 = sqr((0.5 * diameter).sin());
        let irradiance = Spectrum::from_rgb(irradiance);
        Self {
            frame: Frame::from_z(-direction),
            irradiance,
            radiance: irradiance / (PI * sin2),
            one_minus_cos: one_minus_cos_of_sin2(sin2),
        }
    }

    /// Draws a direction of the disk.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> Option<LightSample> {
        let wi = self.frame.to_world(uniform_cone(u, self.one_minus_cos)).normalize();
        let pdf = Pdf::SolidAngle(uniform_cone_pdf(self.one_minus_cos));
        (!self.radiance.is_black()).then_some(LightSample::from_infinity(wi, self.radiance, pdf))
    }

    /// Lₑ that arrives from the unit vector `wi`.
    #[inline]
    pub fn le(&self, wi: Vec3A) -> Spectrum {
        if self.covers(wi) { self.radiance } else { Spectrum::ZERO }
    }

    /// Density over solid angle with which [`sample`](Self::sample) draws `wi`.
    #[inline]
    pub fn pdf(&self, wi: Vec3A) -> f32 {
        if self.covers(wi) { uniform_cone_pdf(self.one_minus_cos) } else { 0.0 }
    }

    /// |ω − axis|² = 2(1 − cos θ), which keeps its precision near the axis.
    #[inline]
    fn covers(&self, wi: Vec3A) -> bool {
        wi.distance_squared(self.frame.n) <= 2.0 * self.one_minus_cos
    }

    /// Φ = E π R² through the disk that a scene of radius R shows to it.
    pub fn power(&self, scene_radius: f32) -> Spectrum {
        self.irradiance * (PI * sqr(scene_radius))
    }
}
