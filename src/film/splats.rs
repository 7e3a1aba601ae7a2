//! Splats: what paths bring to other pixels than the one they were sampled for, as paths from the lights do.

use super::exact::ExactSum;
use super::layer::{ByClass, RADIANCE};
use super::replicate::index;
use super::sample::SampleSums;
use super::{Film, Invalid, Layers, PixelSample, filter_density, filter_radius};
use crate::desc::Filter;
use crate::spectrum::Spectrum;
use glam::Vec2;

/// Splats of all pixels over one replicate. Any path may still bring something to any pixel, so that the sum S of a pixel is
/// complete, and may be squared, only once all paths of the replicate have ended; until then what comes is gathered here,
/// from all threads, exactly: the sums are the same bits for any order. 40 bytes a pixel and channel of an estimate.
#[derive(Debug)]
pub struct Splats {
    crop: [u32; 4],
    layers: Layers,
    /// As many of each pixel as the film keeps squares.
    sums: Vec<ExactSum>,
}

impl Splats {
    /// None yet, for the pixels and estimates of a film.
    pub fn new(film: &Film) -> Self {
        let (crop, layers) = (film.crop(), film.layers().clone());
        let n = film.replicates.len() * layers.squares;
        Self { crop, layers, sums: (0..n).map(|_| ExactSum::default()).collect() }
    }

    /// Adds the contribution of a path that ends at the film point `at` \[px\], drawn with some density over the film: what it
    /// carries over that density \[W·sr⁻¹·m⁻²·px²\], times the samples of a replicate over the paths of all pixels together. Each pixel
    /// whose filter h reaches the point takes its share, whose expectation is
    ///
    /// ```text
    /// I = ∫ h(x − centre) L(x) dx
    /// ```
    ///
    /// Radiance that is not finite or negative is not added, but returned.
    pub fn add(&self, filter: Filter, at: Vec2, radiance: Spectrum, classes: &ByClass) -> Option<Invalid> {
        if !at.is_finite() {
            return Some(Invalid { layer: RADIANCE, value: [at.x, at.y, 0.0] });
        }
        for (pixel, share) in pixels(filter, at, self.crop) {
            let sample = PixelSample { radiance: radiance * share, ..PixelSample::default() };
            let one = SampleSums::of(&sample, &classes.map(|radiance| radiance * share));
            let cell = &self.sums[index(self.crop, pixel) * self.layers.squares..][..self.layers.squares];
            for (slot, square) in self.layers.estimates() {
                let value = (slot.layer.of)(&one).map(|x| x as f32);
                if !value.iter().all(|x| x.is_finite() && (slot.layer.signed || *x >= 0.0)) {
                    return Some(Invalid { layer: slot.layer.name, value });
                }
                // What may be negative is so by rounding alone.
                let sums = cell[square..].iter().take(slot.layer.channels.len());
                sums.zip(value).for_each(|(sum, x)| sum.add(x.max(0.0)));
            }
        }
        None
    }

    /// Sum of one channel of a pixel, by its place among the squares.
    pub(super) fn sum(&self, pixel: [u32; 2], channel: usize) -> f64 {
        self.sums[index(self.crop, pixel) * self.layers.squares + channel].value()
    }
}

/// Pixels of a window whose filter reaches a film point, with its value there \[1/px²\].
fn pixels(filter: Filter, at: Vec2, [x0, y0, x1, y1]: [u32; 4]) -> impl Iterator<Item = ([u32; 2], f32)> {
    // Centres x + ½ with −r ≤ at − (x + ½) < r: of the narrowest filter the pixel that holds the point.
    let radius = filter_radius(filter);
    let range = move |at: f32, from: u32, to: u32| {
        let first = (at - radius - 0.5).floor() + 1.0;
        let last = (at + radius - 0.5).floor() + 1.0;
        // Saturates; NaN is 0, where the filter is NaN too.
        (first.max(from as f32) as u32).min(to)..(last.max(from as f32) as u32).min(to)
    };
    let columns = range(at.x, x0, x1);
    let pixels = range(at.y, y0, y1).flat_map(move |y| columns.clone().map(move |x| [x, y]));
    pixels.filter_map(move |pixel| {
        let centre = Vec2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
        let share = filter_density(filter, at - centre) as f32;
        (share > 0.0).then_some((pixel, share))
    })
}
