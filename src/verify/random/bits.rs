//! What changes nothing in an image, to the last bit.

use crate::desc::{Filter, Integrator, SamplerKind, Strategy};
use crate::film::Film;
use crate::render::{Error, Settings, render, replay};
use crate::sampler::hash;
use crate::scene::Scene;
use crate::verify::Findings;
use crate::verify::scene::Subject;
use std::sync::atomic::AtomicBool;

/// Pixels across and down.
const SIDE: u32 = 16;

/// Samples of a pixel that is replayed.
const REPLAYED: usize = 8;

/// Checks that neither threads nor a replay change what a sample finds.
pub(super) fn judge(subject: &Subject, seed: u64, found: &mut Findings) {
    if let Err(e) = compare(&subject.scene, seed, found) {
        found.checks.holds(format!("an image is made: {e}"), false);
    }
}

fn compare(scene: &Scene, seed: u64, found: &mut Findings) -> Result<(), Error> {
    let image = |threads: usize, tile: u32| film(scene, &settings(seed, 2, threads, tile));
    found.checks.holds("one thread and three make the same image", equal(&image(1, 16)?, &image(3, 4)?));

    let single = settings(seed, 1, 1, 16);
    let film = film(scene, &single)?;
    let mut repeats = true;
    for k in 0..REPLAYED {
        let pixel = [0, 1].map(|axis| (hash(&[seed, k as u64, axis]) % u64::from(SIDE)) as u32);
        let text = replay(scene, &single, pixel, 0)?;
        repeats &= radiance(&text).is_some_and(|rgb| rgb.map(f64::from) == film.mean(pixel[0], pixel[1]));
    }
    found.checks.holds("a replay finds what its pixel holds", repeats);
    Ok(())
}

fn settings(seed: u64, spp: u32, threads: usize, tile: u32) -> Settings {
    Settings {
        size: [SIDE; 2],
        crop: [0, 0, SIDE, SIDE],
        camera: 0,
        spp,
        time: None,
        replicate: 1,
        integrator: Integrator::Path,
        strategy: Strategy::Mis,
        sampler: SamplerKind::Lattice,
        seed: seed >> 11,
        max_depth: None,
        filter: Filter::BlackmanHarris,
        transport: true,
        threads,
        tile,
    }
}

fn film(scene: &Scene, settings: &Settings) -> Result<Film, Error> {
    Ok(render(scene, settings, &AtomicBool::new(false), &|_| {})?.film)
}

fn equal(a: &Film, b: &Film) -> bool {
    a.pixels().all(|[x, y]| a.mean(x, y).map(f64::to_bits) == b.mean(x, y).map(f64::to_bits))
}

/// The radiance that a replay ends with; nothing where it is none, which counts as 0 in the film.
fn radiance(text: &str) -> Option<[f32; 3]> {
    let list = text.trim_end().rsplit_once("radiance [")?.1.strip_suffix(']')?;
    let numbers: Vec<f32> = list.split(", ").map(|x| x.parse().ok()).collect::<Option<_>>()?;
    numbers.try_into().ok()
}
