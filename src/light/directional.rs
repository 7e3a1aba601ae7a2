//! Parallel light.

use super::LightSample;
use crate::bsdf::Pdf;
use crate::math::sqr;
use crate::spectrum::Spectrum;
use glam::{Vec3, Vec3A};
use std::f32::consts::PI;

/// Light that travels along one direction everywhere.
#[derive(Clone, Copy, Debug)]
pub struct DirectionalLight {
    direction: Vec3A,
    irradiance: Spectrum,
}

impl DirectionalLight {
    /// Travels along the unit vector `direction` with linear RGB irradiance on what faces it \[W/m²\].
    pub fn new(direction: Vec3, irradiance: [f32; 3]) -> Self {
        Self { direction: direction.into(), irradiance: Spectrum::from_rgb(irradiance) }
    }

    /// E⊥, from the one direction there is.
    #[inline]
    pub fn sample(&self) -> Option<LightSample> {
        let (wi, le) = (-self.direction, self.irradiance);
        (!le.is_black()).then_some(LightSample::from_infinity(wi, le, Pdf::Discrete(1.0)))
    }

    /// Φ = E π R² through the disk that a scene of radius R shows to it.
    pub fn power(&self, scene_radius: f32) -> Spectrum {
        self.irradiance * (PI * sqr(scene_radius))
    }
}
