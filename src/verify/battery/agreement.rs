//! Row X1: estimators of one integral agree. The hemisphere form of the rendering equation (directions drawn uniformly, by the
//! cosine, by the BSDF) and the area form (points drawn on the lights) and their combination estimate one image, with
//! either sampler. No answer is known; the renderer's own way stands for it.

use crate::desc::{Filter, Integrator, Strategy};
use crate::render::{Error, Settings};
use crate::sampler::hash;
use crate::scene::Scene;
use crate::verify::agreement::{agreement, paired};
use crate::verify::expect::{SAMPLERS, STRATEGIES, Way};
use crate::verify::replicated::{Census, Replicated, renders};
use crate::verify::{Findings, Task, Topic, Trial, scenes};

const X1: Topic = Topic {
    id: "X1",
    title: "every pair of estimators of one integral has the same mean: uniform, cosine, BSDF, light, MIS; both samplers",
    source: "Kajiya 1986 (the two forms); Veach & Guibas 1995 (their combination)",
};

/// A scene, the strategies that know their own error there at any affordable number of samples, and the part of the
/// image that is compared, in 32nds of its sides: without the lamps, whose edges are noise to all alike.
struct Case {
    name: &'static str,
    strategies: &'static [Strategy],
    crop: [u32; 4],
}

/// Directions drawn blindly find next to nothing of a narrow lobe, and lights drawn for Veach's near-mirrors little.
const CASES: [Case; 4] = [
    Case { name: "cornell-box", strategies: &STRATEGIES, crop: [0, 8, 32, 32] },
    Case { name: "interior", strategies: &STRATEGIES, crop: [0, 0, 32, 32] },
    Case { name: "veach-mis", strategies: &[Strategy::Bsdf, Strategy::Mis], crop: [0, 16, 32, 32] },
    Case {
        name: "glass-caustics",
        strategies: &[Strategy::Bsdf, Strategy::Light, Strategy::Mis],
        crop: [0, 8, 32, 32],
    },
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

/// Samples of a pixel in a replicate, a power of two, that take about so many rays.
pub(super) fn samples(scene: &Scene, settings: &Settings, rays: f64) -> Result<u32, Error> {
    // One sample a pixel says what a sample costs, and nothing of what it finds.
    let cost = renders(scene, &Settings { spp: 1, ..settings.clone() })?.rays as f64;
    Ok(((rays / cost) as u32).clamp(1, 1 << 24).next_power_of_two())
}

/// A scene of the crate, or a check that fails.
pub(super) fn scene(name: &str, found: &mut Findings) -> Option<Scene> {
    let compiled = scenes::load(&format!("{name}.toml"))
        .map_err(|e| e.to_string())
        .and_then(|desc| Scene::compile(&desc).map_err(|e| e.to_string()));
    compiled.map_err(|e| found.checks.holds(e, false)).ok()
}

/// A task a scene.
pub(super) fn tasks() -> Vec<Task> {
    let task = |case: &'static Case| {
        Task::new(X1, case.name, move |trial, found| {
            let Some(scene) = scene(case.name, found) else { return };
            let mut census = Census::default();
            if let Err(e) = run(&scene, case, trial, &mut census, found) {
                found.checks.holds(e.to_string(), false);
            }
            census.report(found);
            found.guarded = true;
        })
    };
    CASES.iter().map(task).collect()
}

/// With each sampler, all strategies with the same numbers: they share the camera's and in part the paths', so that
/// their differences vary little. Then the samplers against each other.
fn run(scene: &Scene, case: &Case, trial: &Trial, census: &mut Census, found: &mut Findings) -> Result<(), Error> {
    let mut own: Vec<Replicated> = Vec::new();
    for (sampler, rays) in SAMPLERS.into_iter().zip([trial.work(3e5, 6e6), trial.work(7e5, 1.2e7)]) {
        let way = |strategy| Way { integrator: Integrator::Path, strategy, sampler };
        let settings = |strategy| Settings { crop: case.crop, ..small(way(strategy), trial.seed) };
        let spp = samples(scene, &settings(Strategy::Mis), rays)?;
        let mut image = |strategy, seed| {
            let renders = renders(scene, &Settings { spp, seed, ..settings(strategy) })?;
            census.add(&way(strategy).to_string(), &renders);
            Ok::<_, Error>(renders.beauty)
        };
        let seed = hash(&[trial.seed, sampler as u64]);
        let reference = image(Strategy::Mis, seed)?;
        for &strategy in case.strategies.iter().filter(|strategy| **strategy != Strategy::Mis) {
            let name = format!("{} = mis", way(strategy));
            found.exhibits.extend(paired(&mut found.checks, &name, &image(strategy, seed)?, &reference));
        }
        own.push(reference);
    }
    if let [a, b] = &own[..] {
        let name = "Path/Mis/Independent = lattice";
        found.exhibits.extend(agreement(&mut found.checks, name, &a.into(), &b.into()));
    }
    Ok(())
}
