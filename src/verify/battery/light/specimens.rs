//! L1–L6 for every specimen: what the light's own samples say of the irradiance, and what directions say that meet the
//! light. No closed form is needed, so a new light is checked as soon as it is a specimen.

use super::environment::{L5, L6};
use super::irradiance::Lit;
use super::polygon::L2;
use super::punctual::L1;
use super::quadric::{L3, L4};
use crate::light::{Light, specimens};
use crate::shape::Quadric;
use crate::texture::Textures;
use crate::verify::{Task, Topic};
use glam::Vec3A;

/// The row that a light belongs to.
fn topic(light: &Light) -> Topic {
    match light {
        Light::Point(_) | Light::Spot(_) | Light::Profile(_) | Light::Directional(_) | Light::Sun(_) => L1,
        Light::Triangle(_) => L2,
        Light::Quadric(light) => match light.shape.quadric {
            Quadric::Sphere { .. } => L4,
            Quadric::Disk { .. } | Quadric::Cylinder { .. } => L3,
        },
        Light::Environment(light) if light.is_uniform() => L5,
        Light::Environment(_) => L6,
    }
}

pub(super) fn tasks() -> Vec<Task> {
    let mut tasks = Vec::new();
    for specimen in specimens().into_iter().filter(|s| !s.light.is_delta()) {
        for &(place, p) in &specimen.points {
            let light = specimen.light.clone();
            let name = format!("specimen {}, {place}: light sampling = meeting it", specimen.name);
            tasks.push(Task::new(topic(&light), name, move |trial, found| {
                let textures = Textures::default();
                // The receiver is turned half away from where the light is.
                let samples = (0..64u32).map(|i| [(i % 8) as f32, (i / 8) as f32].map(|x| (x + 0.5) / 8.0));
                let p = Vec3A::from(p);
                let towards: Vec3A = samples.filter_map(|u| light.sample(p, u, &textures)).map(|s| s.wi).sum();
                let Some(towards) = towards.try_normalize() else {
                    // Nothing is emitted to where this point is.
                    let seen = light.sample(p, [0.3, 0.6], &textures).is_some();
                    return found.checks.holds("nothing arrives", !seen);
                };
                let n = (towards + 0.5 * towards.any_orthonormal_vector()).normalize();
                Lit { light: &light, p: p.into(), n: n.into(), textures: &textures }.agree(trial, found, "E");
            }));
        }
    }
    tasks
}
