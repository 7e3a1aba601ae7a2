//! The density is the law: χ² of `sample` against the integral of `eval().pdf` over bins of (cos θ, φ).

use crate::{at_cosine, solid_angle};
use radianza::bsdf::{Bsdf, Transport, specimens};
use radianza::glam::Vec3;
use radianza::sampler::{Kind, Sampler};
use radianza::stats::{Family, chi2_test};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

const N_COS: usize = 16;
const N_PHI: usize = 16;
const SAMPLES: u64 = 100_000;

/// Gauss–Legendre on [−1, 1], 5 nodes.
const NODES: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// ∫∫ f over the rectangle, cut in four where the whole and its parts disagree.
fn integrate(
    f: &impl Fn(f64, f64) -> f64,
    [x0, x1]: [f64; 2],
    [y0, y1]: [f64; 2],
    whole: Option<f64>,
    depth: u32,
) -> f64 {
    let rule = |[x0, x1]: [f64; 2], [y0, y1]: [f64; 2]| {
        let (cx, hx, cy, hy) = (0.5 * (x0 + x1), 0.5 * (x1 - x0), 0.5 * (y0 + y1), 0.5 * (y1 - y0));
        let sum: f64 = NODES
            .iter()
            .flat_map(|a| NODES.iter().map(move |b| (a, b)))
            .map(|(a, b)| a.1 * b.1 * f(cx + hx * a.0, cy + hy * b.0))
            .sum();
        sum * hx * hy
    };
    let (mx, my) = (0.5 * (x0 + x1), 0.5 * (y0 + y1));
    let quarters = [([x0, mx], [y0, my]), ([mx, x1], [y0, my]), ([x0, mx], [my, y1]), ([mx, x1], [my, y1])];
    let parts = quarters.map(|(x, y)| rule(x, y));
    let sum: f64 = parts.iter().sum();
    let before = whole.unwrap_or_else(|| rule([x0, x1], [y0, y1]));
    if depth >= 2 && ((sum - before).abs() < 1e-6 || depth > 9) {
        return sum;
    }
    quarters.iter().zip(parts).map(|(&(x, y), part)| integrate(f, x, y, Some(part), depth + 1)).sum()
}

fn test(bsdf: &Bsdf, wo: Vec3, seed: u64) -> radianza::stats::Chi2 {
    let mut observed = vec![0.0; N_COS * N_PHI + 1];
    for i in 0..SAMPLES {
        let mut s = Sampler::new(Kind::Independent, seed, [1, 2], i, 1);
        let (uc, u) = (s.next_1d(), s.next_2d());
        // Deltas and failures share the last bin.
        let sample = bsdf.sample(wo, uc, u, Transport::Radiance).filter(|s| solid_angle(s).is_some());
        let bin = sample.map_or(N_COS * N_PHI, |s| {
            let cos = ((f64::from(s.wi.z) * 0.5 + 0.5) * N_COS as f64) as usize;
            let phi = (f64::from(s.wi.y).atan2(f64::from(s.wi.x)) / TAU + 0.5) * N_PHI as f64;
            cos.min(N_COS - 1) * N_PHI + (phi as usize).min(N_PHI - 1)
        });
        observed[bin] += 1.0;
    }
    let pdf = |cos: f64, phi: f64| {
        let r = (1.0 - cos * cos).max(0.0).sqrt();
        let wi = Vec3::new((r * phi.cos()) as f32, (r * phi.sin()) as f32, cos as f32);
        f64::from(bsdf.eval(wo, wi, Transport::Radiance).pdf)
    };
    let mut expected: Vec<f64> = (0..N_COS * N_PHI)
        .map(|bin| {
            let (i, j) = ((bin / N_PHI) as f64, (bin % N_PHI) as f64);
            let cos = [2.0 * i / N_COS as f64 - 1.0, 2.0 * (i + 1.0) / N_COS as f64 - 1.0];
            let phi = [TAU * j / N_PHI as f64 - PI, TAU * (j + 1.0) / N_PHI as f64 - PI];
            SAMPLES as f64 * integrate(&pdf, cos, phi, None, 0)
        })
        .collect();
    // ∫ pdf + P(delta) + P(failure) = 1.
    let rest = SAMPLES as f64 - expected.iter().sum::<f64>();
    assert!(rest > -2e-4 * SAMPLES as f64, "∫ pdf = {}", 1.0 - rest / SAMPLES as f64);
    expected.push(rest.max(0.0));
    if expected[N_COS * N_PHI] < 1e-4 * SAMPLES as f64 && observed[N_COS * N_PHI] < 1e-4 * SAMPLES as f64 {
        // Nothing but the error of the integral: not a bin.
        observed.pop();
        expected.pop();
    }
    chi2_test(&observed, &expected, 5.0)
}

#[test]
fn samples_follow_their_density() {
    let mut family = Family::new("χ² of all specimens");
    let all = specimens();
    // Lobes narrower than 1/100 of a bin are beyond this quadrature; they are the same code at another α.
    let cases: Vec<_> = all
        .iter()
        .filter(|s| s.bsdf.has_smooth() && !s.name.contains("0.002"))
        .flat_map(|s| [0.97, 0.6, 0.15, -0.8, -0.3].map(|mu| (s, mu)))
        .collect();
    let tests: Vec<_> = cases.par_iter().map(|(s, mu)| test(&s.bsdf, at_cosine(*mu), 11)).collect();
    for ((s, mu), test) in cases.iter().zip(tests) {
        family.chi2(format!("{} μ {mu} ({} bins)", s.name, test.dof + 1), test);
    }
    family.assert();
}
