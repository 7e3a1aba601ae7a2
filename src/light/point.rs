//! Isotropic point light.

use super::LightSample;
use super::tree::LightBounds;
use crate::bsdf::Pdf;
use crate::spectrum::Spectrum;
use glam::Vec3;
use std::f32::consts::PI;

/// Radiates the same intensity in all directions.
#[derive(Clone, Copy, Debug)]
pub struct PointLight {
    position: Vec3,
    intensity: Spectrum,
}

impl PointLight {
    /// At `position` with linear RGB intensity \[W/sr\].
    pub fn new(position: Vec3, intensity: [f32; 3]) -> Self {
        Self { position, intensity: Spectrum::from_rgb(intensity) }
    }

    /// E⊥ = I/r², from the one direction there is.
    #[inline]
    pub fn sample(&self, p: Vec3) -> Option<LightSample> {
        sample_position(self.position, p, |_| self.intensity)
    }

    /// Φ = 4π I.
    pub fn power(&self) -> Spectrum {
        self.intensity * (4.0 * PI)
    }

    /// A point.
    pub(super) fn bounds(&self, flux: f64) -> LightBounds {
        LightBounds::round(self.position, self.position, flux / (4.0 * f64::from(PI)))
    }
}

/// Light at `p` from a point source of the given intensity towards a direction (from the source, unit).
#[inline]
pub(super) fn sample_position(
    position: Vec3,
    p: Vec3,
    intensity: impl FnOnce(Vec3) -> Spectrum,
) -> Option<LightSample> {
    let to = position - p;
    let distance2 = to.length_squared();
    let distance = distance2.sqrt();
    let wi = to / distance;
    if !(distance2 > 0.0 && distance2.is_finite()) {
        return None;
    }
    let le = intensity(-wi) / distance2;
    (!le.is_black()).then_some(LightSample { wi, distance, le, pdf: Pdf::Discrete(1.0) })
}
