//! All questions at once.

use super::{Claims, Rgb, Scattering, at_cosine, density, draws, energy, reciprocity, reverse, sampled};
use crate::verify::{Curve, Exhibit, Findings, Trial};

/// Cosines of the angles that are looked at, from normal to grazing.
const COSINES: [f64; 6] = [0.97, 0.7, 0.4, 0.15, 0.05, 0.01];

/// Everything that must hold of a scattering function, at angles from normal to grazing: identities of its draws,
/// reciprocity, χ², ∫ pdf = 1, energy; with heat maps, the curve of its albedo, and a verdict in words.
pub fn check(found: &mut Findings, trial: &Trial, name: &str, s: &impl Scattering, claims: &Claims) {
    if claims.reciprocal {
        reciprocity(found, trial, name, s, claims);
    }
    for side in [1.0, -1.0].into_iter().take(if claims.two_sided { 2 } else { 1 }) {
        let below = if side < 0.0 { ", from below" } else { "" };
        let mut albedos = Vec::new();
        for mu in COSINES {
            let (wo, at) = (at_cosine(side * mu), format!("{name}, cos {}", side * mu));
            let trial = &trial.part(&at);
            draws(found, trial, &at, s, wo, claims.rounding);
            reverse(found, trial, &at, s, wo, claims.rounding);
            let integrals = density(found, trial, &at, s, wo);
            let aim = if claims.lossless { 1e-3 } else { 5e-3 };
            let sampled = sampled(trial, s, wo, &integrals, aim, trial.work(1 << 12, 1 << 16));
            let albedo = energy(found, &at, claims, &integrals, &sampled);
            albedos.push((mu, albedo, sampled.all.map(|m| m.standard_error())));
        }
        found.words.push(verdict(&format!("{name}{below}"), &albedos));
        let line = |k: usize| albedos.iter().rev().map(|(mu, a, se)| [*mu, a[k], se[k]]).collect();
        let lines = ["red", "green", "blue"].into_iter().enumerate().map(|(k, lane)| (lane.into(), line(k))).collect();
        let title = format!("albedo of {name}{below}");
        found.exhibits.push(Exhibit::Curve(Curve { title, axes: ["cos θ", "directional albedo"], lines }));
    }
}

/// "gold: reflects 0.61 to 0.94, least at cos 0.1".
fn verdict(name: &str, albedos: &[(f64, Rgb, Rgb)]) -> String {
    let values = || albedos.iter().flat_map(|(mu, a, _)| a.iter().map(move |&a| (a, *mu)));
    let low = values().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default();
    let high = values().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default();
    if high.0 - low.0 < 1e-3 {
        return format!("{name}: sends on {:.4} of the light at every angle", high.0);
    }
    let of = |(a, mu): (f64, f64)| format!("{a:.4} of the light at cos {mu}");
    format!("{name}: sends on at least {}, at most {}", of(low), of(high))
}
