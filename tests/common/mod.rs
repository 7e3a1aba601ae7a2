//! Rendering small images in tests.
#![allow(dead_code, unreachable_pub)]

use radianza::desc::{self, Filter, Integrator, SamplerKind, Strategy};
use radianza::film::Film;
use radianza::render::{Settings, render};
use radianza::scene::Scene;
use radianza::stats::Moments;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// All strategies.
pub const STRATEGIES: [Strategy; 5] =
    [Strategy::Uniform, Strategy::Cosine, Strategy::Bsdf, Strategy::Light, Strategy::Mis];

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

/// Mean and standard error of one channel over a region: pixels are independent.
pub fn region_mean(film: &Film, region: [u32; 4], channel: usize) -> (f64, f64) {
    let [x0, y0, x1, y1] = region;
    let (mut n, mut sum, mut se2) = (0.0, 0.0, 0.0);
    for y in y0..y1 {
        for x in x0..x1 {
            n += 1.0;
            sum += film.mean(x, y)[channel];
            se2 += film.stderr(x, y).expect("several replicates")[channel].powi(2);
        }
    }
    (sum / n, se2.sqrt() / n)
}

/// Green in tiles of `side` × `side` pixels, as mean and standard error, row by row.
pub fn tiles(film: &Film, side: u32) -> Vec<(f64, f64)> {
    let [w, h] = film.size();
    let tile = |i: u32| {
        let (x, y) = (i % (w / side) * side, i / (w / side) * side);
        region_mean(film, [x, y, x + side, y + side], 1)
    };
    (0..(w / side) * (h / side)).map(tile).collect()
}

/// Moments of independent values.
pub fn moments(values: impl IntoIterator<Item = f64>) -> Moments {
    let mut m = Moments::default();
    values.into_iter().for_each(|x| m.push(x));
    m
}
