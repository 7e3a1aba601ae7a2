//! Sums of the pixels of an area over one replicate.

use super::layer::{ByClass, MOST_CHANNELS};
use super::{Invalid, Layers, PixelSample, Splats};

/// f64 sums of the pixels of an area over one replicate: a run of consecutive sample indices that share one randomisation,
/// which is independent of that of every other replicate. Only sums of whole replicates may be squared for the error:
/// samples inside one are correlated on purpose.
#[derive(Clone, Debug)]
pub struct Replicate {
    pub(super) layers: Layers,
    pub(super) area: [u32; 4],
    /// Samples of each pixel.
    pub(super) samples: Vec<u32>,
    /// Those that met a surface.
    pub(super) met: Vec<u32>,
    /// Sums of each pixel.
    pub(super) sums: Vec<f64>,
}

impl Replicate {
    /// Nothing yet, for the pixels of `area` (x0, y0, x1, y1, upper ends excluded).
    pub fn new(layers: &Layers, area: [u32; 4]) -> Self {
        let [x0, y0, x1, y1] = area;
        let n = x1.saturating_sub(x0) as usize * y1.saturating_sub(y0) as usize;
        let sums = vec![0.0; n * layers.sums];
        Self { layers: layers.clone(), area, samples: vec![0; n], met: vec![0; n], sums }
    }

    /// The pixels: x0, y0, x1, y1, upper ends excluded.
    pub fn area(&self) -> [u32; 4] {
        self.area
    }

    /// Adds one sample of pixel (x, y), whose radiance is split into `classes` for the layers that keep them. A value that is
    /// not finite, or negative where nothing is, counts as 0, so that one sample cannot take the pixel with it, and with
    /// such an estimate the estimates after it; the first such value is returned.
    ///
    /// # Panics
    /// If the pixel lies outside the area.
    #[inline]
    pub fn add(&mut self, [x, y]: [u32; 2], sample: &PixelSample, classes: &ByClass) -> Option<Invalid> {
        let i = index(self.area, [x, y]);
        self.samples[i] += 1;
        self.met[i] += u32::from(sample.alpha != 0.0);
        // Each layer writes three channels, of which the next overwrites those beyond its own.
        let mut values = [0.0; MOST_CHANNELS + 2];
        for (at, of) in &*self.layers.fed {
            values[*at..*at + 3].copy_from_slice(&of(sample, classes));
        }
        let values = &mut values[..self.layers.sums];
        let sums = &mut self.sums[i * values.len()..][..values.len()];
        let least = &self.layers.least[..values.len()];
        let mut valid = true;
        for c in 0..values.len() {
            valid &= values[c] >= least[c] && values[c] <= f32::MAX;
        }
        let invalid = if valid { None } else { self.layers.clear(values) };
        for c in 0..values.len() {
            sums[c] += f64::from(values[c]);
        }
        invalid
    }

    /// Adds what the paths of all pixels brought to these, once the last of them has ended.
    pub fn add_splats(&mut self, splats: &Splats) {
        let [x0, y0, x1, _] = self.area;
        let width = (x1 - x0).max(1) as usize;
        for (i, sums) in self.sums.chunks_exact_mut(self.layers.sums).enumerate() {
            let pixel = [x0 + (i % width) as u32, y0 + (i / width) as u32];
            for (slot, square) in self.layers.estimates() {
                for (c, sum) in sums[slot.range()].iter_mut().enumerate() {
                    *sum += splats.sum(pixel, square + c);
                }
            }
        }
    }
}

/// Number of a pixel of an area, row by row.
#[inline]
pub(super) fn index(area @ [x0, y0, x1, y1]: [u32; 4], [x, y]: [u32; 2]) -> usize {
    assert!((x0..x1).contains(&x) && (y0..y1).contains(&y), "pixel ({x}, {y}) outside {area:?}");
    (y - y0) as usize * (x1 - x0) as usize + (x - x0) as usize
}
