//! Sums over samples, before layers select from them.

use super::PixelSample;
use super::layer::{ByClass, CLASSES};
use glam::Vec4;

/// Sums over samples of all that a sample has.
#[derive(Clone, Debug, Default)]
pub(super) struct SampleSums {
    pub(super) radiance: [f64; 3],
    pub(super) alpha: f64,
    pub(super) albedo: [f64; 3],
    pub(super) normal: [f64; 3],
    pub(super) depth: f64,
    pub(super) classes: [[f64; 3]; CLASSES.len()],
}

impl SampleSums {
    /// One sample.
    pub(super) fn of(sample: &PixelSample, classes: &ByClass) -> Self {
        let mut one = Self::default();
        one.add(sample, classes, true);
        one
    }

    /// Adds a sample; `split` says whether its classes count.
    #[inline(always)]
    pub(super) fn add(&mut self, sample: &PixelSample, classes: &ByClass, split: bool) {
        let PixelSample { radiance, alpha, albedo, normal, depth } = sample;
        add(&mut self.radiance, radiance.to_rgb());
        add(&mut self.albedo, albedo.to_rgb());
        add(&mut self.normal, normal.to_array());
        self.alpha += f64::from(*alpha);
        self.depth += f64::from(*depth);
        if split {
            self.classes.iter_mut().zip(classes).for_each(|(sum, class)| add(sum, class.to_rgb()));
        }
    }
}

#[inline(always)]
fn add(sum: &mut [f64; 3], values: [f32; 3]) {
    for c in 0..3 {
        sum[c] += f64::from(values[c]);
    }
}

/// Whether all values of a sample are finite, and none is negative but in its normal and classes: then no layer has to look.
#[inline(always)]
pub(super) fn is_plain(sample: &PixelSample, classes: &ByClass, split: bool) -> bool {
    let within = |v: Vec4, least: f32| v.cmpge(Vec4::splat(least)) & v.cmple(Vec4::MAX);
    let PixelSample { radiance, alpha, albedo, normal, depth } = sample;
    let rest = Vec4::new(*alpha, *depth, 0.0, 0.0);
    let positive = within(radiance.0, 0.0) & within(albedo.0, 0.0) & within(rest, 0.0);
    (positive & within(normal.extend(0.0), f32::MIN)).all()
        && (!split || classes.iter().all(|class| within(class.0, f32::MIN).all()))
}
