//! Estimators of one integral agree (X1), restricted methods equal the path tracer restricted to their paths (X2),
//! images do not depend on threads and tiles, replays repeat.

mod common;

use common::{SAMPLERS, STRATEGIES, film, load, repo, settings, tiles};
use radianza::desc::{Integrator, SamplerKind, Strategy};
use radianza::film::Film;
use radianza::render::Settings;
use radianza::scene::Scene;
use radianza::stats::Family;

fn small(path: &str, spp: u32) -> (Scene, Settings) {
    let (_, scene) = load(&repo(path));
    (scene, Settings { spp, ..settings([32, 32]) })
}

fn agree(family: &mut Family, name: &str, a: &Film, b: &Film) {
    for (i, ((mean_a, se_a), (mean_b, se_b))) in tiles(a, 8).into_iter().zip(tiles(b, 8)).enumerate() {
        let rounding = 1e-5 * (mean_a.abs() + mean_b.abs());
        let off = ((mean_a - mean_b).abs() - rounding).max(0.0);
        family.estimate(format!("{name} tile {i}"), 0.0, off, se_a.hypot(se_b).max(f64::MIN_POSITIVE));
    }
}

#[test]
fn all_strategies_and_samplers_estimate_the_same_image() {
    let mut family = Family::new("X1: strategies × samplers against mis/sobol with another seed");
    // Directions drawn blindly, and lights drawn for a near-mirror, find so little in Veach's plates that their own
    // error is unknown at any affordable number of samples.
    let for_plates: &[Strategy] = &[Strategy::Bsdf, Strategy::Mis];
    for (path, strategies) in [
        ("scenes/cornell-box.toml", &STRATEGIES[..]),
        ("scenes/interior.toml", &STRATEGIES[..]),
        ("scenes/veach-mis.toml", for_plates),
    ] {
        let (scene, base) = small(path, 512);
        let oracle = film(&scene, &Settings { seed: 99, ..base.clone() });
        for &strategy in strategies {
            for sampler in SAMPLERS {
                let other = film(&scene, &Settings { strategy, sampler, ..base.clone() });
                agree(&mut family, &format!("{path} {strategy:?}/{sampler:?}"), &other, &oracle);
            }
        }
    }
    family.assert();
}

#[test]
fn restricted_methods_equal_the_restricted_path_tracer() {
    let mut family = Family::new("X2: raycast, local");
    for path in ["scenes/cornell-box.toml", "scenes/glass-caustics.toml"] {
        let (scene, base) = small(path, 512);
        for (integrator, depth) in [(Integrator::Raycast, 0), (Integrator::Local, 1)] {
            for strategy in [Strategy::Mis, Strategy::Bsdf] {
                let one = film(&scene, &Settings { integrator, strategy, ..base.clone() });
                let two = film(&scene, &Settings { max_depth: Some(depth), seed: 5, ..base.clone() });
                agree(&mut family, &format!("{path} {integrator:?}/{strategy:?}"), &one, &two);
            }
        }
    }
    family.assert();
}

/// Radiance of the paths whose reflections are all perfect but the last one.
mod whitted_paths {
    use super::*;
    use glam::Vec2;
    use radianza::camera::Camera;
    use radianza::integrator::{Classes, Drawn, Method, Observer, radiance};
    use radianza::sampler::{Kind, Sampler};
    use radianza::spectrum::Spectrum;
    use radianza::stats::Moments;

    /// Counts light as long as no smooth reflection was followed by another reflection.
    #[derive(Default)]
    struct Restricted {
        sum: f64,
        smooth_at: Option<u32>,
        reflections: u32,
    }

    impl Observer for Restricted {
        const CLASSES: bool = true;
        fn light(&mut self, radiance: Spectrum, classes: &Classes) {
            if self.smooth_at.is_none_or(|k| classes.reflections() <= k + 1) {
                self.sum += f64::from(radiance.to_rgb()[1]);
            }
        }
        fn drawn(&mut self, drawn: Drawn, _beta: Spectrum) {
            if self.smooth_at.is_none() && matches!(drawn, Drawn::Smooth { .. }) {
                self.smooth_at = Some(self.reflections);
            }
            self.reflections += 1;
        }
    }

