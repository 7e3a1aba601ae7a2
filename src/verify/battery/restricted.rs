//! Row X2: the truncated methods equal the path tracer restricted to the same set of paths: ray casting to paths without
//! reflection, local illumination to those with one, Whitted's tree to those whose reflections are all perfect but the
//! one next to the light.

use super::agreement::{samples, scene, small};
use crate::camera::Camera;
use crate::desc::{Integrator, SamplerKind, Strategy};
use crate::integrator::{Classes, Method, Observer, SampledBy, Solver, radiance};
use crate::render::{Error, Settings};
use crate::sampler::{Kind, Sampler, hash};
use crate::scene::Scene;
use crate::spectrum::Spectrum;
use crate::verify::agreement::{agreement, paired};
use crate::verify::expect::Way;
use crate::verify::measure::REPLICATES;
use crate::verify::replicated::{Census, Replicated, renders};
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
    let mut tasks = Vec::new();
    for name in ["cornell-box", "interior", "glass-caustics"] {
        for (integrator, depth) in [(Integrator::Raycast, 0), (Integrator::Local, 1)] {
            let subject = format!("{} {name}", format!("{integrator:?}").to_lowercase());
            tasks.push(task(subject, name, move |scene, trial, census, found| {
                truncated(scene, [integrator, Integrator::Path], depth, trial, census, found)
            }));
        }
    }
    tasks.extend(
        ["glass-caustics", "transport-ds", "transport-ss"]
            .into_iter()
            .map(|name| task(format!("whitted {name}"), name, whitted)),
    );
    tasks
}

/// A task of the scene's name; errors are checks that fail.
fn task(
    subject: String,
    name: &'static str,
    work: impl Fn(&Scene, &Trial, &mut Census, &mut Findings) -> Result<(), Error> + Send + Sync + 'static,
) -> Task {
    Task::new(X2, subject, move |trial, found| {
        let Some(scene) = scene(name, found) else { return };
        let mut census = Census::default();
        if let Err(e) = work(&scene, trial, &mut census, found) {
            found.checks.holds(e.to_string(), false);
        }
        census.report(found);
        found.guarded = true;
    })
}

/// The method against the path tracer with at most `depth` reflections, with the same numbers.
fn truncated(
    scene: &Scene,
    [integrator, path]: [Integrator; 2],
    depth: u32,
    trial: &Trial,
    census: &mut Census,
    found: &mut Findings,
) -> Result<(), Error> {
    for strategy in [Strategy::Cosine, Strategy::Bsdf, Strategy::Light, Strategy::Mis] {
        let settings = |integrator| {
            let way = Way { integrator, strategy, sampler: SamplerKind::Lattice };
            Settings { max_depth: Some(depth), ..small(way, hash(&[trial.seed, strategy as u64])) }
        };
        let spp = samples(scene, &settings(integrator), trial.work(1.2e5, 3e6))?;
        let [one, two] = [integrator, path].map(|method| renders(scene, &Settings { spp, ..settings(method) }));
        let (one, two) = (one?, two?);
        let name = format!("{integrator:?}/{strategy:?}");
        census.add(&name, &one);
        census.add(&format!("{name}, path"), &two);
        found.exhibits.extend(paired(&mut found.checks, &name, &one.beauty, &two.beauty));
    }
    Ok(())
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
    fn sampled(&mut self, sampled_by: SampledBy, _beta: Spectrum) {
        if self.smooth_at.is_none() && matches!(sampled_by, SampledBy::Smooth { .. }) {
            self.smooth_at = Some(self.reflections);
        }
        self.reflections += 1;
    }
}

/// Whitted's tree against the paths that it follows, with other numbers: a tree draws them in another order.
fn whitted(scene: &Scene, trial: &Trial, census: &mut Census, found: &mut Findings) -> Result<(), Error> {
    let way = Way { integrator: Integrator::Whitted, strategy: Strategy::Mis, sampler: SamplerKind::Lattice };
    let settings = Settings { crop: [0, 8, 32, 32], ..small(way, trial.seed) };
    let spp = samples(scene, &settings, trial.work(6e5, 1.5e7))?;
    let tree = renders(scene, &Settings { spp, ..settings.clone() })?;
    census.add("tree", &tree);
    let paths = restricted(scene, &settings, u64::from(spp));
    found.exhibits.extend(agreement(&mut found.checks, &way.to_string(), &(&tree.beauty).into(), &(&paths).into()));
    Ok(())
}

/// The path tracer's image of the paths that Whitted's method follows, with so many samples a pixel and replicate.
fn restricted(scene: &Scene, settings: &Settings, samples: u64) -> Replicated {
    let (integrator, strategy, max_depth) = (Integrator::Path, settings.strategy, u32::MAX);
    let camera = Camera::new(&scene.cameras[settings.camera], settings.size);
    let media = scene.media_near(camera.middle());
    let solver = Solver::prepare(scene, integrator);
    let method = Method { scene, integrator, strategy, max_depth, media, solver };
    let seed = hash(&[settings.seed, 2]);
    let sample = |[x, y]: [u32; 2], index: u64| {
        let mut u = Sampler::new(Kind::Independent, seed, [x, y], index, 1);
        let [a, b] = u.next_2d();
        let ray = camera.ray(Vec2::new(x as f32 + a, y as f32 + b), u.next_2d());
        let mut watch = Restricted::default();
        radiance(&method, &ray, &mut u, &mut watch);
        watch.sum
    };
    let [x0, y0, x1, y1] = settings.crop;
    let pixel = |place: [u32; 2], replicate: u64| {
        let first = replicate * samples;
        let sums = (first..first + samples).map(|index| sample(place, index));
        let sum = sums.fold([0.0; 3], |sum: [f64; 3], x| std::array::from_fn(|c| sum[c] + x[c]));
        sum.map(|x| x / samples as f64)
    };
    let image = |replicate: u64| {
        (y0..y1).flat_map(|y| (x0..x1).map(move |x| [x, y])).map(|place| pixel(place, replicate)).collect()
    };
    Replicated {
        size: [(x1 - x0) as usize, (y1 - y0) as usize],
        images: (0..REPLICATES).into_par_iter().map(image).collect(),
    }
}
