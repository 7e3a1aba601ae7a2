//! Rendering small images in tests.
#![allow(dead_code, unreachable_pub)]

use glam::Vec3;
use radianza::desc::{self, Filter, Integrator, SamplerKind, Strategy};
use radianza::film::Film;
use radianza::render::{Settings, render};
use radianza::scene::Scene;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Both samplers.
pub const SAMPLERS: [SamplerKind; 2] = [SamplerKind::Independent, SamplerKind::Lattice];

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
        sampler: SamplerKind::Lattice,
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

/// Closed mesh without poles: a cube's faces in an n × n grid, pushed out to a sphere.
pub fn closed_mesh(n: u32, scale: f32, centre: Vec3) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut positions: Vec<Vec3> = Vec::new();
    let mut index = std::collections::HashMap::new();
    let mut vertex = |p: [i64; 3]| {
        *index.entry(p).or_insert_with(|| {
            let q = Vec3::from_array(p.map(|c| c as f32 / n as f32 * 2.0 - 1.0)).normalize();
            positions.push(centre + q * scale);
            (positions.len() - 1) as u32
        })
    };
    let mut indices = Vec::new();
    let n = i64::from(n);
    for axis in 0..3 {
        for side in [0, n] {
            for i in 0..n {
                for j in 0..n {
                    let corner = |a: i64, b: i64| {
                        let mut p = [0; 3];
                        p[axis] = side;
                        p[(axis + 1) % 3] = i + a;
                        p[(axis + 2) % 3] = j + b;
                        p
                    };
                    let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)].map(&mut vertex);
                    if side == 0 {
                        indices.extend([[a, c, b], [a, d, c]]);
                    } else {
                        indices.extend([[a, b, c], [a, c, d]]);
                    }
                }
            }
        }
    }
    (positions, indices)
}
