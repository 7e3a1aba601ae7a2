//! One of everything, for the checks: all lobes, and the corners of their parameters.

use super::*;
use crate::math::Frame;
use glam::Vec4;
use std::sync::LazyLock;

/// A BSDF that is made when it is first looked at: its energy tables may take a second.
pub type Lazy = LazyLock<Bsdf, Box<dyn FnOnce() -> Bsdf + Send>>;

/// A BSDF with a name, and what is known of it.
#[derive(Debug)]
pub struct Specimen {
    /// Lobe and parameters.
    pub name: String,
    /// The thing itself.
    pub bsdf: Lazy,
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
    let mut all = Specimens(Vec::new());

    all.add("lambert", false, move || Bsdf::single(Lobe::lambert(grey)));
    all.add("lambert white", true, || Bsdf::single(Lobe::lambert(Spectrum::ONE)));
    all.add("mirror", true, || Bsdf::single(Lobe::Mirror(Mirror { fresnel: Fresnel::ONE })));
    all.add("smooth gold", false, || Bsdf::single(Lobe::Mirror(Mirror { fresnel: gold() })));
    for eta in [1.5, 1.0 / 1.33] {
        let lobe = SmoothDielectric { eta, tint: Spectrum::ONE };
        all.add(format!("smooth dielectric {eta:.3}"), true, move || Bsdf::single(Lobe::SmoothDielectric(lobe)));
    }

    for alpha in [2e-3, 0.02, 0.1, 0.4, 1.0] {
        all.add(format!("white conductor α {alpha}"), true, move || metal([alpha; 2], Fresnel::ONE));
        all.add(format!("thin α {alpha}"), false, move || {
            let schlick = Fresnel::schlick(Spectrum::splat(0.04), Spectrum::ONE);
            let coat = RoughReflection::new(Micro::new([alpha; 2]), schlick);
            Bsdf::single(Lobe::RoughThin(RoughThin::new(coat, grey)))
        });
        let coated_white = move || coated([alpha; 2], Spectrum::splat(0.04), Spectrum::ONE);
        all.add(format!("coated white α {alpha}"), true, coated_white);
        all.add(format!("thin sheet α {alpha}"), true, move || sheet(alpha));
    }
    for alpha in [[0.05, 0.4], [0.9, 0.2]] {
        all.add(format!("white conductor α {alpha:?}"), true, move || metal(alpha, Fresnel::ONE));
        all.add(format!("gold α {alpha:?}"), false, move || metal(alpha, gold()));
    }
    for (alpha, eta) in [(0.02, 1.5), (0.1, 1.5), (0.4, 1.5), (1.0, 1.5), (0.3, 1.0 / 1.5), (0.2, 1.02), (0.3, 2.4)] {
        all.add(format!("rough dielectric α {alpha} η {eta:.3}"), true, move || glass([alpha; 2], eta));
    }
    all.add("rough dielectric α [0.1, 0.5]", true, || glass([0.1, 0.5], 1.5));

    all.add("thin sheet, diffuse", true, move || diffuse_sheet(Some(0.3), 1.0, [Spectrum::ONE; 2]));
    all.add("diffuse dielectric", false, move || diffuse_sheet(None, 1.5, [grey, Spectrum::ONE]));
    all.add("thin sheet, smooth", true, || {
        let fresnel = Fresnel::schlick(Spectrum::splat(0.04), Spectrum::ONE);
        let mut bsdf = Bsdf::new();
        bsdf.push(Lobe::Mirror(Mirror { fresnel }), 1.0, 0.3);
        bsdf.push(Lobe::ThinTransmission(ThinTransmission { fresnel, tint: Spectrum::ONE }), 1.0, 0.7);
        bsdf
    });
    all.add("oren-nayar white", true, || Bsdf::single(Lobe::Eon(Eon::new(Spectrum::ONE, 1.0))));
    all.add("oren-nayar", false, move || Bsdf::single(Lobe::Eon(Eon::new(grey, 0.5))));
    all.add("phong n 20", false, move || Bsdf::single(Lobe::Phong(Phong { reflectance: grey, exponent: 20.0 })));
    all.add("cook-torrance white α 0.4", true, || cook_torrance(0.4, Fresnel::ONE));
    all.add("cook-torrance gold α 0.15", false, || cook_torrance(0.15, gold()));
    all.add("film on metal α 0.2", false, move || metal([0.2; 2], Fresnel::under_film(FILM, 1.0, grey, 1.0)));
    all.add("film on white α 0.2", true, || filmed_white(Some(0.2)));
    let glass = FilmedDielectric { eta: 1.5, tint: Spectrum::ONE, film: FILM, share: 1.0 };
    all.add("smooth dielectric under film", true, move || Bsdf::single(Lobe::FilmedDielectric(glass)));
    all.add("film on white, smooth", true, || filmed_white(None));

