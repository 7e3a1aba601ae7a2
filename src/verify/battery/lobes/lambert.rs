//! A1: directional albedo of Lambert's lobe, and the ladder of estimators.

use super::each;
use crate::bsdf::{Bsdf, Specimen, Transport};
use crate::verify::measure::to_detect;
use crate::verify::scattering::{at_cosine, integrals, sampled};
use crate::verify::{Task, Topic, Trial};
use crate::warp;
use glam::{DVec3, Vec3};
use std::f64::consts::{FRAC_1_PI, PI};

/// ρ_d = ∫ f cos θi dωi = π f of a constant f, from every direction.
const TOPIC: Topic = Topic {
    id: "A1",
    title: "directional albedo of Lambert ρ = π f; uniform, cosine and BSDF sampling estimate the same integral",
    source: "Lambert 1760; Kajiya 1986, hemisphere form",
};

pub(super) fn tasks() -> Vec<Task> {
    each(broad, |s| {
        Task::new(TOPIC, s.name.clone(), move |trial, found| {
            let lambert = s.name.starts_with("lambert");
            let cosines: &[f64] = match (lambert, s.refracts) {
                (true, _) => &[1.0, 0.6, 0.1, 1e-3, -0.7],
                (false, true) => trial.pick(&[0.6, -0.5], &[0.9, 0.3, -0.2, -0.5, -0.9]),
                (false, false) => trial.pick(&[0.6], &[0.9, 0.6, 0.2, -0.5]),
            };
            for &mu in cosines {
                let (wo, trial) = (at_cosine(mu), &trial.part(&format!("{mu}")));
                for lane in if lambert { 0..3 } else { 1..2 } {
                    let (exact, error) = if lambert {
                        // π times f of one pair.
                        let f = s.bsdf.eval(
                            wo.as_vec3(),
                            Vec3::new(0.0, 0.0, 1f32.copysign(mu as f32)),
                            Transport::Importance,
                        );
                        (PI * f64::from(f.f.0[lane]), 1e-6)
                    } else {
                        let integrals = integrals(trial, &*s.bsdf, wo);
                        (integrals.albedo[lane], integrals.error)
                    };
                    let granted = error / exact;
                    let at = format!("cos {mu}, lane {lane}");
                    let most = trial.work(1 << 12, 1 << 16);
                    let uniform = hemispheres(trial, &s.bsdf, wo, lane, exact, most, |u| {
                        (warp::uniform_hemisphere(u), 0.5 * FRAC_1_PI)
                    });
                    found.checks.replicated(format!("{at}, uniform"), exact, &uniform, granted);
                    let cosine = hemispheres(trial, &s.bsdf, wo, lane, exact, most, |u| {
                        let w = warp::cosine_hemisphere(u);
                        (w, f64::from(w.z) * FRAC_1_PI)
                    });
                    found.checks.replicated(format!("{at}, cosine"), exact, &cosine, granted);
                    if lambert {
                        let integrals = integrals(trial, &*s.bsdf, wo);
                        let own = sampled(trial, &*s.bsdf, wo, &integrals, 1e-3, most).continuous[lane];
                        found.checks.replicated(format!("{at}, by the BSDF"), exact, &own, granted);
                    }
                }
            }
        })
    })
}

/// Broad enough for directions that know nothing of the lobe.
fn broad(s: &Specimen) -> bool {
    !s.sharp && !s.deltas
}

/// ∫ f |cos θ| dω over both hemispheres, by directions of the upper one and their images below.
fn hemispheres(
    trial: &Trial,
    bsdf: &Bsdf,
    wo: DVec3,
    lane: usize,
    exact: f64,
    most: u64,
    draw: impl Fn([f32; 2]) -> (Vec3, f64),
) -> crate::stats::Moments {
    let wo = wo.as_vec3();
    to_detect(trial, exact, 1e-3, most, |u: [f32; 2]| {
        let (w, pdf) = draw(u);
        let f = |wi| f64::from(bsdf.eval(wo, wi, Transport::Importance).f.0[lane]);
        if pdf > 0.0 { (f(w) + f(Vec3::new(w.x, w.y, -w.z))) * f64::from(w.z) / pdf } else { 0.0 }
    })
}
