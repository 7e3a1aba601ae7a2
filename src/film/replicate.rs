//! Sums of the pixels of an area over one replicate.

use super::layer::ByClass;
use super::layers::LANES;
use super::{Invalid, Layers, PixelSample, Splats};
use glam::Vec4;

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
    /// Sums of each pixel, padded.
    pub(super) sums: Vec<f64>,
    /// What the sample that is being added gives to each sum, with room for two channels more.
    values: Vec<f32>,
}

/// One pixel of a [`Replicate`], which takes its samples.
#[derive(Debug)]
pub struct Pixel<'a> {
    layers: &'a Layers,
    samples: &'a mut u32,
    met: &'a mut u32,
    sums: &'a mut [f64],
    values: &'a mut [f32],
}

impl Replicate {
    /// Nothing yet, for the pixels of `area` (x0, y0, x1, y1, upper ends excluded).
    pub fn new(layers: &Layers, area: [u32; 4]) -> Self {
        let [x0, y0, x1, y1] = area;
        let n = x1.saturating_sub(x0) as usize * y1.saturating_sub(y0) as usize;
        let (sums, values) = (vec![0.0; n * layers.stride], vec![0.0; layers.stride + 2]);
        Self { layers: layers.clone(), area, samples: vec![0; n], met: vec![0; n], sums, values }
    }

    /// The pixels: x0, y0, x1, y1, upper ends excluded.
    pub fn area(&self) -> [u32; 4] {
        self.area
    }

    /// The pixel (x, y), to add samples to.
    ///
    /// # Panics
    /// If it lies outside the area.
    pub fn pixel(&mut self, pixel: [u32; 2]) -> Pixel<'_> {
        let (i, stride) = (index(self.area, pixel), self.layers.stride);
        Pixel {
            layers: &self.layers,
            samples: &mut self.samples[i],
            met: &mut self.met[i],
            sums: &mut self.sums[i * stride..][..stride],
            values: &mut self.values,
        }
    }

    /// Adds what the paths of all pixels brought to these, once the last of them has ended.
    pub fn add_splats(&mut self, splats: &Splats) {
        let [x0, y0, x1, _] = self.area;
        let width = (x1 - x0).max(1) as usize;
        for (i, sums) in self.sums.chunks_exact_mut(self.layers.stride).enumerate() {
            let pixel = [x0 + (i % width) as u32, y0 + (i / width) as u32];
            for (slot, square) in self.layers.estimates() {
                for (c, sum) in sums[slot.range()].iter_mut().enumerate() {
                    *sum += splats.sum(pixel, square + c);
                }
            }
        }
    }
}

impl Pixel<'_> {
    /// Adds one sample, whose radiance is split into `classes` for the layers that keep them. A value that is not finite, or
    /// negative where nothing is, counts as 0, so that one sample cannot take the pixel with it, and with such an estimate the
    /// estimates after it; the first such value is returned.
    #[inline]
    pub fn add(&mut self, sample: &PixelSample, classes: &ByClass) -> Option<Invalid> {
        *self.samples += 1;
        *self.met += u32::from(sample.alpha != 0.0);
        // Each layer writes three channels, of which the next overwrites those beyond its own.
        for (at, of) in &*self.layers.fed {
            self.values[*at..*at + 3].copy_from_slice(&of(sample, classes));
        }
        let (values, _) = self.values.as_chunks::<LANES>();
        let within = |(values, least): (&[f32; LANES], &[f32; LANES])| {
            let values = Vec4::from_array(*values);
            (values.cmpge(Vec4::from_array(*least)) & values.cmple(Vec4::MAX)).all()
        };
        let valid = values.iter().zip(self.layers.least.as_chunks().0).all(within);
        let invalid = if valid { None } else { self.layers.clear(self.values) };
        let ((sums, _), (values, _)) = (self.sums.as_chunks_mut::<LANES>(), self.values.as_chunks::<LANES>());
        for (sums, values) in sums.iter_mut().zip(values) {
            for c in 0..LANES {
                sums[c] += f64::from(values[c]);
            }
        }
        invalid
    }
}

/// Number of a pixel of an area, row by row.
#[inline]
pub(super) fn index(area @ [x0, y0, x1, y1]: [u32; 4], [x, y]: [u32; 2]) -> usize {
    assert!((x0..x1).contains(&x) && (y0..y1).contains(&y), "pixel ({x}, {y}) outside {area:?}");
    (y - y0) as usize * (x1 - x0) as usize + (x - x0) as usize
}
