//! How much of the light that arrives leaves again.

use super::density::Integrals;
use super::{Claims, Density, Rgb, Scattering};
use crate::stats::{Evidence, Moments};
use crate::verify::measure::to_detect_each;
use crate::verify::{Findings, Trial};
use glam::DVec3;

/// Directional albedo by sampling.
#[derive(Clone, Copy, Debug)]
pub struct Sampled {
    /// Of all draws.
    pub all: [Moments; 3],
    /// Of those that have a density.
    pub continuous: [Moments; 3],
    /// Of deltas.
    pub deltas: [Moments; 3],
}

/// Names of the lanes that differ; one without a name where all are alike.
fn lanes(of: &[Moments; 3]) -> impl Iterator<Item = (usize, &'static str)> {
    let grey = of[0] == of[1] && of[1] == of[2];
    [(0, if grey { "" } else { ", red" }), (1, ", green"), (2, ", blue")].into_iter().take(if grey { 1 } else { 3 })
}

/// E\[weight\] of draws towards `wo`, with as many as it takes to detect a relative bias of `aim`, at most `most` in
/// each replicate. How large the albedo is comes from quadrature.
pub fn sampled(trial: &Trial, s: &impl Scattering, wo: DVec3, integrals: &Integrals, aim: f64, most: u64) -> Sampled {
    // Less than a hundredth of the light is not worth the work; nor are deltas beside the whole.
    let [r, g, b] = integrals.albedo.map(|a| if a > 0.0 { a.max(0.01) } else { 1.0 });
    let m: [Moments; 9] = to_detect_each(trial, [r, g, b, r, g, b, 1.0, 1.0, 1.0], aim, most, |u| {
        let Some(draw) = s.sample(wo, u) else { return [0.0; 9] };
        let [r, g, b] = draw.weight;
        match draw.density {
            Density::SolidAngle(_) => [r, g, b, r, g, b, 0.0, 0.0, 0.0],
            Density::Discrete(_) => [r, g, b, 0.0, 0.0, 0.0, r, g, b],
        }
    });
    Sampled { all: [m[0], m[1], m[2]], continuous: [m[3], m[4], m[5]], deltas: [m[6], m[7], m[8]] }
}

/// The albedo towards `wo` is at most 1, or is 1 where that is claimed: by quadrature, by sampling; and the two agree.
/// Relative errors of `claims.granted` are granted. Returns the albedo.
pub fn energy(found: &mut Findings, name: &str, claims: &Claims, integrals: &Integrals, sampled: &Sampled) -> Rgb {
    let granted = claims.granted;
    // Quadrature, and what deltas add to it.
    for (k, lane) in lanes(&sampled.all) {
        let deltas = &sampled.deltas[k];
        let estimate = integrals.albedo[k] + deltas.mean();
        let exact = if claims.lossless { 1.0 } else { estimate.min(1.0) };
        let (se, dof) = (deltas.standard_error(), deltas.n() as f64 - 1.0);
        let rounding = (granted + integrals.error) * exact;
        let evidence = Evidence::Z { exact, estimate, se, dof, rounding };
        let sign = if claims.lossless { "=" } else { "≤" };
        found.checks.push(format!("{name}: albedo {sign} 1 by quadrature{lane}"), evidence);
    }
    for (k, lane) in lanes(&sampled.all) {
        let all = &sampled.all[k];
        if claims.lossless {
            found.checks.replicated(format!("{name}: albedo = 1 by sampling{lane}"), 1.0, all, granted);
        } else {
            found.checks.push(format!("{name}: albedo ≤ 1 by sampling{lane}"), Evidence::at_most(1.0, all, granted));
        }
    }
    for (k, lane) in lanes(&sampled.continuous) {
        let exact = integrals.albedo[k];
        if exact > 0.0 || sampled.continuous[k].mean() > 0.0 {
            let (all, rounding) = (&sampled.continuous[k], integrals.error);
            found.checks.replicated(format!("{name}: sampling and quadrature agree{lane}"), exact, all, rounding);
        }
    }
    sampled.all.each_ref().map(Moments::mean)
}
