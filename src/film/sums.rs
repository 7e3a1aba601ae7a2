//! Sums of all pixels over all replicates, and the estimates that follow from them.

use super::layer::{CLASSES, Kind, RADIANCE};
use super::layers::Slot;
use super::replicate::index;
use super::{Layers, Replicate};
use glam::DVec3;

/// The sums of an image, pixel by pixel and layer by layer: never means, so that adding films is adding numbers, and the
/// error can always be computed. About 130 bytes a pixel, 340 more with transport classes.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    pub(super) size: [u32; 2],
    pub(super) crop: [u32; 4],
    pub(super) layers: Layers,
    /// Samples per replicate, 0 while there is none.
    pub(super) replicate: u32,
    /// Replicates of each pixel.
    pub(super) replicates: Vec<u32>,
    /// Samples of each pixel that met a surface.
    pub(super) met: Vec<u64>,
    /// Σ S of each pixel and channel, with S the sum over one replicate.
    pub(super) sums: Vec<f64>,
    /// Σ S² of each pixel and channel of an estimate.
    pub(super) squares: Vec<f64>,
}

/// Two films that cannot be added.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MergeError {
    /// They are of different images.
    #[error("films of {0}×{1} and {2}×{3} pixels")]
    Size(u32, u32, u32, u32),
    /// The other holds pixels that this one does not.
    #[error("the window {0:?} lies outside {1:?}")]
    Window([u32; 4], [u32; 4]),
    /// Replicates of different length have different variances.
    #[error("replicates of {0} and of {1} samples")]
    Replicate(u32, u32),
    /// They keep different things.
    #[error("films of different layers")]
    Layers,
}

impl Film {
    /// An empty film of `layers` for the pixels `crop` (x0, y0, x1, y1, upper ends excluded) of an image of `size` pixels.
    ///
    /// # Panics
    /// If `crop` does not lie inside the image.
    pub fn new(size: [u32; 2], crop: [u32; 4], layers: &Layers) -> Self {
        let [x0, y0, x1, y1] = crop;
        assert!(x0 <= x1 && x1 <= size[0] && y0 <= y1 && y1 <= size[1], "crop {crop:?} of an image {size:?}");
        let n = (x1 - x0) as usize * (y1 - y0) as usize;
        Self {
            size,
            crop,
            replicate: 0,
            replicates: vec![0; n],
            met: vec![0; n],
            sums: vec![0.0; n * layers.sums],
            squares: vec![0.0; n * layers.squares],
            layers: layers.clone(),
        }
    }

    /// Width and height of the whole image.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The pixels that are held: x0, y0, x1, y1, upper ends excluded.
    pub fn crop(&self) -> [u32; 4] {
        self.crop
    }

    /// What is kept of each pixel.
    pub fn layers(&self) -> &Layers {
        &self.layers
    }

    pub(super) fn slot(&self, layer: &str) -> Option<&Slot> {
        self.layers.slot(layer)
    }

    /// Samples per replicate; 0 while the film is empty.
    pub fn replicate(&self) -> u32 {
        self.replicate
    }

    /// The held pixels, row by row.
    pub fn pixels(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let [x0, y0, x1, y1] = self.crop;
        (y0..y1).flat_map(move |y| (x0..x1).map(move |x| [x, y]))
    }

    /// Adds a replicate of the pixels of an area; those without samples have none.
    ///
    /// # Panics
    /// If a pixel with samples lies outside the crop window, the replicate is not as long as those before, or its layers are
    /// others.
    pub fn add(&mut self, replicate: &Replicate) {
        assert_eq!(self.layers, replicate.layers, "replicates of other layers");
        let [x0, y0, x1, _] = replicate.area;
        let width = (x1 - x0).max(1) as usize;
        let Layers { sums: count, squares, .. } = self.layers;
        let estimates: Vec<_> = self.layers.estimates().map(|(slot, square)| (slot.range(), square)).collect();
        for (j, new) in replicate.sums.chunks_exact(count.max(1)).enumerate().filter(|(j, _)| replicate.samples[*j] > 0)
        {
            let samples = replicate.samples[j];
            if self.replicate == 0 {
                self.replicate = samples;
            }
            assert_eq!(self.replicate, samples, "replicates of different length");
            let i = index(self.crop, [x0 + (j % width) as u32, y0 + (j / width) as u32]);
            self.replicates[i] += 1;
            self.met[i] += u64::from(replicate.met[j]);
            let (sums, squares) = (&mut self.sums[i * count..][..count], &mut self.squares[i * squares..][..squares]);
            for (range, square) in &estimates {
                for (q, s) in squares[*square..].iter_mut().zip(&new[range.clone()]) {
                    *q += s * s;
                }
            }
            sums.iter_mut().zip(new).for_each(|(sum, s)| *sum += s);
        }
    }

