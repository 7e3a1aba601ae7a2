//! Sums of the pixels of an area over one replicate.

use super::layer::ByClass;
use super::sample::{SampleSums, is_plain};
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

/// One pixel of a [`Replicate`], which takes its samples. Where it is dropped, its layers take their share of the sums.
#[derive(Debug)]
pub struct Pixel<'a> {
    layers: &'a Layers,
    samples: &'a mut u32,
    met: &'a mut u32,
    sums: &'a mut [f64],
    /// Of the samples that every layer can take as they are.
    plain: SampleSums,
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

    /// The pixel (x, y), to add samples to.
    ///
    /// # Panics
    /// If it lies outside the area.
    pub fn pixel(&mut self, pixel: [u32; 2]) -> Pixel<'_> {
        let (i, count) = (index(self.area, pixel), self.layers.sums);
        Pixel {
            layers: &self.layers,
            samples: &mut self.samples[i],
            met: &mut self.met[i],
            sums: &mut self.sums[i * count..][..count],
            plain: SampleSums::default(),
        }
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

impl Pixel<'_> {
    /// Adds one sample, whose radiance is split into `classes` for the layers that keep them. A value that is not finite, or
    /// negative where nothing is, counts as 0, so that one sample cannot take the pixel with it, and with such an estimate the
    /// estimates after it; the first such value is returned.
    #[inline]
    pub fn add(&mut self, sample: &PixelSample, classes: &ByClass) -> Option<Invalid> {
        *self.samples += 1;
        *self.met += u32::from(sample.alpha != 0.0);
        if is_plain(sample, classes, self.layers.split) {
            self.plain.add(sample, classes, self.layers.split);
            return None;
        }
        self.add_apart(sample, classes)
    }

    /// A sample that some layer may not take.
    #[cold]
    fn add_apart(&mut self, sample: &PixelSample, classes: &ByClass) -> Option<Invalid> {
        let mut values = self.layers.of(&SampleSums::of(sample, classes));
        let invalid = self.layers.clear(&mut values);
        self.sums.iter_mut().zip(values).for_each(|(sum, x)| *sum += x);
        invalid
    }
}

impl Drop for Pixel<'_> {
    fn drop(&mut self) {
        self.layers.add(&self.plain, self.sums);
    }
}

/// Number of a pixel of an area, row by row.
#[inline]
pub(super) fn index(area @ [x0, y0, x1, y1]: [u32; 4], [x, y]: [u32; 2]) -> usize {
    assert!((x0..x1).contains(&x) && (y0..y1).contains(&y), "pixel ({x}, {y}) outside {area:?}");
    (y - y0) as usize * (x1 - x0) as usize + (x - x0) as usize
}
