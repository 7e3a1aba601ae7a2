//! Images in independent replicates: what a mean over any part of them is uncertain by is known without assumptions
//! about pixels.

use super::Findings;
use super::measure::REPLICATES;
use crate::film::CLASSES;
use crate::render::{BadSample, Error, Output, Settings, render};
use crate::sampler::hash;
use crate::scene::Scene;
use crate::stats::Moments;
use rayon::prelude::*;
use std::sync::atomic::AtomicBool;

/// Pixels that are averaged: x0, y0, x1, y1 (upper ends excluded).
pub type Area = [usize; 4];

/// Most pixels along a side that are kept of each replicate; larger images are averaged in blocks.
const MOST: usize = 64;

/// An image that was estimated several times with independent numbers.
#[derive(Clone, Debug, Default, PartialEq)]
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
    pub fn means(&self, area: Area, channel: usize) -> Vec<f64> {
        self.images.iter().map(|image| mean(self.size[0], area, |i| image[i][channel])).collect()
    }

    /// Moments of [`means`](Self::means).
    pub fn moments(&self, area: Area, channel: usize) -> Moments {
        self.means(area, channel).into_iter().collect()
    }
}

/// Mean over an area of what an image of this width has, row by row.
fn mean(width: usize, [x0, y0, x1, y1]: Area, pixel: impl Fn(usize) -> f64) -> f64 {
    let sum: f64 = (y0..y1).flat_map(|y| (x0..x1).map(move |x| y * width + x)).map(pixel).sum();
    sum / ((x1 - x0) * (y1 - y0)) as f64
}

/// An image in blocks, at most [`MOST`] a side, and their number along the sides. The last blocks of rows and columns reach
/// back into those before them where the sides are no multiple, so that all are of one size.
fn blocks(size: [usize; 2], pixels: &[[f64; 3]]) -> ([usize; 2], Vec<[f64; 3]>) {
    let side = size[0].max(size[1]).div_ceil(MOST).max(1);
    let side = [0, 1].map(|k| side.min(size[k]));
    let count = [0, 1].map(|k| size[k].div_ceil(side[k]));
    let from = |k: usize, i: usize| (i * side[k]).min(size[k] - side[k]);
    let block = |x: usize, y: usize| {
        let [x, y] = [from(0, x), from(1, y)];
        [0, 1, 2].map(|c| mean(size[0], [x, y, x + side[0], y + side[1]], |i| pixels[i][c]))
    };
    (count, (0..count[1]).flat_map(|y| (0..count[0]).map(move |x| (x, y))).map(|(x, y)| block(x, y)).collect())
}

/// What [`renders`] found.
#[derive(Debug)]
pub struct Renders {
    /// Radiance.
    pub beauty: Replicated,
    /// Radiance by transport class, in the order of [`CLASSES`]; nothing where they were not asked for.
    pub layers: Vec<Replicated>,
    /// The first invalid sample of each replicate that has any, with the replicate's seed.
    pub bad: Vec<(u64, BadSample)>,
    /// How many such samples there were.
    pub bad_count: u64,
    /// Rays traced.
    pub rays: u64,
    /// Samples in each pixel of each image, on average where pixels are blocks.
    pub samples: f64,
}

/// Counts invalid samples, over any number of renders.
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
                "{name}: {} samples are not finite or negative; the first is sample {} of pixel {:?} with seed {seed}: {} {:?}.",
                renders.bad_count, bad.index, bad.pixel, bad.invalid.layer, bad.invalid.value
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
/// samples a pixel, a power of two. Images of more than 64 pixels a side are kept in blocks.
pub fn renders(scene: &Scene, settings: &Settings) -> Result<Renders, Error> {
    let [x0, y0, x1, y1] = settings.crop;
    let size = [x1.saturating_sub(x0) as usize, y1.saturating_sub(y0) as usize];
    let classes = if settings.transport { CLASSES.len() } else { 0 };
    let one = |index: u64| {
        let seed = hash(&[settings.seed, index]);
        let alone =
            Settings { seed, replicate: settings.spp, tile: u32::MAX, threads: 0, time: None, ..settings.clone() };
        let Output { film, bad, bad_count, rays, .. } = render(scene, &alone, &AtomicBool::new(false), &|_| {})?;
        let keep = |mean: &dyn Fn(u32, u32) -> [f64; 3]| {
            blocks(size, &film.pixels().map(|[x, y]| mean(x, y)).collect::<Vec<_>>())
        };
        let mut images = vec![keep(&|x, y| film.mean(x, y))];
        images.extend((0..classes).map(|class| keep(&|x, y| film.class_mean(class, x, y).unwrap_or_default())));
        Ok::<_, Error>((images, bad.first().map(|bad| (seed, *bad)), bad_count, rays))
    };
    let outputs = (0..REPLICATES).into_par_iter().map(one).collect::<Result<Vec<_>, _>>()?;
    let mut found = Renders {
        beauty: Replicated::default(),
        layers: Vec::new(),
        bad: Vec::new(),
        bad_count: 0,
        rays: 0,
        samples: 0.0,
    };
    let mut quantities = vec![Replicated::default(); 1 + classes];
    for (images, bad, bad_count, rays) in outputs {
        for (quantity, (size, image)) in quantities.iter_mut().zip(images) {
            quantity.size = size;
            quantity.images.push(image);
        }
        found.bad.extend(bad);
        found.bad_count += bad_count;
        found.rays += rays;
    }
    found.layers = quantities.split_off(1);
    found.beauty = quantities.swap_remove(0);
    found.samples = f64::from(settings.spp) * (size[0] * size[1]) as f64 / found.beauty.pixel_count();
    Ok(found)
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
    fn small_images_are_kept_and_large_ones_averaged() {
        let ramp = |n: usize| (0..n).map(|i| [i as f64, 1.0, 0.0]).collect::<Vec<_>>();
        assert_eq!(blocks([5, 3], &ramp(15)), ([5, 3], ramp(15)));
        let (size, image) = blocks([130, 2], &ramp(260));
        assert_eq!((size, image.len()), ([44, 1], 44));
        // Columns 0 to 2 and 127 to 129 of both rows.
        assert_eq!((image[0], image[43]), ([66.0, 1.0, 0.0], [193.0, 1.0, 0.0]));
    }

    #[test]
    fn rare_events_are_skew() {
        assert_eq!(skewness(&[1.0, 1.0, 1.0]), 0.0);
        let rare: Vec<f64> = (0..64).map(|i| f64::from(i == 0)).collect();
        assert!((skewness(&rare) - 7.81).abs() < 0.01, "{}", skewness(&rare));
    }
}
