//! D5 for the light tree: what it chooses at many receivers against the probabilities that it states, bounds that lose
//! nothing, and the same irradiance as by the choice by power.

use super::{environment_light, quadric_light, random_direction, rng, triangle_light};
use crate::bsdf::Pdf;
use crate::desc::{self, Sides};
use crate::light::tree::LightTree;
use crate::light::{Facing, Light, LightSampleContext, Lights};
use crate::shape::Quadric;
use crate::stats::chi2_test;
use crate::texture::Textures;
use crate::verify::measure::to_detect;
use crate::verify::{Findings, Task, Topic, Trial};
use glam::{Mat3, Mat4, Quat, Vec3, Vec3A};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

pub(super) fn tasks(topic: Topic) -> Vec<Task> {
    vec![
        Task::new(topic, "tree of 200 lights: χ² of the choice, Σ = 1", choice),
        Task::new(topic, "tree of 200 lights: nothing is lost", nothing_is_lost),
        Task::new(topic, "tree of 200 lights: E by tree = E by power", irradiance),
    ]
}

/// Lights of every kind in a box of 4 m × 2 m × 4 m; with `all_around` only such that every point gets light of.
fn many(all_around: bool) -> Vec<Light> {
    let mut rng = rng(5);
    let rng = &mut rng;
    let light = |i: u32, rng: &mut Pcg64Mcg| {
        let at = Vec3::new(rng.random(), rng.random(), rng.random()) * Vec3::new(4.0, 2.0, 4.0);
        let (direction, size) = (random_direction(rng), 0.02 + 0.1 * rng.random::<f32>());
        let pose =
            Mat4::from_scale_rotation_translation(Vec3::splat(size), Quat::from_rotation_arc(Vec3::Z, direction), at);
        let intensity = [0.1 * size * rng.random::<f32>(); 3];
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| pose.transform_point3(p));
        match if all_around { i % 2 } else { i % 7 } {
            0 => Some(Light::from_desc(&desc::Light::Point { position: at, intensity, range: f32::INFINITY })),
            1 => quadric_light(Quadric::Sphere { radius: 1.0 }, pose, Sides::Front),
            2 => triangle_light(corners, Sides::Front),
            3 => triangle_light(corners, Sides::Both),
            4 => quadric_light(Quadric::Disk { radius: 1.0 }, pose, Sides::Front),
            5 => quadric_light(Quadric::Cylinder { radius: 0.5, height: 1.0 }, pose, Sides::Front),
            _ => {
                let (inner, outer) = (0.1 + rng.random::<f32>(), 1.2 + rng.random::<f32>());
                Some(Light::from_desc(&desc::Light::Spot {
                    position: at,
                    direction,
                    intensity,
                    inner,
                    outer,
                    range: f32::INFINITY,
                }))
            }
        }
    };
    (0..200).filter_map(|i| light(i, rng)).collect()
}

/// Those with the sky and parallel light.
fn outdoors(all_around: bool) -> Lights {
    let mut lights = many(all_around);
    let sun = desc::Light::Directional { direction: Vec3::new(0.6, -0.8, 0.0), irradiance: [0.2; 3] };
    lights.push(Light::from_desc(&sun));
    lights.push(environment_light(0.05, None, Mat3::IDENTITY));
    Lights::new(lights, (Vec3::new(2.0, 1.0, 2.0), 3.0), &Textures::default())
}

/// A receiver in the box or around it.
fn receiver(rng: &mut Pcg64Mcg) -> LightSampleContext {
    let p = Vec3::new(rng.random(), rng.random(), rng.random()) * Vec3::new(8.0, 4.0, 8.0) - Vec3::new(2.0, 1.0, 2.0);
    let facing = match rng.random::<u32>() % 3 {
        0 => Facing::All,
        1 => Facing::Half(random_direction(rng).into()),
        _ => Facing::Both(random_direction(rng).into()),
    };
    LightSampleContext { p: p.into(), facing }
}

