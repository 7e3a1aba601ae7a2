//! Images in independent replicates: what a mean over any part of them is uncertain by is known without assumptions
//! about pixels.

use super::Findings;
use super::measure::REPLICATES;
use crate::film::{CLASSES, Film};
use crate::render::{BadSample, Error, Settings, render};
use crate::sampler::hash;
use crate::scene::Scene;
use crate::stats::Moments;
use rayon::prelude::*;
use std::sync::atomic::AtomicBool;

/// Pixels that are averaged: x0, y0, x1, y1 (upper ends excluded).
pub type Area = [usize; 4];

/// The same image, estimated several times with independent numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Replicated {
    /// Width and height.
    pub size: [usize; 2],
    /// The pixels of each replicate, row by row, RGB.
    pub images: Vec<Vec<[f64; 3]>>,
}

impl Replicated {
    /// The whole image.
    pub fn whole(&self) -> Area {
        [0, 0, self.size[0], self.size[1]]
    }

    /// How many pixels it has.
    pub fn pixel_count(&self) -> f64 {
        (self.size[0] * self.size[1]) as f64
    }

    /// Moments of each pixel over the replicates, row by row, RGB.
    pub fn pixels(&self) -> Vec<[Moments; 3]> {
        let moments = |i: usize, c: usize| self.images.iter().map(|image| image[i][c]).collect();
        (0..self.size[0] * self.size[1]).map(|i| [0, 1, 2].map(|c| moments(i, c))).collect()
    }

    /// Mean of a channel over an area, in each replicate.
    pub fn means(&self, [x0, y0, x1, y1]: Area, channel: usize) -> Vec<f64> {
        let n = ((x1 - x0) * (y1 - y0)) as f64;
        let row = |image: &[[f64; 3]], y: usize| -> f64 {
            image[y * self.size[0]..][x0..x1].iter().map(|rgb| rgb[channel]).sum()
        };
        self.images.iter().map(|image| (y0..y1).map(|y| row(image, y)).sum::<f64>() / n).collect()
    }

    /// Moments of [`means`](Self::means).
    pub fn moments(&self, area: Area, channel: usize) -> Moments {
        self.means(area, channel).into_iter().collect()
    }
}

/// What [`renders`] found.
#[derive(Debug)]
pub struct Renders {
    /// Radiance.
    pub beauty: Replicated,
    /// Radiance by transport class, in the order of [`CLASSES`]; nothing where they were not asked for.
    pub layers: Vec<Replicated>,
    /// The first sample that was no radiance of each replicate that has any, with the replicate's seed.
    pub bad: Vec<(u64, BadSample)>,
    /// How many such samples there were.
    pub bad_count: u64,
    /// Rays traced.
    pub rays: u64,
}

/// Counts samples that are no radiance, over any number of renders.
#[derive(Clone, Debug, Default)]
pub struct Census {
    count: u64,
    first: Vec<String>,
}

impl Census {
    /// Looks at the samples of `renders`, which are told apart by `name`.
    pub fn add(&mut self, name: &str, renders: &Renders) {
        self.count += renders.bad_count;
        if let Some((seed, bad)) = renders.bad.first() {
            self.first.push(format!(
                "{name}: {} samples are not finite or negative; the first is sample {} of pixel {:?} with seed {seed}: {:?}.",
                renders.bad_count, bad.index, bad.pixel, bad.rgb
            ));
        }
    }

    /// The check that there are none, and words about the first of each render.
    pub fn report(self, found: &mut Findings) {
        found.checks.holds("every sample is finite and not negative", self.count == 0);
        found.words.extend(self.first);
    }
}

/// Renders [`REPLICATES`] times with seeds that are made of `settings.seed`: each is one replicate of `settings.spp`
/// samples a pixel, a power of two.
pub fn renders(scene: &Scene, settings: &Settings) -> Result<Renders, Error> {
    let one = |index: u64| {
        let seed = hash(&[settings.seed, index]);
        let alone =
            Settings { seed, replicate: settings.spp, tile: u32::MAX, threads: 0, time: None, ..settings.clone() };
        render(scene, &alone, &AtomicBool::new(false), &|_| {}).map(|output| (seed, output))
    };
    let outputs = (0..REPLICATES).into_par_iter().map(one).collect::<Result<Vec<_>, _>>()?;
    let [x0, y0, x1, y1] = settings.crop;
    let gather = |mean: &dyn Fn(&Film, u32, u32) -> [f64; 3]| Replicated {
        size: [(x1 - x0) as usize, (y1 - y0) as usize],
        images: outputs
            .iter()
            .map(|(_, output)| output.film.pixels().map(|[x, y]| mean(&output.film, x, y)).collect())
            .collect(),
    };
    let classes = if settings.transport { 0..CLASSES.len() } else { 0..0 };
    Ok(Renders {
        beauty: gather(&Film::mean),
        layers: classes.map(|class| gather(&|film, x, y| film.class_mean(class, x, y).unwrap_or_default())).collect(),
        bad: outputs.iter().filter_map(|(seed, output)| Some((*seed, *output.bad.first()?))).collect(),
        bad_count: outputs.iter().map(|(_, output)| output.bad_count).sum(),
        rays: outputs.iter().map(|(_, output)| output.rays).sum(),
    })
}

/// Skewness of a sample, m3/m2^(3/2).
pub fn skewness(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let [m2, m3] = [2, 3].map(|k| values.iter().map(|x| (x - mean).powi(k)).sum::<f64>() / n);
    if m2 > 0.0 { m3 / m2.powf(1.5) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rare_events_are_skew() {
        assert_eq!(skewness(&[1.0, 1.0, 1.0]), 0.0);
        let rare: Vec<f64> = (0..64).map(|i| f64::from(i == 0)).collect();
        assert!((skewness(&rare) - 7.81).abs() < 0.01, "{}", skewness(&rare));
    }
}
