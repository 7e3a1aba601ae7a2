//! Lights: irradiance against closed forms, densities against samples, the choice among many.

mod choice;
mod density;
mod environment;
mod irradiance;
mod polygon;
mod punctual;
mod quadric;
mod specimens;
mod tree;

use crate::desc::{self, ColorParam, Emission, Sides};
use crate::light::{Emitter, Environment, Light, QuadricLight, TriangleLight};
use crate::math::{Transform, safe_sqrt};
use crate::shape::{PlacedQuadric, Quadric, TriangleAttributes};
use crate::verify::Task;
use glam::{Mat3, Mat4, Vec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// All of them.
pub(super) fn tasks() -> Vec<Task> {
    [
        punctual::tasks(),
        polygon::tasks(),
        quadric::tasks(),
        environment::tasks(),
        specimens::tasks(),
        density::tasks(),
        choice::tasks(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Uniform grey emission of radiance 1.
fn emitter(sides: Sides) -> Emitter {
    Emitter::new(&Emission { radiance: ColorParam::constant([1.0; 3]), sides, coat: None })
}

/// An emissive triangle of radiance 1, where the corners span one.
fn triangle_light(p: [Vec3; 3], sides: Sides) -> Option<Light> {
    TriangleLight::new(p, &TriangleAttributes::default(), false, emitter(sides)).map(Light::Triangle)
}

/// An emissive quadric of radiance 1, where the map is invertible.
fn quadric_light(quadric: Quadric, to_world: Mat4, sides: Sides) -> Option<Light> {
    let transform = Transform::from_mat4(to_world)?;
    let light = QuadricLight::new(PlacedQuadric::new(quadric, transform, false), emitter(sides));
    Some(Light::Quadric(Box::new(light)))
}

/// An environment, grey or a picture.
fn environment_light(radiance: f32, image: Option<desc::Image>, to_world: Mat3) -> Light {
    let written = desc::Environment { radiance: [radiance; 3], image: image.as_ref().map(|_| 0), to_world };
    Light::Environment(Box::new(Environment::new(&written, image.as_ref())))
}

/// Numbers of a task.
fn rng(seed: u64) -> Pcg64Mcg {
    Pcg64Mcg::seed_from_u64(seed)
}

/// A uniform direction for a pose.
fn random_direction(rng: &mut Pcg64Mcg) -> Vec3 {
    let z = 1.0 - 2.0 * rng.random::<f32>();
    let (sin, cos) = (std::f32::consts::TAU * rng.random::<f32>()).sin_cos();
    let rho = safe_sqrt(1.0 - z * z);
    Vec3::new(rho * cos, rho * sin, z)
}
