//! A5: no lobe makes light, and lossless ones keep all of it.

use super::{any, each};
use crate::bsdf::{Bsdf, Fresnel, Lobe, Micro, RoughDielectric, RoughReflection};
use crate::spectrum::Spectrum;
use crate::stats::Evidence;
use crate::verify::scattering::{Claims, Integrals, Sampled, at_cosine, energy, integrals, sampled};
use crate::verify::{Curve, Exhibit, Findings, Task, Topic, Trial};

/// E(ωo) = ∫ f |cos θi| dωi, reflection and transmission together.
const TOPIC: Topic = Topic {
    id: "A5",
    title: "directional albedo ≤ 1 at every angle, = 1 of lossless lobes, multiple scattering included",
    source: "Heitz et al. 2016; Kulla & Conty 2017",
};

pub(super) fn tasks() -> Vec<Task> {
    let mut tasks = each(any, |s| {
        Task::new(TOPIC, s.name.clone(), move |trial, found| {
            // The least of them times the least α of specimens, 0.002, is above HALF_VECTOR.
            let cosines: &[f64] = trial.pick(&[0.8, 0.1, 0.01], &[1.0, 0.9, 0.7, 0.5, 0.4, 0.2, 0.08, 0.02, 0.006]);
            for side in [1.0, -1.0].into_iter().take(if s.refracts { 2 } else { 1 }) {
                let claims = Claims { lossless: s.lossless, granted: s.granted, ..Claims::default() };
                curve(found, trial, &s.bsdf, cosines.iter().map(|mu| side * mu), &claims, s.told);
            }
        })
    });
    tasks.push(Task::new(TOPIC, "white conductor, every roughness", |trial, found| {
        let claims = Claims { lossless: true, granted: 2e-4, ..Claims::default() };
        for alpha in roughnesses(trial) {
            let lobe = RoughReflection::new(Micro::new([alpha; 2]), Fresnel::ONE);
            quadrature(found, trial, alpha.into(), &Bsdf::single(Lobe::RoughReflection(lobe)), &CONDUCTOR, &claims);
        }
    }));
    for eta in [1.33, 1.0 / 1.5] {
        tasks.push(Task::new(TOPIC, format!("clear dielectric η {eta:.3}, every roughness"), move |trial, found| {
            let claims = Claims { lossless: true, granted: 1e-3, ..Claims::default() };
            for alpha in roughnesses(trial) {
                let lobe = RoughDielectric::new([alpha; 2], eta, Spectrum::ONE);
                let bsdf = Bsdf::single(Lobe::RoughDielectric(lobe));
                quadrature(found, trial, alpha.into(), &bsdf, &DIELECTRIC, &claims);
            }
        }));
    }
    tasks
}

const CONDUCTOR: [f64; 6] = [1.0, 0.7, 0.3, 0.08, 0.01, 1e-3];
/// The critical angle of 1.5 lies at 0.745.
const DIELECTRIC: [f64; 8] = [1.0, 0.75, 0.3, 0.02, -1.0, -0.75, -0.74, -0.1];

/// From nearly a mirror to the roughest.
fn roughnesses(trial: &Trial) -> impl Iterator<Item = f32> {
    let n = trial.pick(4, 24);
    (0..=n).map(move |i| 10f32.powf(-3.5 * (1.0 - i as f32 / n as f32)))
}

/// Below this μα a half-vector in f32, whose slope is off by 6·10⁻⁸/μ, no longer resolves a lobe of width α.
const HALF_VECTOR: f64 = 1e-5;

/// Energy over the angle.
fn curve(
    found: &mut Findings,
    trial: &Trial,
    bsdf: &Bsdf,
    cosines: impl Iterator<Item = f64>,
    claims: &Claims,
    granted: f64,
) {
    let mut points = Vec::new();
    for mu in cosines {
        let (wo, trial) = (at_cosine(mu), &trial.part(&format!("{mu}")));
        let integrals = integrals(trial, bsdf, wo);
        let sampled = sampled(trial, bsdf, wo, &integrals, trial.pick(5e-3, 1e-3), trial.work(1 << 12, 1 << 16));
        let at = format!("cos {mu}");
        let albedo = energy(found, &at, claims, &integrals, &sampled);
        told(found, &at, bsdf.albedo(wo.as_vec3()), granted, &integrals, &sampled);
        points.push((mu, albedo, sampled.all.map(|m| m.standard_error())));
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let line = |k: usize| points.iter().map(|(mu, a, se)| [*mu, a[k], se[k]]).collect();
    let lines = ["red", "green", "blue"].into_iter().enumerate().map(|(k, lane)| (lane.into(), line(k))).collect();
    found
        .exhibits
        .push(Exhibit::Curve(Curve { title: "albedo".into(), axes: ["cos θ", "directional albedo"], lines }));
}

/// What the lobe says of its albedo, by tables, is what its function has: it picks lobes, and fills a layer of images.
fn told(found: &mut Findings, at: &str, albedo: Spectrum, granted: f64, integrals: &Integrals, sampled: &Sampled) {
    for (k, lane) in ["red", "green", "blue"].into_iter().enumerate() {
        let (exact, deltas) = (f64::from(albedo.to_rgb()[k]), &sampled.deltas[k]);
        let (se, dof) = (deltas.standard_error(), deltas.n() as f64 - 1.0);
        let (estimate, rounding) = (integrals.albedo[k] + deltas.mean(), (granted + integrals.error) * exact);
        found.checks.push(
            format!("{at}: albedo() is the integral, {lane}"),
            Evidence::Z { exact, estimate, se, dof, rounding },
        );
    }
}

/// Energy by quadrature alone.
fn quadrature(found: &mut Findings, trial: &Trial, alpha: f64, bsdf: &Bsdf, cosines: &[f64], claims: &Claims) {
    for &mu in cosines.iter().filter(|mu| mu.abs() * alpha > HALF_VECTOR) {
        let trial = trial.part(&format!("{alpha} {mu}"));
        let integrals = integrals(&trial, bsdf, at_cosine(mu));
        let rounding = claims.granted + integrals.error;
        let evidence = Evidence::Z { exact: 1.0, estimate: integrals.albedo[0], se: 0.0, dof: f64::INFINITY, rounding };
        found.checks.push(format!("α {alpha:.5}, cos {mu}: albedo = 1 by quadrature"), evidence);
    }
}
