//! BSDFs: corners of numbers, the choice among lobes, and materials. Their closed forms are rows of `verify::battery`.

mod consistency;
mod material;
mod mixture;
mod optics;

use radianza::bsdf::{Bsdf, Transport};
use radianza::glam::Vec3;
use radianza::stats::Moments;
use radianza::verify::measure;

/// Direction of cosine `mu` to the normal, in some general azimuth.
fn at_cosine(mu: f32) -> Vec3 {
    let r = (1.0 - mu * mu).max(0.0).sqrt();
    Vec3::new(0.8 * r, 0.6 * r, mu)
}

/// Means of `f(uc, u)` over independent replicates.
fn replicates(seed: u64, points: u64, f: impl Fn(f32, [f32; 2]) -> f64) -> Moments {
    measure::replicates(seed, points, |[uc, u, v]: [f32; 3]| f(uc, [u, v]))
}

/// Directional albedo of one lane by sampling, importance transport: energy out per energy in.
fn sampled_albedo(bsdf: &Bsdf, wo: Vec3, lane: usize, points: u64) -> Moments {
    replicates(7, points, |uc, u| {
        bsdf.sample(wo, uc, u, Transport::Importance).map_or(0.0, |s| f64::from(s.weight.0[lane]))
    })
}
