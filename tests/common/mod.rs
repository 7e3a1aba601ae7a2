//! Rendering small images in tests.
#![allow(dead_code, unreachable_pub)]

use radianza::desc::{self, Filter, Integrator, SamplerKind, Strategy};
use radianza::film::Film;
use radianza::render::{Settings, render};
use radianza::scene::Scene;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Both samplers.
pub const SAMPLERS: [SamplerKind; 2] = [SamplerKind::Independent, SamplerKind::Sobol];

/// A path inside the repository.
pub fn repo(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Reads and compiles, or says why not.
pub fn load(path: &Path) -> (desc::Scene, Scene) {
    let desc = desc::load(path).unwrap_or_else(|e| panic!("{e}"));
    let scene = Scene::compile(&desc).unwrap_or_else(|e| panic!("{e}"));
    (desc, scene)
}

/// Settings for a small image of `size`: whole image, box filter, 32 replicates of 16 samples, all cores.
pub fn settings(size: [u32; 2]) -> Settings {
    Settings {
        size,
        crop: [0, 0, size[0], size[1]],
        camera: 0,
        spp: 512,
        time: None,
        replicate: 16,
        integrator: Integrator::Path,
        strategy: Strategy::Mis,
        sampler: SamplerKind::Sobol,
        seed: 1,
        max_depth: None,
        filter: Filter::Box,
        transport: false,
        threads: 0,
        tile: 8,
    }
}

/// Renders; a sample that is no radiance fails the test.
pub fn film(scene: &Scene, settings: &Settings) -> Film {
    let output = render(scene, settings, &AtomicBool::new(false), &|_| {}).unwrap_or_else(|e| panic!("{e}"));
    assert!(output.bad.is_empty(), "samples that are no radiance: {:?}", output.bad);
    output.film
}
