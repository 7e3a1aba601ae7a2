//! BSDFs against closed forms, by the rules of evidence: hypothesis tests with known power, not tolerances.

mod consistency;
mod density;
mod energy;
mod fresnel;
mod material;
mod microfacets;
mod mixture;
mod reciprocity;

use radianza::bsdf::{Bsdf, Pdf, Sample, Transport};
use radianza::glam::Vec3;
use radianza::sampler::{Kind, Sampler};
use radianza::stats::Moments;

/// Direction of cosine `mu` to the normal, in some general azimuth.
fn at_cosine(mu: f32) -> Vec3 {
    let r = (1.0 - mu * mu).max(0.0).sqrt();
    Vec3::new(0.8 * r, 0.6 * r, mu)
}

/// Means of `f(uc, u)` over independent replicates of Owen-scrambled Sobol points.
fn replicates(seed: u64, n: u64, points: u64, mut f: impl FnMut(f32, [f32; 2]) -> f64) -> Moments {
    let mean = |replicate: u64, f: &mut dyn FnMut(f32, [f32; 2]) -> f64| {
        let one = |i: u64| {
            let mut s = Sampler::new(Kind::Sobol, seed, [0, 0], replicate * points + i, points as u32);
            let uc = s.next_1d();
            f(uc, s.next_2d())
        };
        (0..points).map(one).sum::<f64>() / points as f64
    };
    (0..n).map(|replicate| mean(replicate, &mut f)).collect()
}

/// Directional albedo of one lane by sampling, importance transport: energy out per energy in.
fn sampled_albedo(bsdf: &Bsdf, wo: Vec3, lane: usize, n: u64, points: u64) -> Moments {
    replicates(7, n, points, |uc, u| {
        bsdf.sample(wo, uc, u, Transport::Importance).map_or(0.0, |s| f64::from(s.weight.0[lane]))
    })
}

/// The density of a non-delta sample.
fn solid_angle(sample: &Sample) -> Option<f32> {
    match sample.pdf {
        Pdf::SolidAngle(pdf) => Some(pdf),
        Pdf::Discrete(_) => None,
    }
}
