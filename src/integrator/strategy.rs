//! How the directions of the hemisphere are drawn.

use super::Method;
use crate::bsdf::{Bsdf, Pdf, Sample, Transport};
use crate::desc::Strategy;
use crate::light::Receiver;
use glam::Vec3;
use std::f32::consts::{PI, TAU};

/// How a ray was drawn: all that the next vertex must know of the last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drawn {
    /// From the camera.
    Camera,
    /// From a delta lobe: no other sampler finds this direction.
    Delta,
    /// From a density over solid angle.
    Smooth {
        /// \[1/sr\]
        pdf: f32,
        /// The surface: where the light sampler would have stood (the ray's origin is off the surface).
        from: Receiver,
    },
}

impl Drawn {
    /// From the density of a draw at the surface `from`.
    #[inline]
    pub fn new(pdf: Pdf, from: Receiver) -> Self {
        match pdf {
            Pdf::SolidAngle(pdf) => Self::Smooth { pdf, from },
            Pdf::Discrete(_) => Self::Delta,
        }
    }
}

/// A direction for the recursion, drawn as the method's strategy says; `wo` local.
#[inline(always)]
pub fn sample(method: &Method, bsdf: &Bsdf, wo: Vec3, choice: f32, u: [f32; 2]) -> Option<Sample> {
    match method.strategy {
        Strategy::Bsdf | Strategy::Light | Strategy::Mis => bsdf.sample(wo, choice, u, Transport::Radiance),
        Strategy::Uniform => blind(bsdf, wo, choice, u, uniform_hemisphere),
        Strategy::Cosine => blind(bsdf, wo, choice, u, cosine_hemisphere),
    }
}

/// Draws a direction without looking at the BSDF: delta lobes keep their own draws, the rest takes `hemisphere`
/// above the surface, or on either side with equal probability where the BSDF transmits.
#[inline(never)]
fn blind(
    bsdf: &Bsdf,
    wo: Vec3,
    choice: f32,
    u: [f32; 2],
    hemisphere: impl Fn([f32; 2]) -> (Vec3, f32),
) -> Option<Sample> {
    let delta = bsdf.delta_probability();
    if choice < delta {
        return bsdf.sample_delta(wo, choice / delta, Transport::Radiance);
    }
    if !bsdf.has_smooth() {
        return None;
    }
    let side = (choice - delta) / (1.0 - delta);
    let (mut wi, mut pdf) = hemisphere(u);
    pdf *= 1.0 - delta;
    if bsdf.transmits() {
        pdf *= 0.5;
    }
    if (wo.z < 0.0) != (bsdf.transmits() && side < 0.5) {
        wi.z = -wi.z;
    }
    if pdf == 0.0 {
        return None;
    }
    let eval = bsdf.eval(wo, wi, Transport::Radiance);
    let k = wi.z.abs() / pdf;
    // Russian roulette keeps η² out of its decision where the ray is bent; a blind draw need not know η.
    Some(Sample { wi, weight: eval.f * k, specular: eval.specular * k, pdf: Pdf::SolidAngle(pdf), eta: 1.0 })
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