    #[test]
    fn whitted_equals_the_path_tracer_behind_perfect_chains() {
        let mut family = Family::new("X2: whitted");
        for path in ["scenes/glass-caustics.toml", "scenes/transport-ds.toml", "scenes/transport-ss.toml"] {
            let (scene, base) = small(path, 2048);
            let whitted = film(&scene, &Settings { integrator: Integrator::Whitted, spp: 512, ..base.clone() });
            let method =
                Method { scene: &scene, integrator: Integrator::Path, strategy: Strategy::Mis, max_depth: u32::MAX };
            let camera = Camera::new(&scene.cameras[0], base.size);
            let of_pixel = |x: u32, y: u32| {
                let mut m = Moments::default();
                for index in 0..u64::from(base.spp) {
                    let mut u = Sampler::new(Kind::Independent, 3, [x, y], index, 1);
                    let [a, b] = u.next_2d();
                    let ray = camera.ray(Vec2::new(x as f32 + a, y as f32 + b), u.next_2d());
                    let mut watch = Restricted::default();
                    radiance(&method, &ray, &mut u, &mut watch);
                    m.push(watch.sum);
                }
                (m.mean(), m.standard_error())
            };
            for (i, (mean, se)) in tiles(&whitted, 8).into_iter().enumerate() {
                let (mut sum, mut se2) = (0.0, 0.0);
                for k in 0..64 {
                    let (m, s) = of_pixel(i as u32 % 4 * 8 + k % 8, i as u32 / 4 * 8 + k / 8);
                    sum += m / 64.0;
                    se2 += (s / 64.0).powi(2);
                }
                let off = ((mean - sum).abs() - 1e-5 * sum).max(0.0);
                family.estimate(format!("{path} tile {i}"), 0.0, off, se.hypot(se2.sqrt()).max(f64::MIN_POSITIVE));
            }
        }
        family.assert();
    }
}

fn bits(film: &Film) -> Vec<[u64; 3]> {
    film.pixels().map(|[x, y]| film.mean(x, y).map(f64::to_bits)).collect()
}

#[test]
fn threads_and_tiles_change_no_bit() {
    for path in ["scenes/cornell-box.toml", "scenes/glass-caustics.toml", "scenes/interior.toml"] {
        let (scene, base) = small(path, 16);
        for sampler in SAMPLERS {
            for transport in [false, true] {
                let base = Settings { sampler, transport, size: [37, 29], crop: [1, 2, 37, 29], ..base.clone() };
                let first = bits(&film(&scene, &Settings { threads: 1, tile: 16, ..base.clone() }));
                for (threads, tile) in [(2, 16), (7, 16), (1, 5), (7, 64), (2, 1)] {
                    let other = bits(&film(&scene, &Settings { threads, tile, ..base.clone() }));
                    assert!(first == other, "{path}: {threads} threads, tiles of {tile}");
                }
            }
        }
    }
}

#[test]
fn transport_classes_sum_to_the_beauty() {
    for path in ["scenes/cornell-box.toml", "scenes/glass-caustics.toml", "scenes/veach-mis.toml"] {
        let (scene, base) = small(path, 64);
        let plain = film(&scene, &base);
        let split = film(&scene, &Settings { transport: true, ..base.clone() });
        assert_eq!(bits(&plain), bits(&split), "{path}: watching the classes must not change the image");
        for [x, y] in split.pixels() {
            for c in 0..3 {
                let sum: f64 = (0..7).filter_map(|class| split.class_mean(class, x, y)).map(|m| m[c]).sum();
                let beauty = split.mean(x, y)[c];
                assert!((sum - beauty).abs() <= 1e-5 * beauty + 1e-9, "{path} pixel {x},{y}: {sum} of {beauty}");
            }
        }
    }
}

#[test]
fn a_replay_ends_with_the_radiance_of_its_sample() {
    let (scene, base) = small("scenes/cornell-box.toml", 1);
    let one = Settings { replicate: 1, spp: 1, sampler: SamplerKind::Sobol, ..base };
    let image = film(&scene, &one);
    for pixel in [[3, 4], [16, 16], [30, 30]] {
        let text = radianza::render::replay(&scene, &one, pixel, 0).expect("a camera");
        let last = text.lines().last().expect("lines");
        let rgb: Vec<f64> = last
            .trim_start_matches("radiance [")
            .trim_end_matches(']')
            .split(", ")
            .map(|x| x.parse().expect("a number"))
            .collect();
        let mean = image.mean(pixel[0], pixel[1]);
        assert!((0..3).all(|c| (rgb[c] - mean[c]).abs() <= 1e-6 * mean[c]), "{last} is not {mean:?}");
        assert!(text.contains("vertex 0"));
    }
}
