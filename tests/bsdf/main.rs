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
use radianza::warp::ONE_MINUS_EPSILON;

/// Direction of cosine `mu` to the normal, in some general azimuth.
fn at_cosine(mu: f32) -> Vec3 {
    let r = (1.0 - mu * mu).max(0.0).sqrt();
    Vec3::new(0.8 * r, 0.6 * r, mu)
}

/// Means of `f(uc, u)` over independent replicates: randomly shifted Kronecker points in three dimensions, which fill the
/// cube evenly together, where padded Sobol points do so only in pairs (Roberts 2018; Cranley & Patterson 1976).
fn replicates(seed: u64, n: u64, points: u64, mut f: impl FnMut(f32, [f32; 2]) -> f64) -> Moments {
    // Powers of the inverse of the root of x⁴ = x + 1.
    const STEP: [f64; 3] = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3];
    let mut mean = |replicate: u64| {
        let mut s = Sampler::new(Kind::Independent, seed, [0, 0], replicate, 1);
        let shift = [s.next_1d(), s.next_1d(), s.next_1d()].map(f64::from);
        let one = |i: u64| {
            let [uc, u, v]: [f32; 3] =
                std::array::from_fn(|k| ((shift[k] + i as f64 * STEP[k]).fract() as f32).min(ONE_MINUS_EPSILON));
            f(uc, [u, v])
        };
        (0..points).map(one).sum::<f64>() / points as f64
    };
    (0..n).map(&mut mean).collect()
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
