//! How the directions of the hemisphere are drawn.

use super::{Method, Numbers};
use crate::bsdf::Pdf;
use crate::desc::Strategy;
use crate::light::LightSampleContext;
use crate::math::{Frame, renormalize};
use crate::scene::{DirectionSample, Shading};
use glam::Vec3;
use std::f32::consts::{PI, TAU};

/// How a ray was drawn: all that the next vertex must know of the last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SampledBy {
    /// From the camera.
    Camera,
    /// From a delta lobe: no other sampler finds this direction.
    Delta,
    /// From a density over solid angle.
    Smooth {
        /// \[1/sr\]
        pdf: f32,
        /// The surface: where the light sampler would have stood (the ray's origin is off the surface).
        from: LightSampleContext,
    },
}

impl SampledBy {
    /// With the density of a draw at the vertex of `shading`.
    #[inline]
    pub fn new(pdf: Pdf, shading: &Shading) -> Self {
        match pdf {
            Pdf::SolidAngle(pdf) => Self::Smooth { pdf, from: shading.receiver() },
            Pdf::Discrete(_) => Self::Delta,
        }
    }
}

/// A direction for the recursion, drawn as the method's strategy says.
#[inline(always)]
pub fn sample(method: &Method, shading: &Shading, u: &Numbers) -> Option<DirectionSample> {
    match method.strategy {
        Strategy::Bsdf | Strategy::Light | Strategy::Mis => shading.sample(u.lobe_choice, u.lobe),
        Strategy::Uniform => blind(shading, u, uniform_hemisphere),
        Strategy::Cosine => blind(shading, u, cosine_hemisphere),
    }
}

/// Draws a direction without looking at the BSDF: delta lobes keep their own draws, the rest takes `hemisphere`
/// above the surface, or on either side with equal probability where the BSDF transmits.
#[inline(never)]
fn blind(shading: &Shading, u: &Numbers, hemisphere: impl Fn([f32; 2]) -> (Vec3, f32)) -> Option<DirectionSample> {
    let (bsdf, choice) = (shading.bsdf, u.lobe_choice);
    let delta = bsdf.delta_probability();
    if choice < delta {
        return shading.sample_delta(choice / delta);
    }
    if !bsdf.has_smooth() {
        return None;
    }
    let side = (choice - delta) / (1.0 - delta);
    let (mut wi, mut pdf) = hemisphere(u.lobe);
    pdf *= 1.0 - delta;
    if bsdf.transmits() {
        pdf *= 0.5;
    }
    if shading.vertex.front == (bsdf.transmits() && side < 0.5) {
        wi.z = -wi.z;
    }
    if pdf == 0.0 {
        return None;
    }
    let frame = if shading.is_bent() { Frame::from_z(shading.vertex.surface.ng) } else { shading.frame };
    let wi = renormalize(frame.to_world(wi));
    let eval = shading.eval(wi);
    let k = 1.0 / pdf;
    // Russian roulette keeps η² out of its decision where the ray is bent; a blind draw need not know η.
    let (weight, specular, pdf) = (eval.f_cos * k, eval.specular * k, Pdf::SolidAngle(pdf));
    Some(DirectionSample { wi, weight, specular, pdf, eta: 1.0, straight: false })
}

fn uniform_hemisphere(u: [f32; 2]) -> (Vec3, f32) {
    let z = u[0];
    let r = crate::math::safe_sqrt(1.0 - z * z);
    let (sin, cos) = (TAU * u[1]).sin_cos();
    (Vec3::new(r * cos, r * sin, z), 1.0 / TAU)
}

fn cosine_hemisphere(u: [f32; 2]) -> (Vec3, f32) {
    let r = u[0].sqrt();
    let (sin, cos) = (TAU * u[1]).sin_cos();
    let z = crate::math::safe_sqrt(1.0 - u[0]);
    (Vec3::new(r * cos, r * sin, z), z / PI)
}
