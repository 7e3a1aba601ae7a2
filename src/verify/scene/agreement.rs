//! Estimators of one image: all strategies must agree with multiple importance sampling.
//!
//! A strategy may be right and still never meet what matters: a lamp of a millionth of the hemisphere, or the peak of
//! a polished metal. What such events may be worth is known, and is part of the error that is granted; where it is more
//! than the image itself, the strategy is left out, and the words say so.

use super::Subject;
use super::places::places;
use super::view::{Budget, View, camera_name};
use super::worn::least_alpha;
use crate::desc::{Light, Pixels, Scene, Strategy};
use crate::render::{Error, Settings};
use crate::sampler::hash;
use crate::verify::agreement::{Estimated, agreement};
use crate::verify::expect::STRATEGIES;
use crate::verify::measure::REPLICATES;
use crate::verify::replicated::{Census, Replicated, renders};
use crate::verify::tiles::{Estimate, estimates, unseen};
use crate::verify::{Findings, Task, Topic};

const TOPIC: Topic = Topic {
    id: "agreement",
    title: "all ways of drawing directions estimate the same image",
    source: "unbiasedness; Welch 1947 and Šidák 1967 over tiles",
};

/// Rays of an image.
const RAYS: [u64; 2] = [4_000_000, 60_000_000];

/// Largest relative bias that it is worth to look for.
const WORTH: f64 = 0.5;

/// The first camera's image.
pub(super) fn tasks(subject: &Subject) -> Vec<Task> {
    if subject.desc.objects.is_empty() || subject.scene.cameras.is_empty() {
        return Vec::new();
    }
    let subject = subject.clone();
    vec![Task::new(TOPIC, camera_name(&subject.scene, 0), move |trial, found| {
        if let Err(e) = compare(&subject, Budget::of(trial, RAYS), found) {
            found.words.push(format!("no image: {e}"));
            found.checks.holds("an image is made", false);
        }
    })]
}

/// Checks that all strategies estimate the image of the first camera.
pub(in crate::verify) fn compare(subject: &Subject, budget: Budget, found: &mut Findings) -> Result<(), Error> {
    let scene = &subject.scene;
    let settings = View { camera: 0, budget, strategy: Strategy::Mis }.settings(scene)?;
    let samples = settings.replicate;
    let mut census = Census::default();
    let mut image = |strategy: Strategy| -> Result<Replicated, Error> {
        let seed = hash(&[settings.seed, strategy as u64]);
        let renders = renders(scene, &Settings { spp: samples, seed, strategy, ..settings.clone() })?;
        census.add(&format!("{strategy:?}"), &renders);
        Ok(renders.beauty)
    };
    let reference = image(Strategy::Mis)?;

    // What a single sample may be worth, by light and by the peak of the glossiest lobe.
    let brightest = brightest(&subject.desc);
    let image_peak = reference.pixels().iter().flat_map(|rgb| rgb.iter().map(|m| m.mean())).fold(0.0, f64::max);
    let gloss = gloss(subject);
    let worth = |strategy: Strategy| match strategy {
        Strategy::Mis => image_peak,
        Strategy::Bsdf => brightest.max(image_peak),
        Strategy::Light => image_peak * gloss,
        Strategy::Uniform | Strategy::Cosine => brightest.max(image_peak) * gloss,
    };
    let ours = estimated(&reference, worth(Strategy::Mis), samples);
    let level = ours.mean.iter().map(|m| m.mean).fold(0.0, f64::max);
    let mut told = Vec::new();
    for strategy in STRATEGIES.into_iter().filter(|s| *s != Strategy::Mis) {
        let theirs = estimated(&image(strategy)?, worth(strategy), samples);
        // Six standard errors fail a check of thousands, two and a third more find what is there (power 0.99).
        let detects = (0..3).map(|c| 8.3 * theirs.mean[c].se.hypot(ours.mean[c].se)).fold(0.0, f64::max) / level;
        if level > 0.0 && detects > WORTH {
            told.push(format!("{strategy:?} is not judged: single samples may be worth too much of the image"));
            continue;
        }
        told.push(format!("{strategy:?} (finds {:.1} %)", 100.0 * if level > 0.0 { detects } else { 0.0 }));
        let name = format!("{strategy:?} against Mis");
        found.exhibits.extend(agreement(&mut found.checks, &name, &theirs, &ours));
    }
    let [w, h] = settings.size;
    let n = u64::from(samples) * REPLICATES;
    found.words.push(format!("{w}×{h} pixels, {n} samples each, against Mis: {}", told.join("; ")));
    census.report(found);
    found.guarded = true;
    Ok(())
}