    let copper = Spectrum::from_rgb([0.2, 0.1, 0.04]);
    all.add("coated coloured", false, move || coated([0.3; 2], copper, grey));
    all.add("smooth-coated white", true, smooth_coated);
    all.add("mixture", true, || {
        let mut mixture = Bsdf::new();
        mixture.push(Lobe::lambert(Spectrum::ONE), 0.3, 0.3);
        mixture.push(Lobe::Mirror(Mirror { fresnel: Fresnel::ONE }), 0.3, 0.2);
        let rough = RoughReflection::new(Micro::new([0.2; 2]), Fresnel::ONE);
        mixture.push(Lobe::RoughReflection(rough), 0.4, 0.5);
        mixture
    });

    // Sheen, frames and layers. "Beneath": dimmed by the smaller of both transmittances, so that something is lost.
    for roughness in [0.3, 0.7] {
        let sheen = Sheen::new(Spectrum::ONE, SheenAlbedo::new(roughness));
        all.add(format!("sheen r {roughness}"), false, move || Bsdf::single(Lobe::Sheen(sheen)));
    }
    all.add("turned white conductor α [0.15, 0.6]", true, || {
        let mut turned = Bsdf::new();
        let frame = Frame::from_z_tangent(Vec3::Z, Vec3::new(0.5, -0.8, 0.0), 1.0);
        let lobe = RoughReflection::new(
            Micro::varying([0.15, 0.6], Atlas::get(), EnergyTable::isotropic(Interface::Mirror)),
            Fresnel::ONE,
        );
        turned.push_in(frame, Lobe::RoughReflection(lobe), 1.0, 1.0);
        turned
    });
    all.add("white under a coat", true, || {
        let mut white = Bsdf::single(Lobe::lambert(Spectrum::ONE));
        coat_over(&mut white, 0.8, 0.2, None);
        white
    });
    all.add("white under sheen", true, || {
        let mut white = Bsdf::single(Lobe::lambert(Spectrum::ONE));
        sheen_over(&mut white, 0.4);
        white
    });
    all.add("gold α [0.15, 0.4] beneath a coat", false, || {
        let mut gold = metal([0.15, 0.4], gold());
        coat_over(&mut gold, 1.0, 0.05, None);
        gold
    });
    all.add("plastic beneath sheen and a tilted coat", false, move || {
        let mut plastic = coated([0.3; 2], Spectrum::splat(0.04), grey);
        sheen_over(&mut plastic, 0.7);
        coat_over(&mut plastic, 1.0, 0.2, Some(Vec3::new(0.4, -0.2, 0.9).normalize()));
        plastic
    });
    all.0
}

/// White sheen of this roughness.
fn sheen_over(bsdf: &mut Bsdf, roughness: f32) {
    let albedo = SheenAlbedo::new(roughness);
    bsdf.cover(0, Layer::sheen(1.0, albedo), Vec3::Z);
    bsdf.push(Lobe::Sheen(Sheen::new(Spectrum::ONE, albedo)), 1.0, 0.3);
}

