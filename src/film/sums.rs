//! Sums of all pixels over all replicates, and the estimates that follow from them.

use super::Accumulator;
use glam::DVec3;

/// The sums of an image, pixel by pixel: never means, so that adding films is adding numbers, and the error can always be
/// computed. About 130 bytes a pixel, 340 more with transport classes.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    size: [u32; 2],
    crop: [u32; 4],
    /// Samples per replicate, 0 while there is none.
    replicate: u32,
    /// Replicates of each pixel.
    replicates: Vec<u32>,
    hits: Vec<u64>,
    radiance: Vec<RgbSums>,
    alpha: Vec<f64>,
    albedo: Vec<DVec3>,
    normal: Vec<DVec3>,
    depth: Vec<f64>,
    /// Whether radiance is split by transport class.
    split: bool,
    /// Seven a pixel where split.
    transport: Vec<RgbSums>,
}

/// First and second moment of an RGB quantity over replicates, as sums.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct RgbSums {
    /// Σ x = Σ S, with S the sum over one replicate.
    sum: DVec3,
    /// Σ S².
    squares: DVec3,
}

impl RgbSums {
    fn add(&mut self, replicate_sum: DVec3) {
        self.sum += replicate_sum;
        self.squares += replicate_sum * replicate_sum;
    }

    fn merge(&mut self, other: &Self) {
        self.sum += other.sum;
        self.squares += other.squares;
    }

    fn mean(&self, replicates: u32, size: u32) -> DVec3 {
        self.sum / (f64::from(replicates.max(1)) * f64::from(size.max(1)))
    }

    /// Standard error of the mean over R replicates of B samples each, with Q = Σ S²:
    ///
    /// ```text
    /// se² = (Q/B² − R mean²) / (R (R − 1))
    /// ```
    ///
    /// `None` for R < 2. Rounding leaves an error of about 1e-8 of the mean where all replicates are equal.
    fn stderr(&self, replicates: u32, size: u32) -> Option<DVec3> {
        let (r, b) = (f64::from(replicates), f64::from(size));
        let mean = self.mean(replicates, size);
        let variance = (self.squares / (b * b) - r * mean * mean) / (r * (r - 1.0));
        (replicates >= 2).then(|| variance.max(DVec3::ZERO).map(f64::sqrt))
    }
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
    /// Only one of them is split by transport class.
    #[error("only one film is split by transport class")]
    Transport,
}

