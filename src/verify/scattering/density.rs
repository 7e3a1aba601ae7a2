//! The density is the law of the draws.

use super::bins::Bins;
use super::{Density, Rgb, Scattering};
use crate::sampler::{Kind, Sampler};
use crate::stats::{Evidence, chi2_test};
use crate::verify::measure::to_detect_each;
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

impl Integrals {
    /// Of something that sends on all that arrives, where nothing was integrated: a scale for relative errors.
    pub const WHITE: Self = Self { pdf: 1.0, albedo: [1.0; 3], error: 0.0 };
}

/// What is granted to quadrature beyond the error it sees: specular ridges that a mixture seldom draws.
const QUADRATURE: f64 = 2.5e-4;

/// Draws that bins and cells are made from.
const PILOT: u64 = 30_000;

/// What has a density towards `wo`: bins on both sides of the surface, and the integrals over them.
struct Cells {
    sides: [Bins; 2],
    /// pdf, and f |cos θ| by lanes.
    values: [Vec<[f64; 4]>; 2],
    error: f64,
}

impl Cells {
    fn new(trial: &Trial, s: &impl Scattering, wo: DVec3, pilot: u64) -> Self {
        let directions: Vec<DVec3> = (0..pilot).filter_map(|i| draw(trial, s, wo, 0, i)).collect();
        let sides = [1.0, -1.0].map(|side| Bins::new(side, &directions, pilot));
        let integrals = sides.each_ref().map(|bins| {
            bins.integrate(|wi| {
                let (f, pdf) = s.both(wo, wi);
                let cos = wi.z.abs();
                [pdf, f[0] * cos, f[1] * cos, f[2] * cos]
            })
        });
        let error = QUADRATURE + 0.5 * integrals.iter().map(|(_, error)| error).sum::<f64>();
        Self { sides, values: integrals.map(|(values, _)| values), error }
    }

    fn integrals(&self) -> Integrals {
        let sum = |k: usize| self.values.iter().flatten().map(|v| v[k]).sum::<f64>();
        Integrals { pdf: sum(0), albedo: [sum(1), sum(2), sum(3)], error: self.error }
    }
}

/// Direction of the `i`-th draw, where it has a density.
fn draw(trial: &Trial, s: &impl Scattering, wo: DVec3, stream: u32, i: u64) -> Option<DVec3> {
    let mut u = Sampler::new(Kind::Independent, trial.seed, [stream, 0], i, 1);
    let [a, b] = u.next_2d();
    let draw = s.sample(wo, [u.next_1d(), a, b])?;
    matches!(draw.density, Density::SolidAngle(_)).then_some(draw.wi)
}

/// ∫ pdf and ∫ f |cos| towards `wo`, in cells that follow a pilot run of draws.
pub fn integrals(trial: &Trial, s: &impl Scattering, wo: DVec3) -> Integrals {
    Cells::new(trial, s, wo, PILOT).integrals()
}

/// χ² of draws towards `wo` against the integrals of `pdf` over bins that follow a pilot run, and
/// ∫ pdf + P(delta) + P(failure) = 1. Returns the integrals.
pub fn density(found: &mut Findings, trial: &Trial, name: &str, s: &impl Scattering, wo: DVec3) -> Integrals {
    let cells = Cells::new(trial, s, wo, PILOT);
    let (sides, integrals) = (&cells.sides, cells.integrals());

    // Count the draws; deltas, failures and whatever lies in the surface are the others.
    let n: u64 = trial.work(60_000, 1_000_000);
    let mut observed = sides.each_ref().map(|bins| vec![0.0; bins.len()]);
    let mut others = 0.0;
    for i in 0..n {
        let place = draw(trial, s, wo, 1, i).and_then(|wi| (0..2).find_map(|k| sides[k].find(wi).map(|bin| (k, bin))));
        match place {
            Some((k, bin)) => observed[k][bin] += 1.0,
            None => others += 1.0,
        }
    }

    // ∫ pdf against the share of the unit cube that leads to deltas or nowhere.
    let n = n as f64;
    let [lost] = to_detect_each(trial, [1.0], 4e-3, trial.work(1 << 11, 1 << 14), |u| {
        let continuous = s.sample(wo, u).is_some_and(|draw| matches!(draw.density, Density::SolidAngle(_)));
        [f64::from(!continuous)]
    });
    let (se, dof) = (lost.standard_error(), lost.n() as f64 - 1.0);
    let estimate = integrals.pdf + lost.mean();
    let evidence = Evidence::Z { exact: 1.0, estimate, se, dof, rounding: integrals.error };
    found.checks.push(format!("{name}: ∫ pdf + deltas + failures"), evidence);

    // The shape, with a bin of all that has no density where quadrature tells their number better than chance does (what
    // it gets wrong of a few failures is the matter of the sum above); nor is its error of the whole a fault of the shape.
    let expected = cells.values.each_ref().map(|values| values.iter().map(|v| v[0] * n).collect::<Vec<_>>());
    let (mut all, mut promised) = (observed.concat(), expected.concat());
    if integrals.error * n < 0.3 * f64::sqrt(others) {
        all.push(others);
        promised.push((n * (1.0 - integrals.pdf)).max(0.0));
    }
    let ratio = promised.iter().sum::<f64>() / all.iter().sum::<f64>();
    if (ratio - 1.0).abs() <= integrals.error {
        promised.iter_mut().for_each(|e| *e /= ratio);
    }
    found.checks.chi2(format!("{name}: χ²"), chi2_test(&all, &promised, 5.0));
    for ((side, bins), (observed, expected)) in
        ["", ", below"].iter().zip(sides).zip(observed.into_iter().zip(expected))
    {
        if let Some(columns) = bins.width().filter(|_| expected.iter().sum::<f64>() > 1e-3 * n) {
            let (title, axes) = (format!("{name}{side}"), ["azimuth, quantiles", "cos θ, quantiles"]);
            found.exhibits.push(Exhibit::HeatMap(HeatMap { title, axes, columns, observed, expected }));
        }
    }
    integrals
}
