//! The density is the law of the draws.

use super::bins::Bins;
use super::{Density, Rgb, Scattering};
use crate::sampler::{Kind, Sampler};
use crate::stats::{Evidence, chi2_test};
use crate::verify::{Exhibit, Findings, HeatMap, Trial};
use glam::DVec3;

/// Integrals over the sphere of what has a density, by quadrature.
#[derive(Clone, Copy, Debug)]
pub struct Integrals {
    /// ∫ pdf dωi: what is left of 1 are deltas and failures.
    pub pdf: f64,
    /// ∫ f |cos θi| dωi: the directional albedo without deltas.
    pub albedo: Rgb,
    /// What is known of their error.
    pub error: f64,
}

/// What is granted to quadrature beyond the error it sees.
const QUADRATURE: f64 = 1e-4;

/// Independent numbers for a draw.
fn numbers(seed: u64, stream: u32, i: u64) -> [f32; 3] {
    let mut s = Sampler::new(Kind::Independent, seed, [stream, 0], i, 1);
    let [u, v] = s.next_2d();
    [s.next_1d(), u, v]
}

/// χ² of draws towards `wo` against the integrals of `pdf` over bins that follow a pilot run, and
/// ∫ pdf + P(delta) + P(failure) = 1. Returns the integrals, which are worth more than this.
pub fn density(found: &mut Findings, trial: &Trial, name: &str, s: &impl Scattering, wo: DVec3) -> Integrals {
    let draw = |stream, i| {
        let draw = s.sample(wo, numbers(trial.seed, stream, i))?;
        matches!(draw.density, Density::SolidAngle(_)).then_some(draw.wi)
    };
    let pilot: Vec<DVec3> = (0..20_000).filter_map(|i| draw(0, i)).collect();
    let sides = [1.0, -1.0].map(|side| Bins::new(side, &pilot));
    let integrals = sides.each_ref().map(|bins| {
        bins.integrate(|wi| {
            let (f, pdf) = s.both(wo, wi);
            let cos = wi.z.abs();
            [pdf, f[0] * cos, f[1] * cos, f[2] * cos]
        })
    });

    let n: u64 = trial.pick(100_000, 1_000_000);
    let mut observed = sides.each_ref().map(|bins| vec![0.0; bins.len()]);
    let mut others = 0.0;
    for i in 0..n {
        let place = draw(1, i).and_then(|wi| (0..2).find_map(|k| sides[k].find(wi).map(|bin| (k, bin))));
        match place {
            Some((k, bin)) => observed[k][bin] += 1.0,
            None => others += 1.0,
        }
    }

    // ∫ pdf against the share of the draws that have a density: a binomial one.
    let sum = |k: usize| integrals.iter().flat_map(|(values, _)| values).map(|v| v[k]).sum::<f64>();
    let error = integrals.iter().map(|(_, error)| error).sum::<f64>();
    let pdf = sum(0);
    let share = others / n as f64;
    let se = (share * (1.0 - share) / n as f64).sqrt();
    let rounding = QUADRATURE + 0.1 * error;
    found.checks.push(
        format!("{name}: ∫ pdf + deltas + failures"),
        Evidence::Z { exact: 1.0, estimate: pdf + share, se, dof: f64::INFINITY, rounding },
    );

    // The shape, with the bin of all that has no density.
    let mut expected =
        integrals.each_ref().map(|(values, _)| values.iter().map(|v| v[0] * n as f64).collect::<Vec<_>>());
    let (mut all, mut promised) = (observed.concat(), expected.concat());
    if others > 1e-4 * n as f64 {
        all.push(others);
        promised.push((n as f64 * (1.0 - pdf)).max(0.0));
    }
    let total: f64 = promised.iter().sum();
    if (total / n as f64 - 1.0).abs() <= rounding {
        // What quadrature got wrong is no fault of the shape.
        promised.iter_mut().for_each(|e| *e *= n as f64 / total);
    }
    found.checks.chi2(format!("{name}: χ²"), chi2_test(&all, &promised, 5.0));
    for (k, side) in ["", " below"].into_iter().enumerate() {
        let (observed, expected) = (std::mem::take(&mut observed[k]), std::mem::take(&mut expected[k]));
        if let Some(columns) = sides[k].width().filter(|_| expected.iter().sum::<f64>() > 1e-3 * n as f64) {
            let title = format!("{name}{side}");
            let axes = ["azimuth, quantiles", "cos θ, quantiles"];
            found.exhibits.push(Exhibit::HeatMap(HeatMap { title, axes, columns, observed, expected }));
        }
    }
    Integrals { pdf, albedo: [sum(1), sum(2), sum(3)], error: rounding }
}
