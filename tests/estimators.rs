//! Mechanics of the estimators: images do not depend on threads and tiles, classes sum to the whole, replays repeat.

mod common;

use common::{SAMPLERS, film, load, repo, settings};
use radianza::desc::SamplerKind;
use radianza::film::Film;
use radianza::render::Settings;
use radianza::scene::Scene;

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