/// A clear coat of index 1.5.
fn coat_over(bsdf: &mut Bsdf, factor: f32, alpha: f32, normal: Option<Vec3>) {
    let fresnel = Fresnel::schlick(Spectrum::splat(0.04), Spectrum::ONE);
    let lobe = RoughReflection::new(Micro::new([alpha; 2]), fresnel);
    bsdf.cover(0, Layer::coat(factor, lobe.coat(), normal), Vec3::Z);
    match normal {
        None => bsdf.push(Lobe::RoughReflection(lobe), factor, 0.3),
        Some(n) => bsdf.push_in(Frame::from_z(n), Lobe::RoughReflection(lobe), factor, 0.3),
    };
}

struct Specimens(Vec<Specimen>);

impl Specimens {
    fn add(&mut self, name: impl Into<String>, lossless: bool, make: impl FnOnce() -> Bsdf + Send + 'static) {
        self.0.push(Specimen { name: name.into(), bsdf: LazyLock::new(Box::new(make)), lossless });
    }
}

fn metal(alpha: [f32; 2], fresnel: Fresnel) -> Bsdf {
    Bsdf::single(Lobe::RoughReflection(RoughReflection::new(Micro::new(alpha), fresnel)))
}

fn glass(alpha: [f32; 2], eta: f32) -> Bsdf {
    Bsdf::single(Lobe::RoughDielectric(RoughDielectric::new(alpha, eta, Spectrum::ONE)))
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

/// Two fringes from normal to grazing incidence.
const FILM: ThinFilm = ThinFilm { eta: 1.4, thickness: 550.0 };

/// A white base under a dielectric coat under a film.
fn filmed_white(alpha: Option<f32>) -> Bsdf {
    let (f0, micro) = (Spectrum::splat(0.04), alpha.map(|a| Micro::new([a; 2])));
    let fresnel = Fresnel::under_film(FILM, 1.0, f0, 1.0);
    let f_ms = multiple_scattering(fresnel.average(), micro.map_or(0.0, |m| m.energy().mean.loss));
    let coat = Coat { f0, f90: Spectrum::ONE, f_ms, energy: micro.map(|m| *m.energy()) };
    let mut bsdf = Bsdf::new();
    let reflection = match micro {
        None => Lobe::Mirror(Mirror { fresnel }),
        Some(micro) => Lobe::RoughReflection(RoughReflection::with(micro, fresnel, f_ms)),
    };
    bsdf.push(reflection, 1.0, 0.4);
    bsdf.push(Lobe::CoupledDiffuse(CoupledDiffuse::under(Spectrum::ONE, coat, fresnel)), 1.0, 0.6);
    bsdf
}

fn cook_torrance(alpha: f32, fresnel: Fresnel) -> Bsdf {
    Bsdf::single(Lobe::CookTorrance(RoughReflection::new(Micro::beckmann([alpha; 2]), fresnel)))
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

/// A diffuse base that reflects the first and transmits the second, half of it each, under a coat on both sides.
fn diffuse_sheet(alpha: Option<f32>, eta: f32, [reflected, transmitted]: [Spectrum; 2]) -> Bsdf {
    let (f0, f90) = (Spectrum::splat(0.04), Spectrum::ONE);
    let fresnel = Fresnel::schlick(f0, f90);
    let micro = alpha.map(|alpha| Micro::new([alpha; 2]));
    let f_ms = multiple_scattering(fresnel.average(), micro.map_or(0.0, |m| m.energy().mean.loss));
    let coat = Coat { f0, f90, f_ms, energy: micro.map(|m| *m.energy()) };
    let mut bsdf = Bsdf::new();
    match micro {
        None => bsdf.push(Lobe::Mirror(Mirror { fresnel }), 1.0, 0.2),
        Some(micro) => bsdf.push(Lobe::RoughReflection(RoughReflection::with(micro, fresnel, f_ms)), 1.0, 0.2),
    };
    bsdf.push(Lobe::CoupledDiffuse(CoupledDiffuse::new(reflected, coat)), 0.5, 0.4);
    let base = CoupledDiffuse::new(transmitted, coat);
    bsdf.push(Lobe::DiffuseTransmission(DiffuseTransmission { base, eta }), 0.5, 0.4);
    bsdf
}
