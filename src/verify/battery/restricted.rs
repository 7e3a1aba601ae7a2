//! Row X2: the truncated methods equal the path tracer restricted to the same set of paths: ray casting to paths without
//! reflection, local illumination to those with one, Whitted's tree to those whose reflections are all perfect but the
//! one next to the light.

use super::agreement::{image, scene, small};
use crate::camera::Camera;
use crate::desc::{Integrator, SamplerKind, Strategy};
use crate::integrator::{Classes, Drawn, Method, Observer, radiance};
use crate::render::Settings;
use crate::sampler::{Kind, Sampler, hash};
use crate::scene::Scene;
use crate::spectrum::Spectrum;
use crate::verify::agreement::agreement;
use crate::verify::expect::Way;
use crate::verify::measure::REPLICATES;
use crate::verify::replicated::{Census, Replicated};
use crate::verify::{Findings, Task, Topic, Trial};
use glam::Vec2;
use rayon::prelude::*;

const X2: Topic = Topic {
    id: "X2",
    title: "ray casting, local and Whitted's method equal the path tracer restricted to their paths",
    source: "light-path classes, Heckbert 1990; Whitted 1980",
};

/// A task a method and scene.
pub(super) fn tasks() -> Vec<Task> {
    let truncated = ["cornell-box", "glass-caustics"].into_iter().flat_map(|name| {
        [(Integrator::Raycast, 0), (Integrator::Local, 1)].map(|(integrator, depth)| {
            let subject = format!("{} {name}", format!("{integrator:?}").to_lowercase());
            Task::new(X2, subject, move |trial, found| truncated(name, integrator, depth, trial, found))
        })
    });
    let whitted = ["glass-caustics", "transport-ds", "transport-ss"]
        .into_iter()
        .map(|name| Task::new(X2, format!("whitted {name}"), move |trial, found| whitted(name, trial, found)));
    truncated.chain(whitted).collect()
}

/// The method against the path tracer with at most `depth` reflections.
fn truncated(name: &str, integrator: Integrator, depth: u32, trial: &Trial, found: &mut Findings) {
    let Some(scene) = scene(&format!("{name}.toml"), found) else { return };
    let mut census = Census::default();
    for strategy in [Strategy::Bsdf, Strategy::Light, Strategy::Mis] {
        let way = |integrator| Way { integrator, strategy, sampler: SamplerKind::Sobol };
        let rays = trial.pick(5e5, 7e6);
        let seed = |i| hash(&[trial.seed, strategy as u64, i]);
        let (one, two) = (small(way(integrator), seed(0)), small(way(Integrator::Path), seed(1)));
        let two = Settings { max_depth: Some(depth), ..two };
        let label = way(integrator).to_string();
        let one = image(&scene, &one, rays, &label, &mut census, found);
        let two = image(&scene, &two, rays, &format!("{label}, path"), &mut census, found);
        if let (Some(one), Some(two)) = (one, two) {
            found.exhibits.extend(agreement(&mut found.checks, &label, &(&one).into(), &(&two).into()));
        }
    }
    census.report(found);
}

/// Counts light as long as no smooth reflection was followed by another reflection.
#[derive(Default)]
struct Restricted {
    sum: [f64; 3],
    smooth_at: Option<u32>,
    reflections: u32,
}

impl Observer for Restricted {
    const CLASSES: bool = true;
    fn light(&mut self, radiance: Spectrum, classes: &Classes) {
        if self.smooth_at.is_none_or(|k| classes.reflections() <= k + 1) {
            for (sum, x) in self.sum.iter_mut().zip(radiance.to_rgb()) {
                *sum += f64::from(x);
            }
        }
    }
    fn drawn(&mut self, drawn: Drawn, _beta: Spectrum) {
        if self.smooth_at.is_none() && matches!(drawn, Drawn::Smooth { .. }) {
            self.smooth_at = Some(self.reflections);
        }
        self.reflections += 1;
    }
}

fn whitted(name: &str, trial: &Trial, found: &mut Findings) {
    let Some(scene) = scene(&format!("{name}.toml"), found) else { return };
    let mut census = Census::default();
    let way = Way { integrator: Integrator::Whitted, strategy: Strategy::Mis, sampler: SamplerKind::Sobol };
    let settings = small(way, trial.seed);
    if let Some(tree) = image(&scene, &settings, trial.pick(1e6, 1.5e7), &way.to_string(), &mut census, found) {
        let paths = restricted(&scene, &settings, trial.pick(4, 64));
        found.exhibits.extend(agreement(&mut found.checks, &way.to_string(), &(&tree).into(), &(&paths).into()));
    }
    census.report(found);
}

/// The path tracer's image of the paths that Whitted's method follows, with so many samples a pixel and replicate.
fn restricted(scene: &Scene, settings: &Settings, samples: u64) -> Replicated {
    let (integrator, strategy, max_depth) = (Integrator::Path, settings.strategy, u32::MAX);
    let method = Method { scene, integrator, strategy, max_depth };
    let camera = Camera::new(&scene.cameras[settings.camera], settings.size);
    let seed = hash(&[settings.seed, 2]);
    let sample = |[x, y]: [u32; 2], index: u64| {
        let mut u = Sampler::new(Kind::Independent, seed, [x, y], index, 1);
        let [a, b] = u.next_2d();
        let ray = camera.ray(Vec2::new(x as f32 + a, y as f32 + b), u.next_2d());
        let mut watch = Restricted::default();
        radiance(&method, &ray, &mut u, &mut watch);
        watch.sum
    };
    let [width, height] = settings.size;
    let pixel = |place: [u32; 2], replicate: u64| {
        let first = replicate * samples;
        let sums = (first..first + samples).map(|index| sample(place, index));
        let sum = sums.fold([0.0; 3], |sum: [f64; 3], x| std::array::from_fn(|c| sum[c] + x[c]));
        sum.map(|x| x / samples as f64)
    };
    let image = |replicate: u64| {
        (0..height).flat_map(|y| (0..width).map(move |x| [x, y])).map(|place| pixel(place, replicate)).collect()
    };
    Replicated { size: settings.size.map(|n| n as usize), images: (0..REPLICATES).into_par_iter().map(image).collect() }
}
