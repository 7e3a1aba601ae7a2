//! What changes nothing in an image, to the last bit.

use super::{SIDE, settings};
use crate::desc::{self, Filter, toml};
use crate::film::Film;
use crate::render::{Error, Settings, render, replay};
use crate::sampler::hash;
use crate::scene::Scene;
use crate::verify::Findings;
use crate::verify::scene::Subject;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Pixels that are replayed.
const REPLAYED: usize = 8;

/// Checks that neither threads, nor a replay, nor a file change what a sample finds.
pub(super) fn judge(subject: &Subject, seed: u64, found: &mut Findings) {
    if let Err(e) = compare(subject, seed, found) {
        found.checks.holds(format!("an image is made: {e}"), false);
    }
}

fn compare(Subject { desc, scene }: &Subject, seed: u64, found: &mut Findings) -> Result<(), Error> {
    // Windows of the filter reach over the edges of pixels and tiles, and every layer of the film is compared.
    let settings = Settings { filter: Filter::BlackmanHarris, transport: true, ..settings(1, seed) };
    let double = |threads: usize, tile: u32| film(scene, &Settings { spp: 2, threads, tile, ..settings.clone() });
    found.checks.holds("one thread and three make the same image", double(1, 16)? == double(3, 4)?);

    let single = Settings { threads: 1, ..settings };
    let film = film(scene, &single)?;
    read_back(desc, &film, &single, found)?;
    let mut repeats = true;
    for k in 0..REPLAYED {
        let pixel = [0, 1].map(|axis| (hash(&[seed, k as u64, axis]) % u64::from(SIDE)) as u32);
        let text = replay(scene, &single, pixel, 0)?;
        repeats &= radiance(&text).is_some_and(|rgb| rgb.map(f64::from) == film.mean(pixel[0], pixel[1]));
    }
    found.checks.holds("a replay finds what its pixel holds", repeats);
    Ok(())
}

/// Checks that a file says the whole scene: what is written reads as the same description, and is the same film.
fn read_back(desc: &desc::Scene, of: &Film, settings: &Settings, found: &mut Findings) -> Result<(), Error> {
    let text = toml::to_text(desc);
    let back = match toml::parse(&text, Path::new("written.toml")) {
        Ok(back) => desc::Scene { source: desc.source.clone(), ..back },
        Err(e) => {
            found.checks.holds(format!("what is written is read: {e}"), false);
            return Ok(());
        }
    };
    found.checks.holds("what is written reads as the same description", back == *desc);
    match Scene::compile(&back) {
        Ok(back) => found.checks.holds("what is written has the same image", film(&back, settings)? == *of),
        Err(e) => found.checks.holds(format!("what is written is compiled: {e}"), false),
    }
    Ok(())
}

fn film(scene: &Scene, settings: &Settings) -> Result<Film, Error> {
    Ok(render(scene, settings, &AtomicBool::new(false), &|_| {})?.film)
}

/// The radiance that a replay ends with; nothing where it is none, which counts as 0 in the film.
fn radiance(text: &str) -> Option<[f32; 3]> {
    let list = text.trim_end().rsplit_once("radiance [")?.1.strip_suffix(']')?;
    let numbers: Vec<f32> = list.split(", ").map(|x| x.parse().ok()).collect::<Option<_>>()?;
    numbers.try_into().ok()
}
