//! One of everything, for the checks: all lobes, and the corners of their parameters.

use super::*;
use glam::Vec4;

/// A BSDF with a name, and what is known of it.
#[derive(Clone, Debug)]
pub struct Specimen {
    /// Lobe and parameters.
    pub name: String,
    /// The thing itself.
    pub bsdf: Bsdf,
    /// It scatters everything that falls on it.
    pub lossless: bool,
}

/// Gold at 630, 532 and 465 nm (Johnson & Christy 1972), green repeated.
fn gold() -> Fresnel {
    Fresnel::complex(Vec4::new(0.18, 0.54, 1.33, 0.54), Vec4::new(3.42, 2.23, 1.87, 2.23))
}

/// All lobes × parameters.
pub fn specimens() -> Vec<Specimen> {
    let grey = Spectrum::from_rgb([0.8, 0.5, 0.2]);
    let mut all = Vec::new();
    let mut add = |name: String, lossless: bool, bsdf: Bsdf| all.push(Specimen { name, bsdf, lossless });

    add("lambert".into(), false, Bsdf::single(Lobe::lambert(grey)));
    add("lambert white".into(), true, Bsdf::single(Lobe::lambert(Spectrum::ONE)));
    add("mirror".into(), true, Bsdf::single(Lobe::Mirror(Mirror { fresnel: Fresnel::ONE })));
    add("smooth gold".into(), false, Bsdf::single(Lobe::Mirror(Mirror { fresnel: gold() })));
    for eta in [1.5, 1.0 / 1.33] {
        let lobe = Lobe::SmoothDielectric(SmoothDielectric { eta, tint: Spectrum::ONE });
        add(format!("smooth dielectric {eta:.3}"), true, Bsdf::single(lobe));
    }

    for alpha in [2e-3, 0.02, 0.1, 0.4, 1.0] {
        let micro = Micro::new([alpha; 2]);
        let white = RoughReflection::new(micro, Fresnel::ONE);
        add(format!("white conductor α {alpha}"), true, Bsdf::single(Lobe::RoughReflection(white)));
        let schlick = Fresnel::schlick(Spectrum::splat(0.04), Spectrum::ONE);
        let thin = RoughThin::new(RoughReflection::new(micro, schlick), grey);
        add(format!("thin α {alpha}"), false, Bsdf::single(Lobe::RoughThin(thin)));
        add(format!("coated white α {alpha}"), true, coated([alpha; 2], Spectrum::splat(0.04), Spectrum::ONE));
        add(format!("thin sheet α {alpha}"), true, sheet(alpha));
    }
    for alpha in [[0.05, 0.4], [0.9, 0.2]] {
        let micro = Micro::new(alpha);
        let white = RoughReflection::new(micro, Fresnel::ONE);
        add(format!("white conductor α {alpha:?}"), true, Bsdf::single(Lobe::RoughReflection(white)));
        let gold = RoughReflection::new(micro, gold());
        add(format!("gold α {alpha:?}"), false, Bsdf::single(Lobe::RoughReflection(gold)));
    }
    for (alpha, eta) in [(0.02, 1.5), (0.1, 1.5), (0.4, 1.5), (1.0, 1.5), (0.3, 1.0 / 1.5), (0.2, 1.02), (0.3, 2.4)] {
        let lobe = RoughDielectric::new([alpha; 2], eta, Spectrum::ONE);
        add(format!("rough dielectric α {alpha} η {eta:.3}"), true, Bsdf::single(Lobe::RoughDielectric(lobe)));
    }
    let lobe = RoughDielectric::new([0.1, 0.5], 1.5, Spectrum::ONE);
    add("rough dielectric α [0.1, 0.5]".into(), true, Bsdf::single(Lobe::RoughDielectric(lobe)));

    add("coated coloured".into(), false, coated([0.3; 2], Spectrum::from_rgb([0.2, 0.1, 0.04]), grey));
    add("smooth-coated white".into(), true, smooth_coated());
    let mut mixture = Bsdf::new();
    mixture.push(Lobe::lambert(Spectrum::ONE), 0.3, 0.3);
    mixture.push(Lobe::Mirror(Mirror { fresnel: Fresnel::ONE }), 0.3, 0.2);
    let rough = RoughReflection::new(Micro::new([0.2; 2]), Fresnel::ONE);
    mixture.push(Lobe::RoughReflection(rough), 0.4, 0.5);
    add("mixture".into(), true, mixture);
    all
}

/// A diffuse base under a GGX coat.
fn coated(alpha: [f32; 2], f0: Spectrum, base: Spectrum) -> Bsdf {
    let micro = Micro::new(alpha);
    let fresnel = Fresnel::schlick(f0, Spectrum::ONE);
    let f_ms = multiple_scattering(fresnel.average(), micro.energy().mean.loss);
    let coat = Coat { f0, f90: Spectrum::ONE, f_ms, energy: Some(*micro.energy()) };
    let mut bsdf = Bsdf::new();
    bsdf.push(Lobe::RoughReflection(RoughReflection::with(micro, fresnel, f_ms)), 1.0, 0.4);
    bsdf.push(Lobe::CoupledDiffuse(CoupledDiffuse::new(base, coat)), 1.0, 0.6);
    bsdf
}

/// A diffuse base under a smooth coat.
fn smooth_coated() -> Bsdf {
    let f0 = Spectrum::splat(0.04);
    let coat = Coat { f0, f90: Spectrum::ONE, f_ms: Spectrum::ZERO, energy: None };
    let mut bsdf = Bsdf::new();
    bsdf.push(Lobe::Mirror(Mirror { fresnel: Fresnel::schlick(f0, Spectrum::ONE) }), 1.0, 0.4);
    bsdf.push(Lobe::CoupledDiffuse(CoupledDiffuse::new(Spectrum::ONE, coat)), 1.0, 0.6);
    bsdf
}

/// A thin clear sheet: what is not reflected goes through.
fn sheet(alpha: f32) -> Bsdf {
    let coat = RoughReflection::new(Micro::new([alpha; 2]), Fresnel::schlick(Spectrum::splat(0.04), Spectrum::ONE));
    let mut bsdf = Bsdf::new();
    bsdf.push(Lobe::RoughReflection(coat), 1.0, 0.3);
    bsdf.push(Lobe::RoughThin(RoughThin::new(coat, Spectrum::ONE)), 1.0, 0.7);
    bsdf
}
