//! Spot light.

use super::LightSample;
use super::point::sample_position;
use super::tree::LightBounds;
use crate::math::sqr;
use crate::spectrum::Spectrum;
use glam::{Vec3, Vec3A};
use std::f32::consts::TAU;

/// A point light confined to a cone, with the fall-off of KHR_lights_punctual.
#[derive(Clone, Copy, Debug)]
pub struct SpotLight {
    position: Vec3A,
    direction: Vec3A,
    intensity: Spectrum,
    cos_inner: f32,
    cos_outer: f32,
    range: f32,
}

impl SpotLight {
    /// At `position` about the unit vector `direction`, with linear RGB intensity on the axis \[W/sr\] and half-angles
    /// \[rad\]; it ends at the distance `range`, which may be infinite.
    pub fn new(position: Vec3, direction: Vec3, intensity: [f32; 3], [inner, outer]: [f32; 2], range: f32) -> Self {
        Self {
            position: position.into(),
            direction: direction.into(),
            intensity: Spectrum::from_rgb(intensity),
            cos_inner: inner.cos(),
            cos_outer: outer.cos(),
            range,
        }
    }

    /// E⊥ = I f(θ)/r².
    #[inline]
    pub fn sample(&self, p: Vec3A) -> Option<LightSample> {
        sample_position(self.position, p, self.range, |w| self.intensity * self.falloff(w.dot(self.direction)))
    }

    /// f = clamp((cos θ − cos outer)/(cos inner − cos outer), 0, 1)²; a step where the cones coincide.
    #[inline]
    fn falloff(&self, cos: f32) -> f32 {
        if cos >= self.cos_inner {
            1.0
        } else if cos <= self.cos_outer {
            0.0
        } else {
            sqr((cos - self.cos_outer) / (self.cos_inner - self.cos_outer))
        }
    }

    /// Φ = 2π I ((1 − cos inner) + (cos inner − cos outer)/3), the integral of the fall-off over the sphere.
    pub fn power(&self) -> Spectrum {
        self.intensity * (TAU * ((1.0 - self.cos_inner) + (self.cos_inner - self.cos_outer).max(0.0) / 3.0))
    }

    /// A point, and the cones.
    pub(super) fn bounds(&self) -> LightBounds {
        let (inner, outer) = (f64::from(self.cos_inner).acos(), f64::from(self.cos_outer).acos());
        LightBounds {
            min: self.position.into(),
            max: self.position.into(),
            axis: self.direction.as_dvec3(),
            spread: inner,
            fade: (outer - inner).max(0.0),
            intensity: f64::from(self.intensity.luminance()).clamp(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)),
            both: false,
        }
    }
}