/// What comes, light by light and nothing at all, against what is stated; the probability given with a choice is that
/// asked for afterwards.
fn choice(trial: &Trial, found: &mut Findings) {
    let mut rng = rng(trial.seed);
    let (mut same, mut off) = (true, 0f64);
    for place in 0..trial.pick(4, 12) {
        let lights = outdoors(place == 0);
        let receiver = if place == 0 { LightSampleContext::anywhere(Vec3::ONE) } else { receiver(&mut rng) };
        let mut stated: Vec<f64> =
            (0..lights.all().len() as u32).map(|i| f64::from(lights.choice(i, &receiver))).collect();
        let total: f64 = stated.iter().sum();
        off = off.max(if place == 0 { (total - 1.0).abs() } else { (total - 1.0).max(0.0) });
        stated.push((1.0 - total).max(0.0));
        let n = trial.work(150_000, 2_000_000);
        let mut chosen = vec![0.0; stated.len()];
        for _ in 0..n {
            match lights.choose(&receiver, rng.random(), [rng.random(), rng.random()]) {
                Some((i, probability)) => {
                    same &= probability == lights.choice(i, &receiver);
                    chosen[i as usize] += 1.0;
                }
                None => chosen[stated.len() - 1] += 1.0,
            }
        }
        let expected: Vec<f64> = stated.iter().map(|p| p * f64::from(n)).collect();
        found.checks.chi2(format!("place {place}, χ²"), chi2_test(&chosen, &expected, 20.0));
    }
    found.checks.holds("the probability of a choice is that of the light", same);
    found.checks.bound("probabilities add up to 1", off, 1e-5);
}

/// Whatever light gives a receiver something has a probability, in the tree itself.
fn nothing_is_lost(trial: &Trial, found: &mut Findings) {
    let (mut rng, lights) = (rng(trial.seed), many(false));
    let bounds: Vec<_> = lights.iter().map(|light| light.bounds(1.0)).collect();
    let Some(tree) = LightTree::new(&bounds, 1.0) else {
        return found.checks.holds("there is a tree", false);
    };
    let (mut lost, mut compared) = (0, 0);
    let receivers = trial.work(500, 10_000);
    for _ in 0..receivers {
        let receiver = receiver(&mut rng);
        for (i, light) in lights.iter().enumerate() {
            let Some(s) = light.sample(receiver.p, [rng.random(), rng.random()], &Textures::default()) else {
                continue;
            };
            // A millionth above the horizon is rounding.
            let counts = match receiver.facing {
                Facing::All => true,
                Facing::Half(n) => s.wi.dot(n) > 1e-6,
                Facing::Both(n) => s.wi.dot(n).abs() > 1e-6,
            };
            compared += u32::from(counts);
            lost += u32::from(counts && tree.probability(&receiver, i as u32) == 0.0);
        }
    }
    found.checks.holds("enough were compared", compared > 60 * receivers);
    found.checks.bound("samples of lights that the tree never chooses", f64::from(lost), 0.0);
}

/// Both choices of a light give one irradiance.
fn irradiance(trial: &Trial, found: &mut Findings) {
    let (tree, n) = (outdoors(false), Vec3A::new(0.6, 0.64, 0.48));
    let power = tree.clone().by_power();
    for p in [Vec3A::new(2.0, 1.0, 2.0), Vec3A::new(-0.5, 0.2, 3.0)] {
        let by = |lights: &Lights, seed: u64, most: u64| {
            to_detect(&Trial { seed, ..*trial }, 1.0, 3e-3, most, |[a, b, c]: [f32; 3]| {
                let receiver = LightSampleContext { p, facing: Facing::Half(n) };
                let Some((_, s)) = lights.sample(&receiver, a, [b, c], &Textures::default()) else { return 0.0 };
                let (Pdf::SolidAngle(pdf) | Pdf::Discrete(pdf)) = s.pdf;
                f64::from(s.le.0.x * s.wi.dot(n).max(0.0) / pdf)
            })
        };
        let most = trial.work(1 << 15, 1 << 18);
        found.checks.equal(format!("E at {p}"), &by(&tree, trial.seed, most), &by(&power, trial.seed ^ 1, 4 * most));
    }
}