    /// Adds the sums of `other`: more replicates of the same image, of all its pixels or of a window (a tile).
    pub fn merge(&mut self, other: &Self) -> Result<(), MergeError> {
        let ([w, h], [ow, oh]) = (self.size, other.size);
        let ([x0, y0, x1, y1], [ox0, oy0, ox1, oy1]) = (self.crop, other.crop);
        if self.size != other.size {
            return Err(MergeError::Size(w, h, ow, oh));
        }
        if ox0 < x0 || oy0 < y0 || ox1 > x1 || oy1 > y1 {
            return Err(MergeError::Window(other.crop, self.crop));
        }
        if self.replicate != other.replicate && self.replicate != 0 && other.replicate != 0 {
            return Err(MergeError::Replicate(self.replicate, other.replicate));
        }
        if self.layers != other.layers {
            return Err(MergeError::Layers);
        }
        self.replicate = self.replicate.max(other.replicate);
        let (sums, squares) = (self.layers.sums, self.layers.squares);
        for (j, pixel) in other.pixels().enumerate() {
            let i = index(self.crop, pixel);
            self.replicates[i] += other.replicates[j];
            self.met[i] += other.met[j];
            add(&mut self.sums[i * sums..][..sums], &other.sums[j * sums..][..sums]);
            add(&mut self.squares[i * squares..][..squares], &other.squares[j * squares..][..squares]);
        }
        Ok(())
    }

    /// Samples of pixel (x, y).
    pub fn samples(&self, x: u32, y: u32) -> u64 {
        u64::from(self.replicates(x, y)) * u64::from(self.replicate)
    }

    /// Independent replicates of pixel (x, y).
    pub fn replicates(&self, x: u32, y: u32) -> u32 {
        self.replicates[index(self.crop, [x, y])]
    }

    /// What a layer shows in pixel (x, y), in as many of the channels as it has; 0 without samples. `None` if the film does
    /// not keep it.
    pub fn value(&self, layer: &str, x: u32, y: u32) -> Option<[f64; 3]> {
        Some(self.value_at(self.slot(layer)?, index(self.crop, [x, y])).to_array())
    }

    /// Standard error of [`Self::value`] of an estimate, from the spread of its replicates; `None` of other layers, and
    /// with fewer than two replicates.
    pub fn error(&self, layer: &str, x: u32, y: u32) -> Option<[f64; 3]> {
        Some(self.error_at(self.slot(layer)?, index(self.crop, [x, y]))?.to_array())
    }

    /// Mean radiance of pixel (x, y), RGB; 0 without samples.
    pub fn mean(&self, x: u32, y: u32) -> [f64; 3] {
        self.value(RADIANCE, x, y).unwrap_or_default()
    }

    /// Standard error of [`Self::mean`]; `None` with fewer than two replicates.
    pub fn stderr(&self, x: u32, y: u32) -> Option<[f64; 3]> {
        self.error(RADIANCE, x, y)
    }

    /// Mean radiance of a transport class (an index into [`CLASSES`]); `None` if the film is not split.
    pub fn class_mean(&self, class: usize, x: u32, y: u32) -> Option<[f64; 3]> {
        self.value(CLASSES.get(class)?, x, y)
    }

    /// Standard error of [`Self::class_mean`].
    pub fn class_stderr(&self, class: usize, x: u32, y: u32) -> Option<[f64; 3]> {
        self.error(CLASSES.get(class)?, x, y)
    }

    /// Mean over the pixels of stderr/(mean + 0.01), both of luminance; NaN while a pixel has fewer than two replicates.
    /// The channels' errors are added as if fully correlated, which they nearly are: an upper bound.
    pub fn relative_error(&self) -> f64 {
        const Y: DVec3 = DVec3::new(0.212_672_9, 0.715_152_2, 0.072_175);
        let Some(radiance) = self.slot(RADIANCE) else { return f64::NAN };
        let pixel = |i: usize| {
            let stderr = self.error_at(radiance, i).map_or(f64::NAN, |e| e.dot(Y));
            stderr / (self.value_at(radiance, i).dot(Y) + 0.01)
        };
        (0..self.replicates.len()).map(pixel).sum::<f64>() / self.replicates.len() as f64
    }

    pub(super) fn value_at(&self, slot: &Slot, i: usize) -> DVec3 {
        let (sums, samples) = (&self.sums[i * self.layers.sums..], self.samples_at(i));
        match slot.layer.kind {
            Kind::Estimate | Kind::Mean => three(&sums[slot.range()]) / samples.max(1.0),
            Kind::MeanWhereMet => three(&sums[slot.range()]) / self.met[i].max(1) as f64,
            Kind::Count => DVec3::splat(samples),
        }
    }

    /// Standard error of the mean over R replicates of B samples each, with Q = Σ S²:
    ///
    /// ```text
    /// se² = (Q/B² − R mean²) / (R (R − 1))
    /// ```
    ///
    /// `None` for R < 2. Rounding leaves an error of about 1e-8 of the mean where all replicates are equal.
    pub(super) fn error_at(&self, slot: &Slot, i: usize) -> Option<DVec3> {
        let (r, b) = (f64::from(self.replicates[i]), f64::from(self.replicate));
        let squares = &self.squares[i * self.layers.squares + slot.square?..][..slot.layer.channels.len()];
        let mean = self.value_at(slot, i);
        let variance = (three(squares) / (b * b) - r * mean * mean) / (r * (r - 1.0));
        (r >= 2.0).then(|| variance.max(DVec3::ZERO).map(f64::sqrt))
    }

    fn samples_at(&self, i: usize) -> f64 {
        f64::from(self.replicates[i]) * f64::from(self.replicate)
    }
}

/// The channels of a layer.
fn three(channels: &[f64]) -> DVec3 {
    let channel = |c: usize| channels.get(c).copied().unwrap_or_default();
    DVec3::new(channel(0), channel(1), channel(2))
}

fn add(to: &mut [f64], numbers: &[f64]) {
    to.iter_mut().zip(numbers).for_each(|(sum, x)| *sum += x);
}
