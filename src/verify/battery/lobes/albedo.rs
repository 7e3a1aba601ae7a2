//! What a lobe says of its albedo is what its function has.

use super::{any, each, refracts, tables};
use crate::stats::Evidence;
use crate::verify::measure::replicates_each;
use crate::verify::scattering::{Density, Scattering, at_cosine, integrals};
use crate::verify::{Task, Topic};

/// `albedo()` picks lobes and fills the albedo layer of images; it comes from tables, not from the integral.
const TOPIC: Topic = Topic {
    id: "A5",
    title: "albedo() = ∫ f |cos θi| dωi by quadrature, and deltas",
    source: "definition of the directional albedo",
};

pub(super) fn tasks() -> Vec<Task> {
    each(any, |s| {
        Task::new(TOPIC, format!("{}, albedo()", s.name), move |trial, found| {
            // The albedo of rough metals comes from a fit of their Fresnel term, which costs choices and no light.
            let granted = if s.name.starts_with("gold") { GOLD } else { tables(&s) };
            let cosines: &[f64] = if refracts(&s) { &[0.95, 0.5, 0.1, -0.6, -0.05] } else { &[0.95, 0.5, 0.1, 0.02] };
            for &mu in cosines {
                let (wo, trial) = (at_cosine(mu), trial.part(&format!("{mu}")));
                let smooth = integrals(&trial, &s.bsdf, wo);
                let deltas = replicates_each(trial.seed, 256, |u| match Scattering::sample(&s.bsdf, wo, u) {
                    Some(draw) if matches!(draw.density, Density::Discrete(_)) => draw.weight,
                    _ => [0.0; 3],
                });
                let exact = s.bsdf.albedo(wo.as_vec3()).to_rgb().map(f64::from);
                for (k, lane) in ["red", "green", "blue"].into_iter().enumerate() {
                    let (se, dof) = (deltas[k].standard_error(), deltas[k].n() as f64 - 1.0);
                    let (estimate, rounding) = (smooth.albedo[k] + deltas[k].mean(), granted * exact[k] + smooth.error);
                    found.checks.push(
                        format!("cos {mu}, {lane}"),
                        Evidence::Z { exact: exact[k], estimate, se, dof, rounding },
                    );
                }
            }
        })
    })
}

/// Error of the fit.
const GOLD: f64 = 3e-2;
