//! L1: lights without extent.
//!
//! E = I cosθ/r² of a point; with an end at distance R the same times clamp(1 − (r/R)⁴, 0, 1); of a spot the same times the fall-off of KHR_lights_punctual,
//! clamp((cos γ − cos outer)/(cos inner − cos outer), 0, 1)² at the angle γ from its axis; E⊥ cosθ of parallel light. Nothing is
//! random: agreement to rounding.

use super::{random_direction, rng};
use crate::desc;
use crate::desc::ies::{Photometry, Profile};
use crate::light::Light;
use crate::texture::Textures;
use crate::verify::measure::to_detect;
use crate::verify::{Findings, Task, Topic, Trial};
use crate::warp::uniform_sphere;
use glam::{Mat3, Vec3};
use std::f64::consts::PI;

pub(super) const L1: Topic = Topic {
    id: "L1",
    title: "point light: E = I cosθ/r²",
    source: "inverse square law; fall-off of spots: glTF KHR_lights_punctual",
};

pub(super) fn tasks() -> Vec<Task> {
    vec![
        Task::new(L1, "point, spot and directional light by light sampling", poses),
        Task::new(L1, "flux of spot lights", flux_of_spots),
        Task::new(L1, "flux of measured profiles", flux_of_profiles),
    ]
}

/// Poses at scales from a millimetre to a kilometre. Deviations are relative to the irradiance on a surface that faces
/// the light.
fn poses(trial: &Trial, found: &mut Findings) {
    let mut rng = rng(trial.seed);
    let mut worst = [0f64; 4];
    for i in 0..trial.work(700, 10_000) {
        let scale = 10f32.powi(i % 7 - 3);
        let (position, p) = (random_direction(&mut rng) * scale, random_direction(&mut rng) * (0.7 * scale));
        let (n, direction) = (random_direction(&mut rng), random_direction(&mut rng));
        let to = position.as_dvec3() - p.as_dvec3();
        let cos = to.normalize().dot(n.as_dvec3()).max(0.0);
        let (intensity, inner, outer) = ([2.0; 3], 0.5, 2.5);
        let along = -to.normalize().dot(direction.as_dvec3());
        let (cos_inner, cos_outer) = (f64::from(inner).cos(), f64::from(outer).cos());
        let falloff = ((along - cos_outer) / (cos_inner - cos_outer)).clamp(0.0, 1.0).powi(2);
        let facing = 2.0 / to.length_squared();
        // Within the range and beyond it.
        let range = (0.5 + 0.3 * (i % 5) as f32) * to.length() as f32;
        let window = (1.0 - (to.length() / f64::from(range)).powi(4)).max(0.0);
        let lights = [
            (desc::Light::Point { position, intensity, range: f32::INFINITY }, facing, facing * cos),
            (
                desc::Light::Spot { position, direction, intensity, inner, outer, range: f32::INFINITY },
                facing,
                facing * cos * falloff,
            ),
            (desc::Light::Point { position, intensity, range }, facing, facing * cos * window),
            (
                desc::Light::Directional { direction, irradiance: intensity },
                2.0,
                2.0 * f64::from(-n.dot(direction)).max(0.0),
            ),
        ];
        for (worst, (light, facing, exact)) in worst.iter_mut().zip(lights) {
            let sample = Light::from_desc(&light).sample(p.into(), [0.5; 2], &Textures::default());
            let e = sample.map_or(0.0, |s| f64::from(s.le.0.x) * f64::from(n.dot(s.wi.into()).max(0.0)));
            *worst = worst.max((e - exact).abs() / facing);
        }
    }
    // The distance is that of rounded coordinates: some ulp of the greater of them, which the nearest pose is a fifth of.
    for (name, worst) in ["point", "spot", "point with an end", "directional"].into_iter().zip(worst) {
        found.checks.bound(name, worst, 2e-5);
    }
}

/// Φ = ∫ I dω: what [`Light::power`] says against E r² in uniform directions, for every symmetry and type.
fn flux_of_profiles(trial: &Trial, found: &mut Findings) {
    for (kind, vertical, horizontal) in [
        (Photometry::C, [0.0, 40.0, 90.0], &[0.0][..]),
        (Photometry::C, [0.0, 90.0, 180.0], &[0.0, 30.0, 90.0]),
        (Photometry::C, [90.0, 120.0, 180.0], &[0.0, 180.0]),
        (Photometry::C, [0.0, 60.0, 120.0], &[0.0, 120.0, 240.0, 360.0]),
        (Photometry::C, [0.0, 60.0, 90.0], &[90.0, 180.0, 270.0]),
        (Photometry::A, [-20.0, 0.0, 50.0], &[0.0, 90.0]),
        (Photometry::B, [-90.0, 0.0, 90.0], &[-45.0, 0.0, 90.0]),
    ] {
        let candela = (0..3 * horizontal.len()).map(|i| 1.0 + (i * 5 % 7) as f32).collect();
        let profile =
            Profile { kind, vertical: vertical.to_vec(), horizontal: horizontal.to_vec(), candela, tilt: None };
        let to_world = Mat3::from_rotation_x(0.7);
        let light =
            desc::Light::Profile { position: Vec3::ZERO, to_world, intensity: [0.5; 3], profile: profile.into() };
        let light = Light::from_desc(&light);
        let power = f64::from(light.power(2.0).0.x);
        let flux = to_detect(trial, power, 3e-3, 1 << 15, |u| {
            let sample = light.sample(uniform_sphere(u).into(), [0.5; 2], &Textures::default());
            4.0 * PI * sample.map_or(0.0, |s| f64::from(s.le.0.x))
        });
        found.checks.replicated(format!("{kind:?}, {horizontal:?}"), power, &flux, 1e-3);
    }
}

/// Φ = 2π I ((1 − cos inner) + (cos inner − cos outer)/3): what [`Light::power`] says against ∫ E r² dω, with θ
/// stratified.
fn flux_of_spots(trial: &Trial, found: &mut Findings) {
    for (inner, outer) in [(0.0, 1.0), (0.5, 0.9), (0.7, 0.7), (1.5, 3.1)] {
        let written = desc::Light::Spot {
            position: Vec3::ZERO,
            direction: Vec3::Y,
            intensity: [2.0; 3],
            inner,
            outer,
            range: f32::INFINITY,
        };
        let spot = Light::from_desc(&written);
        let power = f64::from(spot.power(2.0).0.x);
        let flux = to_detect(trial, power, 3e-3, 1 << 15, |u| {
            let sample = spot.sample(uniform_sphere(u).into(), [0.5; 2], &Textures::default());
            4.0 * PI * sample.map_or(0.0, |s| f64::from(s.le.0.x))
        });
        found.checks.replicated(format!("{inner} to {outer}"), power, &flux, 1e-6);
    }
}
