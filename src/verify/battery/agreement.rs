//! Row X1: estimators of one integral agree. The hemisphere form of the rendering equation (directions drawn uniformly, by the
//! cosine, by the BSDF) and the area form (points drawn on the lights) and their combination estimate one image, with
//! either sampler. No answer is known; the mean of the renderer's own way stands for it, made with other numbers.

use crate::desc::{Filter, Integrator, Strategy};
use crate::render::Settings;
use crate::sampler::hash;
use crate::scene::Scene;
use crate::verify::agreement::{Estimated, agreement};
use crate::verify::expect::{SAMPLERS, STRATEGIES, Way};
use crate::verify::replicated::{Census, Replicated, renders};
use crate::verify::{Findings, Task, Topic, Trial, scenes};

const X1: Topic = Topic {
    id: "X1",
    title: "every pair of estimators of one integral has the same mean: uniform, cosine, BSDF, light, MIS; both samplers",
    source: "Kajiya 1986 (the two forms); Veach & Guibas 1995 (their combination)",
};

/// Scenes and the strategies that know their own error there at any affordable number of samples. Directions drawn
/// blindly, and lights drawn for a near-mirror, find next to nothing in Veach's plates.
const SCENES: [(&str, &[Strategy]); 4] = [
    ("cornell-box.toml", &STRATEGIES),
    ("interior.toml", &STRATEGIES),
    ("veach-mis.toml", &[Strategy::Bsdf, Strategy::Mis]),
    ("glass-caustics.toml", &STRATEGIES),
];

/// Settings for a small square image, 8 × 8 pixels a tile.
pub(super) fn small(way: Way, seed: u64) -> Settings {
    const SIDE: u32 = 32;
    Settings {
        size: [SIDE; 2],
        crop: [0, 0, SIDE, SIDE],
        camera: 0,
        spp: 1,
        time: None,
        replicate: 1,
        integrator: way.integrator,
        strategy: way.strategy,
        sampler: way.sampler,
        seed,
        max_depth: None,
        filter: Filter::Box,
        transport: false,
        threads: 0,
        tile: u32::MAX,
    }
}

/// The image with about so many rays.
pub(super) fn image(
    scene: &Scene,
    settings: &Settings,
    rays: f64,
    name: &str,
    census: &mut Census,
    found: &mut Findings,
) -> Option<Replicated> {
    let spend = || {
        // One sample a pixel says what a sample costs, and nothing of what it finds.
        let cost = renders(scene, &Settings { seed: settings.seed ^ 1, ..settings.clone() })?.rays as f64;
        let spp = ((rays / cost) as u32).clamp(1, 1 << 24).next_power_of_two();
        renders(scene, &Settings { spp, ..settings.clone() })
    };
    match spend() {
        Ok(renders) => {
            census.add(name, &renders);
            Some(renders.beauty)
        }
        Err(e) => {
            found.checks.holds(format!("{name}: {e}"), false);
            None
        }
    }
}

/// A scene of the crate, or a check that fails.
pub(super) fn scene(name: &str, found: &mut Findings) -> Option<Scene> {
    let compiled =
        scenes::load(name).map_err(|e| e.to_string()).and_then(|desc| Scene::compile(&desc).map_err(|e| e.to_string()));
    compiled.map_err(|e| found.checks.holds(e, false)).ok()
}

/// A task a scene.
pub(super) fn tasks() -> Vec<Task> {
    let task = |(name, strategies): (&'static str, &'static [Strategy])| {
        Task::new(X1, name.trim_end_matches(".toml"), move |trial, found| run(name, strategies, trial, found))
    };
    SCENES.into_iter().map(task).collect()
}

fn run(name: &str, strategies: &[Strategy], trial: &Trial, found: &mut Findings) {
    let Some(scene) = scene(name, found) else { return };
    let mut census = Census::default();
    let mut ways = Vec::new();
    for &strategy in strategies {
        ways.extend(SAMPLERS.map(|sampler| Way { integrator: Integrator::Path, strategy, sampler }));
    }
    let Some(&own) = ways.last() else { return };
    let seed = |i: u64| hash(&[trial.seed, i]);
    let mut picture = |way: Way, seed: u64, rays: f64, found: &mut Findings| {
        let name = way.to_string();
        image(&scene, &small(way, seed), rays, &name, &mut census, found).map(|image| Estimated::from(&image))
    };
    let Some(oracle) = picture(own, seed(0), trial.pick(4e6, 6e7), found) else { return };
    for (i, &way) in ways.iter().enumerate() {
        let rays = if i + 2 >= ways.len() { trial.pick(2e6, 3e7) } else { trial.pick(5e5, 7e6) };
        if let Some(other) = picture(way, seed(1 + i as u64), rays, found) {
            found.exhibits.extend(agreement(&mut found.checks, &way.to_string(), &other, &oracle));
        }
    }
    census.report(found);
}
