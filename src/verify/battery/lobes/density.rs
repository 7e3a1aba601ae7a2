//! The density is the law.

use super::{any, each};
use crate::verify::scattering::{Reversed, at_cosine, density, draws, reverse};
use crate::verify::{Task, Topic};

/// The estimator f cos/pdf is right only where draws have the density that they say.
const TOPIC: Topic = Topic {
    id: "DENSITY",
    title: "draws follow pdf (χ²), also as told from the other end; ∫ pdf + deltas + failures = 1; sample().pdf = pdf(wi); \
            weight = f cos/pdf",
    source: "VERIFICATION.md, rule 3; Pearson 1900",
};

/// Arithmetic of weights in f32: a product and a quotient.
const ROUNDING: f64 = 1e-5;

/// Half-vectors of a pair, and refraction to and fro, round differently from either end.
const REVERSED: f64 = 1e-3;

pub(super) fn tasks() -> Vec<Task> {
    each(any, |s| {
        Task::new(TOPIC, s.name.clone(), move |trial, found| {
            let cosines: &[f64] =
                trial.pick(&[0.97, 0.15, -0.6], &[1.0, 0.97, 0.8, 0.6, 0.3, 0.15, 0.03, -0.97, -0.8, -0.6, -0.3, -0.1]);
            for &mu in cosines {
                let (wo, at) = (at_cosine(mu), format!("cos {mu}"));
                let trial = &trial.part(&at);
                density(found, trial, &at, &*s.bsdf, wo);
                draws(found, trial, &at, &*s.bsdf, wo, ROUNDING);
                reverse(found, trial, &at, &*s.bsdf, wo, REVERSED);
            }
            if !s.deltas {
                let (wo, at) = (at_cosine(0.5), "told from the other end, cos 0.5");
                density(found, &trial.part(at), at, &Reversed(&*s.bsdf), wo);
            }
        })
    })
}
