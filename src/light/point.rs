//! Isotropic point light.

use super::LightSample;
use super::tree::LightBounds;
use crate::bsdf::Pdf;
use crate::math::sqr;
use crate::spectrum::Spectrum;
use glam::{Vec3, Vec3A};
use std::f32::consts::PI;

/// Radiates the same intensity in all directions.
#[derive(Clone, Copy, Debug)]
pub struct PointLight {
    position: Vec3A,
    intensity: Spectrum,
    range: f32,
}

impl PointLight {
    /// At `position` with linear RGB intensity \[W/sr\]; it ends at the distance `range`, which may be infinite.
    pub fn new(position: Vec3, intensity: [f32; 3], range: f32) -> Self {
        Self { position: position.into(), intensity: Spectrum::from_rgb(intensity), range }
    }

    /// E⊥ = I/r², from the one direction there is.
    #[inline]
    pub fn sample(&self, p: Vec3A) -> Option<LightSample> {
        sample_position(self.position, p, self.range, |_| self.intensity)
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

/// Light at `p` from a point source of the given intensity towards a direction (from the source, unit). A finite `range`
/// ends it: E⊥ = (I/r²) clamp(1 − (r/range)⁴, 0, 1), which KHR_lights_punctual recommends for the end that it requires.
#[inline]
pub(super) fn sample_position(
    position: Vec3A,
    p: Vec3A,
    range: f32,
    intensity: impl FnOnce(Vec3A) -> Spectrum,
) -> Option<LightSample> {
    let to = position - p;
    let distance2 = to.length_squared();
    let distance = distance2.sqrt();
    let wi = to / distance;
    if !(distance2 > 0.0 && distance2.is_finite()) {
        return None;
    }
    let le = intensity(-wi) * ((1.0 - sqr(sqr(distance / range))).max(0.0) / distance2);
    let pdf = Pdf::Discrete(1.0);
    (!le.is_black()).then_some(LightSample { wi, distance, p: position, margin: 0.0, le, pdf })
}
