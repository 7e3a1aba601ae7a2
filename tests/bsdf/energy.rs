//! A1, A5: directional albedo.

use crate::{at_cosine, replicates, sampled_albedo};
use radianza::bsdf::{Bsdf, Fresnel, Lobe, Micro, RoughDielectric, RoughReflection, Specimen, Transport, specimens};
use radianza::spectrum::Spectrum;
use radianza::stats::Family;
use radianza::warp;
use rayon::prelude::*;

/// Cosines of incidence, from normal to grazing.
const MUS: [f32; 8] = [1.0, 0.9, 0.7, 0.4, 0.2, 0.08, 0.02, 0.003];

/// Largest error of the energy tables that is granted: interpolation, and the quadrature of dielectrics from inside.
const TABLES: f64 = 5e-4;

/// Opaque lobes are the same on both sides; the consistency and density checks look at the back.
fn sides(s: &Specimen, mu: f32) -> impl Iterator<Item = (&Specimen, f32)> {
    let both = s.name.contains("dielectric");
    [mu, -mu].into_iter().take(if both { 2 } else { 1 }).map(move |z| (s, z))
}

#[test]
fn lossless_specimens_lose_nothing() {
    let mut family = Family::new("A5: lossless specimens, both sides");
    let all: Vec<_> = specimens().into_iter().filter(|s| s.lossless).collect();
    let cases: Vec<_> = all.iter().flat_map(|s| MUS.iter().flat_map(move |&mu| sides(s, mu))).collect();
    let moments: Vec<_> =
        cases.par_iter().map(|(s, mu)| sampled_albedo(&s.bsdf, at_cosine(*mu), 0, 16, 4096)).collect();
    for ((s, mu), m) in cases.iter().zip(moments) {
        family.rounded(format!("{} μ {mu}", s.name), 1.0, m.mean(), m.standard_error(), TABLES);
    }
    family.assert();
}

#[test]
fn white_conductors_vanish_at_every_roughness() {
    let mut family = Family::new("A5: F = 1 conductor");
    let cases: Vec<_> = (0..=12)
        .map(|i| 10f32.powf(-4.0 + i as f32 / 3.0).min(1.0))
        .flat_map(|alpha| [1.0, 0.7, 0.3, 0.08, 0.01, 1e-3, 1e-4].map(|mu| (alpha, mu)))
        .collect();
    let moments: Vec<_> = cases
        .par_iter()
        .map(|&(alpha, mu)| {
            let lobe = RoughReflection::new(Micro::new([alpha; 2]), Fresnel::ONE);
            sampled_albedo(&Bsdf::single(Lobe::RoughReflection(lobe)), at_cosine(mu), 1, 16, 16384)
        })
        .collect();
    for ((alpha, mu), m) in cases.iter().zip(moments) {
        // The aim: tables and f32 within 2e-4.
        family.rounded(format!("α {alpha:.5} μ {mu}"), 1.0, m.mean(), m.standard_error(), 2e-4);
    }
    family.assert();
}

#[test]
fn clear_dielectrics_vanish_from_both_sides() {
    let mut family = Family::new("A5: clear dielectric");
    let cases: Vec<_> = [1e-3, 0.01, 0.05, 0.2, 0.5, 1.0]
        .into_iter()
        .flat_map(|alpha| [1.33, 1.0 / 1.5].map(|eta| (alpha, eta)))
        .flat_map(|(alpha, eta)| {
            // The critical angle of 1.5 lies at 0.745.
            [1.0, 0.8, 0.75, 0.74, 0.5, 0.1, 0.01].into_iter().flat_map(move |mu| [(alpha, eta, mu), (alpha, eta, -mu)])
        })
        .collect();
    let moments: Vec<_> = cases
        .par_iter()
        .map(|&(alpha, eta, mu)| {
            let lobe = RoughDielectric::new([alpha; 2], eta, Spectrum::ONE);
            sampled_albedo(&Bsdf::single(Lobe::RoughDielectric(lobe)), at_cosine(mu), 1, 16, 4096)
        })
        .collect();
    for ((alpha, eta, mu), m) in cases.iter().zip(moments) {
        family.rounded(format!("α {alpha} η {eta:.3} μ {mu}"), 1.0, m.mean(), m.standard_error(), TABLES);
    }
    family.assert();
}

#[test]
fn albedo_is_what_sampling_finds() {
    let mut family = Family::new("albedo() against sampling");
    for s in specimens() {
        // The albedo of metals comes from a fit of their Fresnel term.
        let granted = if s.name.starts_with("gold") { 3e-2 } else { TABLES };
        for mu in [0.95, 0.5, 0.1, -0.6, -0.05] {
            for lane in [0, 2] {
                let m = sampled_albedo(&s.bsdf, at_cosine(mu), lane, 16, 1024);
                let exact = f64::from(s.bsdf.albedo(at_cosine(mu)).0[lane]);
                family.rounded(format!("{} μ {mu} lane {lane}", s.name), exact, m.mean(), m.standard_error(), granted);
            }
        }
    }
    family.assert();
}

/// Direction and density from u and uc.
type Draw = fn([f32; 2], f32) -> (radianza::glam::Vec3, f32);

/// Uniform, cosine and BSDF sampling estimate the same integral.
#[test]
fn the_ladder_of_estimators_agrees() {
    let mut family = Family::new("A1: uniform and cosine directions");
    for s in specimens() {
        let sharp = ["0.002", "0.02", "0.05", "α 0.1", "[0.1", "1.02", "mixture", "smooth", "mirror"];
        if sharp.iter().any(|sharp| s.name.contains(sharp)) {
            continue;
        }
        for mu in [0.9, 0.3, -0.5] {
            let wo = at_cosine(mu);
            let exact = f64::from(s.bsdf.albedo(wo).0[1]);
            let granted = if s.name.starts_with("gold") { 3e-2 } else { TABLES };
            let cases: [(&str, Draw); 2] = [
                ("uniform", |u, _| (warp::uniform_sphere(u), warp::UNIFORM_SPHERE_PDF)),
                ("cosine", |u, uc| {
                    let w = warp::cosine_hemisphere(u);
                    let pdf = 0.5 * warp::cosine_hemisphere_pdf(w.z);
                    (if uc < 0.5 { w } else { -w }, pdf)
                }),
            ];
            for (name, draw) in cases {
                let m = replicates(3, 16, 8192, |uc, u| {
                    let (wi, pdf) = draw(u, uc);
                    if pdf == 0.0 {
                        return 0.0;
                    }
                    f64::from(s.bsdf.eval(wo, wi, Transport::Importance).f.0[1] * wi.z.abs() / pdf)
                });
                family.rounded(format!("{} μ {mu} {name}", s.name), exact, m.mean(), m.standard_error(), granted);
            }
        }
    }
    family.assert();
}
