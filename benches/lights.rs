//! Error of light from many lamps, the light tree against the choice by power: relMSE at equal samples and at equal
//! time, medians of interleaved runs.
//!
//! A floor of 20 m × 20 m below emissive triangles of mixed size, pose and radiance (over three decades), generated.
//! relMSE = mean over the pixels of σ²/(μ² + (mean/100)²), from the spread of the independent samples.

use radianza::desc::{self, Filter, Integrator, SamplerKind, Strategy};
use radianza::glam::{Quat, Vec3};
use radianza::render::{Settings, render};
use radianza::scene::Scene;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::path::Path;
use std::sync::atomic::AtomicBool;

fn main() {
    println!("| lamps | relMSE × spp, power | tree | ratio | s, power | tree | 1/(relMSE s), tree : power |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    // Numbers of lamps and scene files of the command line, or a series.
    let mut asked: Vec<String> = std::env::args().skip(1).filter(|arg| !arg.starts_with('-')).collect();
    if asked.is_empty() {
        asked = ["2", "4", "8", "16", "32", "100", "1000", "10000"].map(String::from).to_vec();
    }
    for name in asked {
        let compiled = || {
            let written = match name.parse() {
                Ok(lamps) => desc::toml::parse(&hall(lamps), Path::new("hall.toml")),
                Err(_) => desc::load(Path::new(&name)),
            };
            written.and_then(|scene| Scene::compile(&scene)).unwrap_or_else(|e| panic!("{e}"))
        };
        let (tree, mut power) = (compiled(), compiled());
        power.lights = power.lights.by_power();
        let runs: Vec<[Run; 2]> = (0..5).map(|seed| [measure(&power, seed), measure(&tree, seed)]).collect();
        let median = |f: &dyn Fn(&[Run; 2]) -> f64| {
            let mut values: Vec<f64> = runs.iter().map(f).collect();
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        };
        println!(
            "| {name} | {:.4} | {:.4} | {:.2} | {:.3} | {:.3} | {:.2} |",
            median(&|r| r[0].error),
            median(&|r| r[1].error),
            median(&|r| r[0].error / r[1].error),
            median(&|r| r[0].seconds),
            median(&|r| r[1].seconds),
            median(&|r| r[0].error * r[0].seconds / (r[1].error * r[1].seconds)),
        );
    }
}

/// Of one sample a pixel.
struct Run {
    error: f64,
    seconds: f64,
}

fn measure(scene: &Scene, seed: u64) -> Run {
    let size = [96, 64];
    let settings = Settings {
        size,
        crop: [0, 0, size[0], size[1]],
        camera: 0,
        spp: 64,
        time: None,
        replicate: 1,
        integrator: Integrator::Path,
        strategy: Strategy::Mis,
        sampler: SamplerKind::Independent,
        seed,
        max_depth: Some(3),
        filter: Filter::Box,
        transport: false,
        threads: 0,
        tile: 16,
    };
    let out = render(scene, &settings, &AtomicBool::new(false), &|_| {}).unwrap_or_else(|e| panic!("{e}"));
    let pixels: Vec<[u32; 2]> = out.film.pixels().collect();
    let mean = |x, y| out.film.mean(x, y).iter().sum::<f64>() / 3.0;
    let whole = pixels.iter().map(|&[x, y]| mean(x, y)).sum::<f64>() / pixels.len() as f64;
    let relative = |&[x, y]: &[u32; 2]| {
        let variance = out.film.stderr(x, y).map_or(0.0, |s| s.iter().map(|s| s * s).sum::<f64>() / 3.0);
        variance / (mean(x, y).powi(2) + (0.01 * whole).powi(2))
    };
    let error = pixels.iter().map(relative).sum::<f64>() / pixels.len() as f64 * f64::from(settings.spp);
    Run { error, seconds: out.elapsed.as_secs_f64() }
}

/// The hall with this many lamps.
fn hall(lamps: usize) -> String {
    let mut rng = Pcg64Mcg::seed_from_u64(7);
    let mut text = HALL.to_owned();
    for _ in 0..lamps {
        let mut next = || rng.random::<f32>();
        let at = Vec3::new(20.0 * (next() - 0.5), 1.0 + 3.0 * next(), 20.0 * (next() - 0.5));
        let turn = Quat::from_rotation_y(6.3 * next()) * Quat::from_rotation_x(3.2 * next());
        let size = (0.02 + 0.1 * next()) * (100.0 / lamps as f32).sqrt().clamp(0.2, 3.0);
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| (at + turn * (p * size)).to_array());
        let radiance = 10f32.powf(3.0 * next() - 1.0);
        text.push_str(&format!(
            "[[shape]]\ntype = \"mesh\"\npositions = {corners:?}\nindices = [[0, 1, 2]]\nemission = {radiance}\n"
        ));
    }
    text
}

const HALL: &str = r#"
[camera]
position = [0, 9, 14]
target = [0, 0, 0]
view_angle = 50
[material.grey]
type = "diffuse"
reflectance = 0.5
[[shape]]
type = "quad"
corner = [-10, 0, 10]
edge_u = [20, 0, 0]
edge_v = [0, 0, -20]
material = "grey"
"#;
