//! Row E1: the standard error that an image carries is that of its pixels. Of a film that is fed with numbers whose variance
//! is known, in closed form; of rendered images, whose replicates might not be as independent as they claim, against the
//! spread of the same image over many seeds.

use super::agreement::{scene, small};
use crate::desc::{Integrator, SamplerKind, Strategy};
use crate::film::{Film, Layers, PixelSample, Replicate};
use crate::render::{Error, Output, Settings, render};
use crate::sampler::{Kind, Sampler, hash};
use crate::scene::Scene;
use crate::spectrum::Spectrum;
use crate::stats::{Evidence, Moments};
use crate::verify::expect::Way;
use crate::verify::measure::REPLICATES;
use crate::verify::{Findings, Task, Topic, Trial};
use rayon::prelude::*;
use std::sync::atomic::AtomicBool;

const E1: Topic = Topic {
    id: "E1",
    title: "the error that an image carries is that of its pixels: E[se²] = Var[pixel], whatever the sampler and replicate",
    source: "unbiased sample variance of independent replicates, Bessel's correction",
};

/// A task for the film, and one a scene and sampler.
pub(super) fn tasks() -> Vec<Task> {
    let mut tasks = vec![Task::new(E1, "film of known variance", film)];
    for (name, sampler) in [
        ("cornell-box", SamplerKind::Independent),
        ("cornell-box", SamplerKind::Sobol),
        ("cornell-box", SamplerKind::Lattice),
        ("interior", SamplerKind::Lattice),
    ] {
        let subject = format!("{name}, {}", format!("{sampler:?}").to_lowercase());
        tasks.push(Task::new(E1, subject, move |trial, found| {
            let Some(scene) = scene(name, found) else { return };
            if let Err(e) = rendered(&scene, sampler, trial, found) {
                found.checks.holds(e.to_string(), false);
            }
        }));
    }
    tasks
}

/// Pixels of R replicates of B samples, each uniform in [0, 1): Var = 1/(12 R B), of all and of a class that takes half of
/// each sample, Var/4; the mean is ½.
fn film(trial: &Trial, found: &mut Findings) {
    const SIDE: u32 = 16;
    for (replicates, size) in [(2u32, 1u32), (4, 1), (16, 4)] {
        let films = trial.work(6_000, 200_000) / (replicates * size / 2);
        let exact = 1.0 / (12.0 * f64::from(replicates * size));
        let [mut all, mut class, mut mean] = [Moments::new(); 3];
        for group in 0..REPLICATES {
            let mut sums = [0.0; 3];
            for k in 0..u64::from(films.div_ceil(REPLICATES as u32)) {
                let seed = hash(&[trial.seed, u64::from(replicates), u64::from(size), group, k]);
                let film = fed([SIDE; 2], replicates, size, seed);
                for [x, y] in film.pixels() {
                    let squared = |stderr: Option<[f64; 3]>| stderr.map_or(f64::NAN, |e| e[1] * e[1]);
                    sums[0] += squared(film.stderr(x, y));
                    sums[1] += squared(film.class_stderr(0, x, y));
                    sums[2] += film.mean(x, y)[1];
                }
            }
            let n = f64::from(films.div_ceil(REPLICATES as u32)) * f64::from(SIDE * SIDE);
            [&mut all, &mut class, &mut mean].into_iter().zip(sums).for_each(|(m, sum)| m.push(sum / n));
        }
        let name = format!("{replicates} replicates of {size}");
        found.checks.replicated(format!("{name}: se² of the pixel"), exact, &all, 1e-6);
        found.checks.replicated(format!("{name}: se² of a class"), 0.25 * exact, &class, 1e-6);
        found.checks.replicated(format!("{name}: mean"), 0.5, &mean, 1e-6);
    }
}

/// A film of uniform numbers. Its replicates come in two films that are added, as those of shards are.
fn fed(size: [u32; 2], replicates: u32, samples: u32, seed: u64) -> Film {
    let crop = [0, 0, size[0], size[1]];
    let mut halves = [0, 1].map(|_| Film::new(size, crop, &Layers::held(true)));
    for y in 0..size[1] {
        for x in 0..size[0] {
            let mut u = Sampler::new(Kind::Independent, seed, [x, y], 0, 1);
            for k in 0..replicates {
                let mut sums = Replicate::new(halves[0].layers(), [x, y, x + 1, y + 1]);
                for _ in 0..samples {
                    let radiance = Spectrum::splat(u.next_1d());
                    let mut classes = [Spectrum::ZERO; 7];
                    classes[0] = radiance * 0.5;
                    sums.pixel([x, y]).add(&PixelSample { radiance, ..PixelSample::default() }, &classes);
                }
                halves[(k % 2) as usize].add(&sums);
            }
        }
    }
    let [mut film, other] = halves;
    let _ = film.merge(&other);
    film
}

/// Images of one group, whose spread is compared with what they say of it.
const GROUP: u64 = 4;

/// In each of many groups of images, Σ over the pixels of the variance that their spread shows, and of that which they
/// state: the differences have mean 0. Pixels count by the inverse square of their mean, as their relative errors do.
fn rendered(scene: &Scene, sampler: SamplerKind, trial: &Trial, found: &mut Findings) -> Result<(), Error> {
    let way = Way { integrator: Integrator::Path, strategy: Strategy::Mis, sampler };
    for (replicates, size) in [(2, 8), (8, 2)] {
        let crop = [8, 16, 24, 32];
        let one = Settings { crop, spp: replicates * size, replicate: size, ..small(way, trial.seed) };
        let groups = trial.work(24, 1_400);
        let weights: Vec<f64> = {
            let pilot = image(scene, &one, hash(&[trial.seed, 1]))?;
            pilot.iter().map(|(mean, _)| 1.0 / (mean + 0.05).powi(2)).collect()
        };
        let group = |group: u32| {
            let seed = |k: u64| hash(&[trial.seed, 2, u64::from(replicates), u64::from(group), k]);
            let images = (0..GROUP).map(|k| image(scene, &one, seed(k))).collect::<Result<Vec<_>, Error>>()?;
            let mut sums = [0.0; 2];
            for (i, weight) in weights.iter().enumerate() {
                let means: Moments = images.iter().map(|image| image[i].0).collect();
                sums[0] += weight * means.variance();
                sums[1] += weight * images.iter().map(|image| image[i].1).sum::<f64>() / GROUP as f64;
            }
            Ok::<_, Error>(sums)
        };
        let sums = (0..groups).into_par_iter().map(group).collect::<Result<Vec<_>, _>>()?;
        let stated: Moments = sums.iter().map(|s| s[1]).collect();
        let difference: Moments = sums.iter().map(|s| s[0] - s[1]).collect();
        let (exact, dof) = (stated.mean(), f64::from(groups) - 1.0);
        let (estimate, se) = (exact + difference.mean(), difference.standard_error());
        found.checks.push(
            format!("{replicates} replicates of {size}: spread over seeds = stated"),
            Evidence::Z { exact, estimate, se, dof, rounding: 1e-9 * exact },
        );
    }
    Ok(())
}

/// Mean and squared standard error of the green of each pixel.
fn image(scene: &Scene, settings: &Settings, seed: u64) -> Result<Vec<(f64, f64)>, Error> {
    let settings = Settings { seed, ..settings.clone() };
    let Output { film, .. } = render(scene, &settings, &AtomicBool::new(false), &|_| {})?;
    let pixel = |[x, y]: [u32; 2]| (film.mean(x, y)[1], film.stderr(x, y).map_or(f64::NAN, |e| e[1] * e[1]));
    Ok(film.pixels().map(pixel).collect())
}
