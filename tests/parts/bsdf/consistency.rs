//! Corners of the parameters give numbers: nothing is NaN, negative or outside, and specular parts are parts.

use super::at_cosine;
use radianza::bsdf::{Pdf, Transport, specimens};
use radianza::glam::Vec3;
use radianza::warp::ONE_MINUS_EPSILON;

const MODES: [Transport; 2] = [Transport::Radiance, Transport::Importance];

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
                assert!(sample.specular.0.cmple(sample.weight.0 * 1.000_01).all(), "{at}");
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
