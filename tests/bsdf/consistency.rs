//! What `sample` says of itself is what `eval` says; nothing is NaN, negative or outside.

use crate::{at_cosine, solid_angle};
use radianza::bsdf::{Pdf, Transport, specimens};
use radianza::glam::Vec3;
use radianza::sampler::{Kind, Sampler};
use radianza::warp::ONE_MINUS_EPSILON;

const MODES: [Transport; 2] = [Transport::Radiance, Transport::Importance];

#[test]
fn weight_and_density_are_those_of_eval() {
    let mut drawn = 0;
    for s in specimens() {
        for (mu, mode) in [0.9, 0.2, -0.7, -0.05].into_iter().flat_map(|mu| MODES.map(|mode| (mu, mode))) {
            let wo = at_cosine(mu);
            for i in 0..500 {
                let mut sampler = Sampler::new(Kind::Independent, 5, [0, 0], i, 1);
                let (uc, u) = (sampler.next_1d(), sampler.next_2d());
                let Some(sample) = s.bsdf.sample(wo, uc, u, mode) else { continue };
                let Some(pdf) = solid_angle(&sample) else { continue };
                let e = s.bsdf.eval(wo, sample.wi, mode);
                assert_eq!(pdf, e.pdf, "{}", s.name);
                let weight = e.f * (sample.wi.z.abs() / e.pdf);
                assert!((weight.0 - sample.weight.0).abs().max_element() <= 1e-5 * weight.max_element(), "{}", s.name);
                assert!((sample.wi.length() - 1.0).abs() < 1e-5, "{}", s.name);
                assert!(sample.specular.0.cmple(sample.weight.0 * 1.000_01).all(), "{}", s.name);
                drawn += 1;
            }
        }
    }
    assert!(drawn > 50_000, "{drawn}");
}

#[test]
fn corners_give_numbers() {
    let us = [0.0, 1e-7, 0.25, 0.5, 0.75, 1.0 - 1e-6, ONE_MINUS_EPSILON];
    let mus = [1.0, 0.999_999, 0.5, 1e-3, 1e-6, 1e-10, 1e-20, -1.0, -0.3, -1e-5, -1e-12];
    for s in specimens() {
        for (mu, mode) in mus.into_iter().flat_map(|mu| MODES.map(|mode| (mu, mode))) {
            let r = (1.0f32 - mu * mu).max(0.0).sqrt();
            let wo = Vec3::new(r, 0.0, mu);
            for (a, (b, c)) in us.iter().flat_map(|&a| us.iter().flat_map(move |&b| us.map(|c| (a, (b, c))))) {
                let Some(sample) = s.bsdf.sample(wo, a, [b, c], mode) else { continue };
                let at = format!("{} μ {mu:e} u {a} {b} {c}: {sample:?}", s.name);
                assert!(sample.weight.is_finite() && sample.wi.is_finite(), "{at}");
                assert!(sample.weight.0.min_element() >= 0.0 && sample.eta > 0.0, "{at}");
                match sample.pdf {
                    Pdf::SolidAngle(pdf) => assert!(pdf > 0.0 && pdf.is_finite(), "{at}"),
                    Pdf::Discrete(p) => assert!(p > 0.0 && p <= 1.0, "{at}"),
                }
            }
            for wi in [wo, -wo, Vec3::Z, -Vec3::Z, Vec3::new(-r, 0.0, mu), at_cosine(1e-10), Vec3::X] {
                let e = s.bsdf.eval(wo, wi, mode);
                assert!(e.f.is_finite() && e.pdf.is_finite() && e.pdf >= 0.0, "{} {wo} {wi}: {e:?}", s.name);
            }
            assert!(s.bsdf.albedo(wo).is_finite(), "{} {wo}", s.name);
        }
        for mode in MODES {
            assert!(s.bsdf.sample(Vec3::X, 0.5, [0.5; 2], mode).is_none(), "{}", s.name);
            assert!(s.bsdf.deltas(Vec3::X, mode).is_empty(), "{}", s.name);
        }
    }
}
