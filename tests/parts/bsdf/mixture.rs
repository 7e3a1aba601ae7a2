//! Choice among lobes: the split of F3, and the three ways to ask for deltas.

use super::{at_cosine, replicates};
use radianza::bsdf::{Bsdf, Fresnel, Lobe, MAX_LOBES, Mirror, Pdf, SmoothDielectric, Transport, specimens};
use radianza::spectrum::Spectrum;
use radianza::stats::Family;

/// BRDF p_d ρ/π + p_s ρ mirror.
fn f3(p_d: f32, rho: f32) -> Bsdf {
    let mut bsdf = Bsdf::new();
    assert!(bsdf.push(Lobe::lambert(Spectrum::splat(rho)), p_d));
    let grey = Mirror { fresnel: Fresnel::Constant(Spectrum::splat(rho)) };
    assert!(bsdf.push(Lobe::Mirror(grey), 1.0 - p_d));
    bsdf
}

#[test]
fn lobes_split_the_energy() {
    let mut family = Family::new("F3: shares of diffuse and specular");
    for (p_d, rho) in [(0.7, 0.8), (0.2, 0.5)] {
        let bsdf = f3(p_d, rho);
        assert!((bsdf.delta_probability(at_cosine(0.4)) - (1.0 - p_d)).abs() < 1e-6);
        let moments = |diffuse: bool| {
            replicates(9, 2048, |uc, u| {
                let sample = bsdf.sample(at_cosine(0.4), uc, u, Transport::Radiance).expect("neither lobe fails");
                f64::from(if diffuse { (sample.weight - sample.specular).0.x } else { sample.specular.0.x })
            })
        };
        family.moments(format!("diffuse {p_d} ρ {rho}"), f64::from(p_d * rho), &moments(true));
        family.moments(format!("specular {p_d} ρ {rho}"), f64::from((1.0 - p_d) * rho), &moments(false));
    }
    family.assert();
}

#[test]
fn deltas_are_those_that_sampling_draws() {
    let mut family = Family::new("delta lobes: drawn, drawn alone, listed");
    for s in specimens() {
        for mu in [0.8, -0.8] {
            let wo = at_cosine(mu);
            let exact: Spectrum = s.bsdf.deltas(wo, Transport::Radiance).iter().map(|d| d.weight).sum();
            if s.bsdf.delta_probability(wo) == 0.0 {
                assert!(exact.is_black() && s.bsdf.sample_delta(wo, 0.5, Transport::Radiance).is_none(), "{}", s.name);
                continue;
            }
            let drawn = replicates(8, 1024, |uc, u| match s.bsdf.sample(wo, uc, u, Transport::Radiance) {
                Some(sample) if matches!(sample.pdf, Pdf::Discrete(_)) => f64::from(sample.weight.0.x),
                _ => 0.0,
            });
            // SampledBy alone, a delta's weight still counts the chance that sampling takes another lobe.
            let p = s.bsdf.delta_probability(wo);
            let alone = replicates(8, 1024, |uc, _| {
                let sample = s.bsdf.sample_delta(wo, uc, Transport::Radiance).expect("there are deltas");
                assert!(matches!(sample.pdf, Pdf::Discrete(q) if q <= p * 1.000_01));
                f64::from(sample.weight.0.x * p)
            });
            for (name, m) in [("drawn", drawn), ("alone", alone)] {
                let exact = f64::from(exact.0.x);
                family.replicated(format!("{} μ {mu} {name}", s.name), exact, &m, 1e-5);
            }
        }
    }
    family.assert();
}

#[test]
fn equal_deltas_are_one() {
    let mut bsdf = f3(0.5, 1.0);
    assert!(bsdf.push(Lobe::Mirror(Mirror { fresnel: Fresnel::ONE }), 0.25));
    let glass = |eta| Lobe::SmoothDielectric(SmoothDielectric { eta, tint: Spectrum::ONE });
    assert!(bsdf.push(glass(1.5), 0.25));
    let deltas = bsdf.deltas(at_cosine(0.5), Transport::Importance);
    assert_eq!(deltas.len(), 2);
    let sum: f32 = deltas.iter().map(|d| d.weight.0.x).sum();
    assert!((sum - 1.0).abs() < 1e-6, "{sum}");

    // A refraction of each lobe and what they reflect fit.
    let mut glasses = Bsdf::new();
    (0..MAX_LOBES).for_each(|i| assert!(glasses.push(glass(1.3 + 0.1 * i as f32), 0.1)));
    assert!(!glasses.push(glass(3.5), 0.1), "no room left");
    assert_eq!(glasses.deltas(at_cosine(0.5), Transport::Radiance).len(), 1 + MAX_LOBES);
}

#[test]
fn nothing_scatters_nothing() {
    let bsdf = Bsdf::new();
    assert!(bsdf.is_empty() && !bsdf.has_smooth() && !bsdf.transmits());
    assert!(bsdf.sample(at_cosine(0.5), 0.5, [0.5; 2], Transport::Radiance).is_none());
    assert!(bsdf.eval(at_cosine(0.5), at_cosine(0.5), Transport::Radiance).f.is_black());
    assert_eq!(bsdf.delta_probability(at_cosine(0.5)), 0.0);
    let mut bsdf = bsdf;
    assert!(!bsdf.push(Lobe::lambert(Spectrum::ONE), 0.0) && !bsdf.push(Lobe::lambert(Spectrum::ONE), f32::NAN));
}
