//! A4: directions may be exchanged.

use super::{each, smooth};
use crate::verify::scattering::{Claims, reciprocity};
use crate::verify::{Task, Topic};

/// By the second law: two bodies in thermal balance exchange as much along every pair of paths.
const TOPIC: Topic = Topic {
    id: "A4",
    title: "reciprocity f(a,b) = f(b,a); across an interface f(a→b)/η_b² = f(b→a)/η_a²",
    source: "Helmholtz; Veach 1997, section 5.2",
};

pub(super) fn tasks() -> Vec<Task> {
    each(smooth, |s| {
        Task::new(TOPIC, s.name.clone(), move |trial, found| {
            // Where a refracted pair needs a steep normal, f32 keeps three digits of D.
            let rounding = 3e-3;
            let claims = Claims { rounding, two_sided: true, ..Claims::default() };
            reciprocity(found, trial, "pairs", &*s.bsdf, &claims);
        })
    })
}
