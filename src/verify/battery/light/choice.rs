//! D5: one light of many.
//!
//! The alias table's choices against the probabilities that it states, densities with the choice in them, and the sum of all
//! lights' closed forms by samples of one at a time. The light tree's rows are in `tree`.

use super::polygon::polygon;
use super::{environment_light, quadric_light, rng, triangle_light};
use crate::bsdf::Pdf;
use crate::desc::{self, Sides};
use crate::light::{Alias, Light, LightSampleContext, Lights};
use crate::math::Ray;
use crate::shape::Quadric;
use crate::stats::chi2_test;
use crate::texture::Textures;
use crate::verify::measure::to_detect;
use crate::verify::{Findings, Task, Topic, Trial};
use glam::{Mat3, Mat4, Quat, Vec3};
use rand::RngExt;
use std::f64::consts::PI;

const D5: Topic = Topic {
    id: "D5",
    title: "lights are chosen with the probability stated",
    source: "Walker 1977; Vose 1991; Conty Estevez & Kulla 2018; rules of evidence, 'the density is the law'",
};

pub(super) fn tasks() -> Vec<Task> {
    let mut tasks = vec![
        Task::new(D5, "choice among eight lights", choice),
        Task::new(D5, "alias tables", tables),
        Task::new(D5, "all lights together: E = Σ E of each", sum),
        Task::new(D5, "densities include the choice", densities),
    ];
    tasks.extend(super::tree::tasks(D5));
    tasks
}

/// The corners of the emissive triangle.
const PATCH: [Vec3; 3] = [Vec3::new(-1.0, 0.0, 1.0), Vec3::new(-1.0, 1.0, 1.0), Vec3::new(-2.0, 0.0, 1.0)];

/// Lights of very different powers about the origin, number 1 black.
fn eight() -> Lights {
    let point = |z: f32, intensity: f32| {
        Light::from_desc(&desc::Light::Point {
            position: Vec3::new(0.3, 0.1, z),
            intensity: [intensity; 3],
            range: f32::INFINITY,
        })
    };
    let sun = desc::Light::Directional { direction: Vec3::new(0.6, 0.0, -0.8), irradiance: [0.3; 3] };
    let facing_down = Mat4::from_rotation_translation(Quat::from_rotation_x(std::f32::consts::PI), Vec3::Z);
    let lights = [
        Some(point(2.0, 0.7)),
        Some(point(1.0, 0.0)),
        Some(Light::from_desc(&sun)),
        quadric_light(Quadric::Disk { radius: 0.5 }, facing_down, Sides::Front),
        Some(environment_light(0.1, None, Mat3::IDENTITY)),
        Some(point(0.3, 1e-4)),
        Some(environment_light(0.2, None, Mat3::IDENTITY)),
        triangle_light(PATCH, Sides::Both),
    ];
    Lights::new(lights.into_iter().flatten().collect(), (Vec3::ZERO, 3.0), &Textures::default())
}

/// χ² of the light chosen by power, counted through its samples at the origin, which all lights reach.
fn choice(trial: &Trial, found: &mut Findings) {
    let (lights, receiver) = (eight().by_power(), LightSampleContext::anywhere(Vec3::ZERO));
    let choices: Vec<f64> = (0..lights.all().len() as u32).map(|i| f64::from(lights.choice(i, &receiver))).collect();
    found.checks.holds("eight lights", choices.len() == 8);
    found.checks.bound("probabilities add up to 1", (choices.iter().sum::<f64>() - 1.0).abs(), 0.0);
    let dark = |i: usize| lights.power(i as u32).is_black();
    found.checks.holds("the black one has none", choices.iter().enumerate().all(|(i, &p)| (p == 0.0) == dark(i)));
    found.checks.holds("all others have more than a thousandth", choices.iter().all(|&p| p == 0.0 || p > 1e-3));

    let (mut rng, n) = (rng(trial.seed), trial.work(1_000_000, 20_000_000));
    let mut chosen = vec![0.0; choices.len()];
    for _ in 0..n {
        let u = [rng.random(), rng.random()];
        if let Some((i, _)) = lights.sample(&receiver, rng.random(), u, &Textures::default()) {
            chosen[i as usize] += 1.0;
        }
    }
    let expected: Vec<f64> = choices.iter().map(|p| p * f64::from(n)).collect();
    found.checks.chi2("χ² of the choice", chi2_test(&chosen, &expected, 20.0));
}

