//! Mechanics of the estimators: images do not depend on threads and tiles, classes sum to the whole, replays repeat.

use crate::common::{SAMPLERS, film, load, repo, settings};
use radianza::desc::SamplerKind;
use radianza::film::Film;
use radianza::render::{Next, Pixels, Schedule, Settings, render_by};
use radianza::scene::Scene;
use std::sync::atomic::AtomicBool;

fn small(path: &str, spp: u32) -> (Scene, Settings) {
    let (_, scene) = load(&repo(path));
    (scene, Settings { spp, ..settings([32, 32]) })
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
fn rounds_that_look_at_the_image_do_not_depend_on_threads() {
    let (scene, base) = small("scenes/cornell-box.toml", 16);
    let base = Settings { size: [24, 24], crop: [1, 2, 23, 19], replicate: 2, ..base };
    // Two rounds of all pixels, then of those with the larger error, until the sum of replicates is reached.
    let decide = |round: u32, film: &Film| {
        let pixels: Vec<[u32; 2]> = film.pixels().collect();
        let error = |&[x, y]: &[u32; 2]| film.stderr(x, y).map_or(f64::INFINITY, |e| e[1]);
        let mean = pixels.iter().map(error).sum::<f64>() / pixels.len() as f64;
        match round {
            0 | 1 => Next::Sample(Pixels::All),
            2..8 => Next::Sample(Pixels::These(pixels.iter().map(|pixel| error(pixel) >= mean).collect())),
            _ => Next::Stop,
        }
    };
    let render = |lag: u32, threads: usize, tile: u32| {
        let schedule = Schedule::Adaptive { lag, decide: Box::new(decide) };
        let settings = Settings { threads, tile, ..base.clone() };
        render_by(&schedule, &scene, &settings, &AtomicBool::new(false), &|_| {}).expect("a camera").film
    };
    for lag in [0, 1, 2] {
        let first = render(lag, 1, 8);
        let replicates: Vec<u32> = first.pixels().map(|[x, y]| first.replicates(x, y)).collect();
        assert!(replicates.iter().min() < replicates.iter().max(), "{replicates:?}");
        for (threads, tile) in [(2, 8), (7, 8), (3, 5), (2, 64), (2, 1)] {
            assert!(render(lag, threads, tile) == first, "lag {lag}, {threads} threads, tiles of {tile}");
        }
    }
    // Rounds of all pixels, decided one by one, are what a fixed number of them is.
    let all = |round, _: &Film| if round < 8 { Next::Sample(Pixels::All) } else { Next::Stop };
    let schedule = Schedule::Adaptive { lag: 1, decide: Box::new(all) };
    let output = render_by(&schedule, &scene, &base, &AtomicBool::new(false), &|_| {}).expect("a camera");
    assert!(output.film == film(&scene, &base));
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
    let one = Settings { replicate: 1, spp: 1, sampler: SamplerKind::Lattice, ..base };
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
