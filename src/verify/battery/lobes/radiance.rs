//! T6: radiance and importance through a refracting interface.

use super::{any, each};
use crate::bsdf::{Bsdf, Lobe, SmoothDielectric, Transport};
use crate::sampler::{Kind, Sampler};
use crate::spectrum::Spectrum;
use crate::verify::scattering::at_cosine;
use crate::verify::{Task, Topic};
use crate::warp::uniform_sphere;

/// A beam that enters a denser medium narrows: radiance over n² is what stays.
const TOPIC: Topic = Topic {
    id: "T6",
    title: "radiance through an interface scales by (η_o/η_i)², so that L/n² is invariant; importance does not",
    source: "Veach 1997, section 5.2",
};

/// A few operations of f32.
const ROUNDING: f64 = 1e-5;

pub(super) fn tasks() -> Vec<Task> {
    let mut tasks = each(any, |s| {
        Task::new(TOPIC, s.name.clone(), move |trial, found| {
            let (mut worst, mut same) = (0f64, true);
            for i in 0..trial.work(2_000, 20_000) {
                let mut u = Sampler::new(Kind::Independent, trial.seed, [0, 0], i, 1);
                let (wo, uc, uv) = (uniform_sphere(u.next_2d()), u.next_1d(), u.next_2d());
                let draw = |mode| s.bsdf.sample(wo, uc, uv, mode);
                let (radiance, importance) = match (draw(Transport::Radiance), draw(Transport::Importance)) {
                    (Some(radiance), Some(importance)) => (radiance, importance),
                    (None, None) => continue,
                    _ => {
                        same = false;
                        continue;
                    }
                };
                // One draw, and its weight times η² is that of importance.
                same &=
                    radiance.wi == importance.wi && radiance.pdf == importance.pdf && radiance.eta == importance.eta;
                same &= (radiance.eta == 1.0) == (wo.z * radiance.wi.z > 0.0 || s.thin);
                let eta2 = radiance.eta * radiance.eta;
                let pairs = [(radiance.weight * eta2, importance.weight), {
                    let f = |mode| s.bsdf.eval(wo, radiance.wi, mode).f;
                    (f(Transport::Radiance) * eta2, f(Transport::Importance))
                }];
                for (a, b) in pairs {
                    let scale = b.max_element();
                    if scale > 0.0 {
                        worst = worst.max(f64::from((a.0 - b.0).abs().max_element() / scale));
                    }
                }
            }
            found.checks.holds("radiance and importance have the same draws", same);
            found.checks.bound("f η² of radiance = f of importance", worst, ROUNDING);
        })
    });
    tasks.push(Task::new(TOPIC, "smooth interface", |_, found| {
        let glass = Bsdf::single(Lobe::SmoothDielectric(SmoothDielectric { eta: 1.5, tint: Spectrum::ONE }));
        for mu in [1.0, 0.7, 0.3, -0.9, -0.8] {
            let wo = at_cosine(mu).as_vec3();
            let (mut worst, mut complete) = (0f64, false);
            let mut equal = |a: f32, b: f32| worst = worst.max(f64::from((a - b).abs() / b.abs().max(1e-3)));
            let [radiance, importance] =
                [Transport::Radiance, Transport::Importance].map(|mode| glass.deltas(wo, mode));
            if let ([r, t], [r_i, t_i]) = (&radiance[..], &importance[..]) {
                let eta = if mu > 0.0 { 1.5 } else { 1.0 / 1.5 };
                equal(r.weight.0.x, r_i.weight.0.x);
                equal(r.eta, 1.0);
                equal(t.eta, eta);
                equal(t_i.weight.0.x, t.weight.0.x * eta * eta);
                equal(r_i.weight.0.x + t_i.weight.0.x, 1.0);
                // Out and back again: the two scalings cancel, and the way is the same.
                let back = glass.deltas(t.wi, Transport::Radiance);
                if let Some(back) = back.iter().find(|d| d.wi.z * t.wi.z < 0.0) {
                    equal(back.weight.0.x * t.weight.0.x, t_i.weight.0.x * t_i.weight.0.x);
                    equal((back.wi - wo).length(), 0.0);
                    complete = true;
                }
            }
            found.checks.holds(format!("cos {mu}: reflects and refracts, there and back"), complete);
            // Distances are relative to 10⁻³.
            found.checks.bound(format!("cos {mu}: F + T = 1, T_L η² = T, L/n² comes back"), worst, 1e-3);
        }
    }));
    tasks
}