/// Tables of many entries, of which some never and some hardly ever come.
fn tables(trial: &Trial, found: &mut Findings) {
    let mut rng = rng(trial.seed);
    for entries in [2usize, 3, 17, 64, 1000] {
        let weight = |k: usize| if k % 7 == 3 { 0.0 } else { rng.random::<f64>().powi(1 + (k % 3) as i32 * 3) };
        let weights: Vec<f64> = (0..entries).map(weight).collect();
        let Some(alias) = Alias::new(&weights) else {
            found.checks.holds(format!("{entries} entries make a table"), false);
            continue;
        };
        let n = trial.work(200_000, 4_000_000);
        let mut chosen = vec![0.0; entries];
        (0..n).for_each(|_| chosen[alias.choose(rng.random())] += 1.0);
        let expected: Vec<f64> = (0..entries).map(|i| f64::from(n) * f64::from(alias.probability(i))).collect();
        found.checks.chi2(format!("{entries} entries, χ²"), chi2_test(&chosen, &expected, 20.0));
        let total: f64 = weights.iter().sum();
        let off = (0..entries).map(|i| (f64::from(alias.probability(i)) - weights[i] / total).abs());
        // The 2²⁴ steps are dealt out whole.
        found.checks.bound(
            format!("{entries} entries, probability − weight"),
            off.fold(0.0, f64::max),
            (entries + 1) as f64 / f64::from(1 << 24),
        );
    }
}

/// Irradiance of all lights at once is the sum of their closed forms.
fn sum(trial: &Trial, found: &mut Findings) {
    let lights = eight();
    let point = |z: f64, intensity: f64| {
        let r2: f64 = 0.3 * 0.3 + 0.1 * 0.1 + z * z;
        intensity * z / r2.powf(1.5)
    };
    let exact = point(2.0, 0.7)
        + 0.3 * 0.8
        + PI * 0.25 / (0.25 + 1.0)
        + PI * 0.1
        + point(0.3, 1e-4)
        + PI * 0.2
        + polygon(&PATCH.map(|p| p.as_dvec3()), Vec3::Z.as_dvec3());
    let estimate = to_detect(trial, exact, 3e-3, trial.work(1 << 18, 1 << 20), |[a, b, c]: [f32; 3]| {
        let Some((_, s)) = lights.sample(&LightSampleContext::anywhere(Vec3::ZERO), a, [b, c], &Textures::default())
        else {
            return 0.0;
        };
        let (Pdf::SolidAngle(p) | Pdf::Discrete(p)) = s.pdf;
        f64::from(s.le.0.x * s.wi.z.max(0.0) / p)
    });
    // Some roundings of f32, and the disk's plane, turned by π in it.
    found.checks.replicated("E", exact, &estimate, 2e-6);
}

/// `pdf_hit` and `environment_pdf` are what `sample` said, the choice included.
fn densities(trial: &Trial, found: &mut Findings) {
    let (lights, mut rng) = (eight(), rng(trial.seed));
    let (mut worst, mut compared) = (0f64, 0);
    let draws = trial.work(20_000, 400_000);
    for _ in 0..draws {
        let u = [rng.random(), rng.random()];
        let Some((i, s)) =
            lights.sample(&LightSampleContext::anywhere(Vec3::ZERO), rng.random(), u, &Textures::default())
        else {
            continue;
        };
        let Pdf::SolidAngle(pdf) = s.pdf else { continue };
        let again = match &lights.all()[i as usize] {
            Light::Environment(_) => lights.environment_pdf(&LightSampleContext::anywhere(Vec3::ZERO), s.wi),
            light => match light.intersect(&Ray::new(Vec3::ZERO, s.wi)) {
                Some((_, hit)) => lights.pdf_hit(i, &LightSampleContext::anywhere(Vec3::ZERO), hit.p, hit.ng),
                None => continue,
            },
        };
        compared += 1;
        worst = worst.max(f64::from((pdf / again - 1.0).abs()));
    }
    found.checks.holds("enough were compared", 4 * compared > draws);
    found.checks.bound("pdf of sample = pdf of hit", worst, 1e-4);
}
