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

impl Accumulator {
    /// Adds one sample. Its numbers must be finite: whoever takes samples counts the others and adds zeros.
    #[inline]
    pub fn add(&mut self, s: &PixelSample) {
        self.n += 1;
        self.hits += u32::from(s.depth > 0.0);
        self.radiance += DVec3::from(s.radiance.to_rgb().map(f64::from));
        self.alpha += f64::from(s.alpha);
        self.albedo += DVec3::from(s.albedo.to_rgb().map(f64::from));
        self.normal += s.normal.as_dvec3();
        self.depth += f64::from(s.depth);
    }

    /// Adds the radiance of one sample split by [`CLASSES`].
    #[inline]
    pub fn add_transport(&mut self, classes: &[Spectrum; 7]) {
        for (sum, x) in self.transport.iter_mut().zip(classes) {
            *sum += DVec3::from(x.to_rgb().map(f64::from));
        }
    }
}
