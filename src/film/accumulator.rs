//! Sums of one pixel over one replicate.

use super::PixelSample;
use crate::spectrum::Spectrum;
use glam::DVec3;

/// Names of the transport classes, by the last two reflections before the eye, in the order of
/// [`Accumulator::add_transport`]. SD: specular, then diffuse, then the eye: a caustic.
pub const CLASSES: [&str; 7] = ["emission", "D", "S", "DD", "SD", "DS", "SS"];

/// f64 sums of one pixel over one replicate: a run of consecutive sample indices that share one randomisation, which is
/// independent of that of every other replicate. Only sums of whole replicates may be squared for the error: samples
/// inside one are correlated on purpose.
#[derive(Clone, Copy, Debug, Default)]
pub struct Accumulator {
    /// Samples.
    pub(super) n: u32,
    /// Samples that met a surface.
    pub(super) hits: u32,
    /// Σ radiance, RGB.
    pub(super) radiance: DVec3,
    /// Σ alpha.
    pub(super) alpha: f64,
    /// Σ albedo, RGB.
    pub(super) albedo: DVec3,
    /// Σ normal.
    pub(super) normal: DVec3,
    /// Σ depth.
    pub(super) depth: f64,
    /// Σ radiance of each transport class, RGB.
    pub(super) transport: [DVec3; 7],
}

/// A value of a sample that is not finite, or negative where nothing is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Invalid {
    /// The layer of the film that it was meant for.
    pub layer: &'static str,
    /// What came.
    pub value: [f32; 3],
}

impl Accumulator {
    /// Adds one sample. What is no number, or is negative radiance or distance, counts as 0, so that one sample cannot take
    /// the pixel with it; the first such value is returned.
    #[inline]
    pub fn add(&mut self, s: &PixelSample) -> Option<Invalid> {
        let mut invalid = None;
        let mut checked = |layer, value: [f32; 3], signed: bool| {
            if value.iter().all(|x| x.is_finite() && (signed || *x >= 0.0)) {
                return value.map(f64::from);
            }
            invalid = invalid.or(Some(Invalid { layer, value }));
            [0.0; 3]
        };
        self.n += 1;
        self.radiance += DVec3::from(checked("beauty", s.radiance.to_rgb(), false));
        self.alpha += checked("alpha", [s.alpha; 3], false)[0];
        self.albedo += DVec3::from(checked("albedo", s.albedo.to_rgb(), false));
        self.normal += DVec3::from(checked("normal", s.normal.to_array(), true));
        self.depth += checked("depth", [s.depth; 3], false)[0];
        self.hits += u32::from(s.alpha != 0.0);
        invalid
    }

    /// Adds the radiance of one sample split by [`CLASSES`].
    #[inline]
    pub fn add_transport(&mut self, classes: &[Spectrum; 7]) {
        for (sum, x) in self.transport.iter_mut().zip(classes) {
            *sum += DVec3::from(x.to_rgb().map(f64::from));
        }
    }
}