/// An image with its errors; a sample may be worth `worth` and not have been met.
fn estimated(image: &Replicated, worth: f64, samples: u32) -> Estimated {
    let numbers = (image.size[0] * image.size[1]) as f64 * f64::from(samples) * REPLICATES as f64;
    let whole = |channel: usize| {
        let moments = image.moments(image.whole(), channel);
        let deviation = |x: f64| (x - moments.mean()).abs();
        let largest = image.means(image.whole(), channel).into_iter().map(deviation).fold(0.0, f64::max);
        let plain = Estimate::of(&moments);
        let rare = unseen(largest, REPLICATES as f64).max(unseen(worth, numbers));
        Estimate { se: plain.se.hypot(rare), ..plain }
    };
    Estimated {
        mean: [0, 1, 2].map(whole),
        tiles: [0, 1, 2].map(|channel| estimates(image, channel, worth, f64::from(samples))),
        ..Estimated::from(image)
    }
}

/// The greatest radiance that a surface or the environment may emit.
fn brightest(scene: &Scene) -> f64 {
    let largest = |rgb: &[f32; 3]| rgb.iter().map(|x| f64::from(*x)).fold(0.0, f64::max);
    let of_image = |image: usize| match scene.images.get(image).map(|i| &i.pixels) {
        Some(Pixels::Rgba32F(pixels)) => pixels.iter().flat_map(|p| &p[..3]).fold(0.0, |a: f32, b| a.max(*b)).into(),
        _ => 1.0,
    };
    let own = scene.objects.iter().filter_map(|o| o.emission.as_ref());
    let emitted = scene.materials.iter().filter_map(|m| m.emission.as_ref()).chain(own);
    let surfaces = emitted.map(|e| {
        let image = e.radiance.texture.and_then(|t| match scene.textures.get(t.texture) {
            Some(crate::desc::Texture::Image { image, .. }) => Some(*image),
            _ => None,
        });
        largest(&e.radiance.factor) * image.map_or(1.0, of_image)
    });
    // A sun's disk has its irradiance over the solid angle, π sin² of half the diameter where it is seen from the front.
    let suns = scene.lights.iter().map(|light| match light {
        Light::Sun { irradiance, diameter, .. } => {
            largest(irradiance) / (std::f64::consts::PI * (0.5 * f64::from(*diameter)).sin().powi(2))
        }
        _ => 0.0,
    });
    let around = scene.environment.iter().map(|e| largest(&e.radiance) * e.image.map_or(1.0, of_image));
    surfaces.chain(suns).chain(around).fold(0.0, f64::max)
}

/// How much brighter than a diffuse surface the glossiest one is at its peak: D/4 ≈ 1/(4πα²) against 1/π.
fn gloss(subject: &Subject) -> f64 {
    let desc = &subject.desc;
    let worn = desc.materials.iter().enumerate().filter(|(i, _)| desc.objects.iter().any(|o| o.material == *i));
    let alpha = worn.flat_map(|(i, material)| {
        let places = places(desc, material, i);
        let alpha = |place| least_alpha(&material.model, &subject.scene.textures, &place);
        places.into_iter().filter_map(alpha).collect::<Vec<_>>()
    });
    let least = alpha.fold(1.0, f64::min);
    (0.25 / (least * least)).max(1.0)
}