impl Film {
    /// An empty film for the pixels `crop` (x0, y0, x1, y1, upper ends excluded) of an image of `size` pixels.
    ///
    /// # Panics
    /// If `crop` does not lie inside the image.
    pub fn new(size: [u32; 2], crop: [u32; 4], transport: bool) -> Self {
        let [x0, y0, x1, y1] = crop;
        assert!(x0 <= x1 && x1 <= size[0] && y0 <= y1 && y1 <= size[1], "crop {crop:?} of an image {size:?}");
        let n = (x1 - x0) as usize * (y1 - y0) as usize;
        Self {
            size,
            crop,
            replicate: 0,
            replicates: vec![0; n],
            hits: vec![0; n],
            radiance: vec![RgbSums::default(); n],
            alpha: vec![0.0; n],
            albedo: vec![DVec3::ZERO; n],
            normal: vec![DVec3::ZERO; n],
            depth: vec![0.0; n],
            split: transport,
            transport: vec![RgbSums::default(); if transport { 7 * n } else { 0 }],
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

    /// Whether radiance is split by transport class.
    pub fn has_transport(&self) -> bool {
        self.split
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

    /// Adds a replicate to pixel (x, y) of the whole image.
    ///
    /// # Panics
    /// If the pixel lies outside the crop window, or the replicate is not as long as those before.
    pub fn add_replicate(&mut self, x: u32, y: u32, acc: &Accumulator) {
        if self.replicate == 0 {
            self.replicate = acc.n;
        }
        assert_eq!(self.replicate, acc.n, "replicates of different length");
        let i = self.index(x, y);
        self.replicates[i] += 1;
        self.hits[i] += u64::from(acc.hits);
        self.radiance[i].add(acc.radiance);
        self.alpha[i] += acc.alpha;
        self.albedo[i] += acc.albedo;
        self.normal[i] += acc.normal;
        self.depth[i] += acc.depth;
        if self.split {
            for (class, sum) in acc.transport.iter().enumerate() {
                self.transport[7 * i + class].add(*sum);
            }
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
        if self.split != other.split {
            return Err(MergeError::Transport);
        }
        self.replicate = self.replicate.max(other.replicate);
        for (j, [x, y]) in other.pixels().enumerate() {
            let i = self.index(x, y);
            self.replicates[i] += other.replicates[j];
            self.hits[i] += other.hits[j];
            self.radiance[i].merge(&other.radiance[j]);
            self.alpha[i] += other.alpha[j];
            self.albedo[i] += other.albedo[j];
            self.normal[i] += other.normal[j];
            self.depth[i] += other.depth[j];
            if self.split {
                for class in 0..7 {
                    self.transport[7 * i + class].merge(&other.transport[7 * j + class]);
                }
            }
        }
        Ok(())
    }

    /// Samples of pixel (x, y).
    pub fn samples(&self, x: u32, y: u32) -> u64 {
        u64::from(self.replicates[self.index(x, y)]) * u64::from(self.replicate)
    }

    /// Independent replicates of pixel (x, y).
    pub fn replicates(&self, x: u32, y: u32) -> u32 {
        self.replicates[self.index(x, y)]
    }

    /// Mean radiance of pixel (x, y), RGB; 0 without samples.
    pub fn mean(&self, x: u32, y: u32) -> [f64; 3] {
        let i = self.index(x, y);
        self.radiance[i].mean(self.replicates[i], self.replicate).to_array()
    }

    /// Standard error of [`Self::mean`] from the spread of its replicates; `None` with fewer than two.
    pub fn stderr(&self, x: u32, y: u32) -> Option<[f64; 3]> {
        let i = self.index(x, y);
        self.radiance[i].stderr(self.replicates[i], self.replicate).map(|e| e.to_array())
    }

    /// Mean radiance of a transport class (an index into [`super::CLASSES`]); `None` if the film is not split.
    pub fn class_mean(&self, class: usize, x: u32, y: u32) -> Option<[f64; 3]> {
        let i = self.index(x, y);
        let m = self.transport.get(7 * i..7 * i + 7)?.get(class)?;
        Some(m.mean(self.replicates[i], self.replicate).to_array())
    }

    /// Standard error of [`Self::class_mean`].
    pub fn class_stderr(&self, class: usize, x: u32, y: u32) -> Option<[f64; 3]> {
        let i = self.index(x, y);
        let m = self.transport.get(7 * i..7 * i + 7)?.get(class)?;
        m.stderr(self.replicates[i], self.replicate).map(|e| e.to_array())
    }

    /// Mean share of samples that met a surface.
    pub fn alpha(&self, x: u32, y: u32) -> f64 {
        self.alpha[self.index(x, y)] / self.samples(x, y).max(1) as f64
    }

    /// Mean albedo of the first surface, 0 for samples that met none.
    pub fn albedo(&self, x: u32, y: u32) -> [f64; 3] {
        (self.albedo[self.index(x, y)] / self.samples(x, y).max(1) as f64).to_array()
    }

    /// Mean normal over the samples that met a surface; shorter than 1 where it varies.
    pub fn normal(&self, x: u32, y: u32) -> [f64; 3] {
        let i = self.index(x, y);
        (self.normal[i] / self.hits[i].max(1) as f64).to_array()
    }

    /// Mean distance \[m\] over the samples that met a surface, 0 where none did.
    pub fn depth(&self, x: u32, y: u32) -> f64 {
        let i = self.index(x, y);
        self.depth[i] / self.hits[i].max(1) as f64
    }

    /// Mean over the pixels of stderr/(mean + 0.01), both of luminance; NaN while a pixel has fewer than two replicates.
    /// The channels' errors are added as if fully correlated, which they nearly are: an upper bound.
    pub fn relative_error(&self) -> f64 {
        const Y: DVec3 = DVec3::new(0.212_672_9, 0.715_152_2, 0.072_175);
        let pixel = |(m, &r): (&RgbSums, &u32)| {
            let stderr = m.stderr(r, self.replicate).map_or(f64::NAN, |e| e.dot(Y));
            stderr / (m.mean(r, self.replicate).dot(Y) + 0.01)
        };
        self.radiance.iter().zip(&self.replicates).map(pixel).sum::<f64>() / self.radiance.len() as f64
    }

    fn index(&self, x: u32, y: u32) -> usize {
        let [x0, y0, x1, y1] = self.crop;
        assert!((x0..x1).contains(&x) && (y0..y1).contains(&y), "pixel ({x}, {y}) outside {:?}", self.crop);
        (y - y0) as usize * (x1 - x0) as usize + (x - x0) as usize
    }
}
