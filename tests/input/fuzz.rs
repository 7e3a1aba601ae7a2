//! The targets of `tests/fuzz/`, on their seeds and on changes of them: what a fuzzer does, for a second.

#[path = "../fuzz/bodies.rs"]
mod bodies;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::path::Path;

/// Changed files of each seed.
const CHANGES: usize = 400;

/// Most bytes of all seeds.
const MOST: usize = 200_000;

fn seeds(target: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus").join(target);
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files.iter().map(|path| std::fs::read(path).unwrap()).collect()
}

/// A few bytes set, taken out, put in; a part of another seed; the end cut off.
fn change(rng: &mut Pcg64Mcg, bytes: &mut Vec<u8>, other: &[u8]) {
    for _ in 0..rng.random_range(1..6) {
        let at = rng.random_range(0..=bytes.len());
        let n = rng.random_range(1..9).min(bytes.len() - at);
        match rng.random_range(0..6) {
            0 => bytes[at..at + n].fill_with(|| rng.random()),
            1 => bytes[at..at + n].fill(if rng.random() { 0xff } else { 0 }),
            2 => drop(bytes.drain(at..at + n)),
            3 => bytes.insert(at, rng.random()),
            4 if !other.is_empty() => {
                let from = rng.random_range(0..other.len());
                let to = (from + rng.random_range(1..40)).min(other.len());
                bytes.splice(at..at + n, other[from..to].iter().copied());
            }
            5 if rng.random_range(0..4) == 0 => bytes.truncate(at),
            _ => {}
        }
    }
}

fn run(target: &str, body: fn(&[u8])) {
    let seeds = seeds(target);
    assert!(!seeds.is_empty(), "tests/fuzz/corpus/{target} is empty");
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    for seed in &seeds {
        body(seed);
        for _ in 0..CHANGES {
            let mut bytes = seed.clone();
            let other = &seeds[rng.random_range(0..seeds.len())];
            change(&mut rng, &mut bytes, other);
            body(&bytes);
        }
    }
}

#[test]
fn gltf() {
    run("gltf", bodies::gltf);
}

#[test]
fn toml() {
    run("toml", bodies::toml);
}

#[test]
fn obj() {
    run("obj", bodies::obj);
}

#[test]
fn ply() {
    run("ply", bodies::ply);
}

#[test]
fn image() {
    run("image", bodies::image);
}

#[test]
fn seeds_are_small() {
    let bytes: usize =
        ["gltf", "toml", "obj", "ply", "image"].iter().flat_map(|target| seeds(target)).map(|seed| seed.len()).sum();
    assert!(bytes < MOST, "{bytes} bytes");
}
