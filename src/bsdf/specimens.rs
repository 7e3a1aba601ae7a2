//! One of everything, for the checks: all lobes, and the corners of their parameters.

use super::*;
use crate::math::Frame;
use glam::Vec4;
use std::sync::{Arc, LazyLock};

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
    /// Relative error in energy that is granted to its tables.
    pub granted: f64,
    /// Relative error of [`Bsdf::albedo`]; of lobes beneath layers that is a bound.
    pub told: f64,
    /// The two sides of it differ.
    pub refracts: bool,
    /// Light that crosses it goes on unbent.
    pub thin: bool,
    /// All of it are deltas.
    pub deltas: bool,
    /// It is too narrow for directions that know nothing of it.
    pub sharp: bool,
}

/// Gold at 630, 532 and 465 nm (Johnson & Christy 1972), green repeated.
fn gold() -> Fresnel {
    Fresnel::complex(Vec4::new(0.18, 0.54, 1.33, 0.54), Vec4::new(3.42, 2.23, 1.87, 2.23))
}

/// Error of tables over direction and roughness, and where indices come in as well.
const TABLES: f64 = 2e-4;
const DIELECTRIC: f64 = 1e-3;
/// Where indices nearly match, the refracted lobe is so much narrower than the reflected one that quadrature loses a little.
const NEARLY_MATCHED: f64 = 2e-3;
/// The table of every pair of roughnesses is coarser.
const EVERY_PAIR: f64 = 3e-3;
/// Series of twelve terms for two fringes.
const FILMED: f64 = 1e-3;
/// Tables over thickness and roughness, whose nodes lie apart.
const VARYING_FILM: f64 = 3e-3;
/// Sheen over something, and where little is reflected the albedo that its table tells.
const SHEEN: f64 = 1e-3;
const SHEEN_ALONE: f64 = 1e-2;
/// What is told of lobes beneath layers, and of tilted ones, is a bound that is this near.
const BENEATH: f64 = 0.2;

/// All lobes × parameters.
pub fn specimens() -> Vec<Specimen> {
    let grey = Spectrum::from_rgb([0.8, 0.5, 0.2]);
    let mut all = Specimens(Vec::new());

    all.add("lambert", move || Bsdf::single(Lobe::lambert(grey)));
    all.add("lambert white", || Bsdf::single(Lobe::lambert(Spectrum::ONE))).lossless();
    all.add("mirror", || Bsdf::single(Lobe::Mirror(Mirror { fresnel: Fresnel::ONE }))).lossless().deltas();
    all.add("smooth gold", || Bsdf::single(Lobe::Mirror(Mirror { fresnel: gold() }))).deltas();
    for eta in [1.5, 1.0 / 1.33] {
        let lobe = SmoothDielectric { eta, tint: Spectrum::ONE };
        let name = format!("smooth dielectric {eta:.3}");
        all.add(name, move || Bsdf::single(Lobe::SmoothDielectric(lobe))).lossless().deltas().refracts();
    }

    for alpha in [2e-3, 0.02, 0.1, 0.4, 1.0] {
        let sharp = alpha <= 0.1;
        let coat = move || (Micro::new([alpha; 2]), Fresnel::schlick(Spectrum::splat(0.04), 1.0));
        all.add(format!("white conductor α {alpha}"), move || metal([alpha; 2], Fresnel::ONE)).lossless().sharp(sharp);
        let thin = move || {
            let (micro, schlick) = coat();
            Bsdf::single(Lobe::RoughThin(RoughThin::new(micro, schlick, grey)))
        };
        all.add(format!("thin α {alpha}"), thin).thin().sharp(sharp);
        let coated_white = move || coated([alpha; 2], Spectrum::splat(0.04), Spectrum::ONE);
        all.add(format!("coated white α {alpha}"), coated_white).lossless().sharp(sharp);
        all.add(format!("thin sheet α {alpha}"), move || sheet(alpha)).lossless().thin().sharp(sharp);
    }
    for alpha in [[0.05, 0.4], [0.9, 0.2]] {
        let sharp = alpha[0] < 0.1;
        all.add(format!("white conductor α {alpha:?}"), move || metal(alpha, Fresnel::ONE)).lossless().sharp(sharp);
        all.add(format!("gold α {alpha:?}"), move || metal(alpha, gold())).sharp(sharp);
    }
    for (alpha, eta) in [(0.02, 1.5), (0.1, 1.5), (0.4, 1.5), (1.0, 1.5), (0.3, 1.0 / 1.5), (0.2, 1.02), (0.3, 2.4)] {
        let matched = (eta - 1.0f32).abs() < 0.1;
        all.add(format!("rough dielectric α {alpha} η {eta:.3}"), move || glass([alpha; 2], eta))
            .lossless()
            .refracts()
            .granted(if matched { NEARLY_MATCHED } else { DIELECTRIC })
            .sharp(alpha <= 0.1 || matched);
    }
    all.add("rough dielectric α [0.1, 0.5]", || glass([0.1, 0.5], 1.5)).lossless().refracts().sharp(true);

    all.add("thin sheet, diffuse", move || diffuse_sheet(Some(0.3), 1.0, [Spectrum::ONE; 2])).lossless().thin();
    all.add("diffuse dielectric", move || diffuse_sheet(None, 1.5, [grey, Spectrum::ONE])).refracts();
    let smooth_sheet = || {
        let fresnel = Fresnel::schlick(Spectrum::splat(0.04), 1.0);
        let mut bsdf = Bsdf::new();
        bsdf.push(Lobe::Mirror(Mirror { fresnel: fresnel.clone() }), 1.0);
        bsdf.push(Lobe::ThinTransmission(ThinTransmission { fresnel, tint: Spectrum::ONE }), 1.0);
        bsdf
    };
    all.add("thin sheet, smooth", smooth_sheet).lossless().thin().deltas();
    all.add("oren-nayar white", || Bsdf::single(Lobe::Eon(Eon::new(Spectrum::ONE, 1.0)))).lossless();
    all.add("oren-nayar", move || Bsdf::single(Lobe::Eon(Eon::new(grey, 0.5))));
    all.add("phong n 20", move || Bsdf::single(Lobe::Phong(Phong { reflectance: grey, exponent: 20.0 })));
    all.add("cook-torrance white α 0.4", || cook_torrance(0.4, Fresnel::ONE)).lossless();
    all.add("cook-torrance gold α 0.15", || cook_torrance(0.15, gold()));
    let film_on_grey = move || metal([0.2; 2], Fresnel::under_film(FILM, 1.0, grey, 1.0));
    all.add("film on metal α 0.2", film_on_grey).granted(FILMED);
    all.add("film on white α 0.2", || filmed_white(Some(0.2))).lossless().granted(FILMED);
    let glass = FilmedDielectric { eta: 1.5, tint: Spectrum::ONE, film: FILM, share: 1.0 };
    let filmed = move || Bsdf::single(Lobe::FilmedDielectric(glass));
    all.add("smooth dielectric under film", filmed).lossless().deltas().refracts().granted(FILMED);
    let rough = move || {
        let energy = FilmedEnergy::new(glass.eta, [0.3; 2], FILM.eta, [FILM.thickness; 2]);
        let rough = RoughFilmedDielectric::new([0.3; 2], glass, &Arc::new(energy));
        Bsdf::single(Lobe::RoughFilmedDielectric(Box::new(rough)))
    };
    all.add("rough dielectric under film α 0.3", rough).lossless().refracts().granted(FILMED);
    // Of a texture: its energies lie between those of the nodes.
    let varying = move || {
        let energy = FilmedEnergy::new(glass.eta, [0.1, 0.9], FILM.eta, [100.0, 900.0]);
        let half = FilmedDielectric { share: 0.5, ..glass };
        let rough = RoughFilmedDielectric::new([0.47; 2], half, &Arc::new(energy));
        Bsdf::single(Lobe::RoughFilmedDielectric(Box::new(rough)))
    };
    all.add("rough dielectric half under varying film α 0.47", varying).lossless().refracts().granted(VARYING_FILM);
    all.add("film on white, smooth", || filmed_white(None)).lossless().granted(FILMED).sharp(true);

    let copper = Spectrum::from_rgb([0.2, 0.1, 0.04]);
    all.add("coated coloured", move || coated([0.3; 2], copper, grey));
    all.add("smooth-coated white", smooth_coated).lossless().sharp(true);
    let mixture = || {
        let mut mixture = Bsdf::new();
        mixture.push(Lobe::lambert(Spectrum::ONE), 0.3);
        mixture.push(Lobe::Mirror(Mirror { fresnel: Fresnel::ONE }), 0.3);
        let rough = RoughReflection::new(Micro::new([0.2; 2]), Fresnel::ONE);
        mixture.push(Lobe::RoughReflection(rough), 0.4);
        mixture
    };
    all.add("mixture", mixture).lossless().sharp(true);

    // Sheen, frames and layers. "Beneath": dimmed by the smaller of both transmittances, so that something is lost.
    for roughness in [0.3, 0.7] {
        let sheen = Sheen::new(Spectrum::ONE, SheenAlbedo::new(roughness));
        let name = format!("sheen r {roughness}");
        all.add(name, move || Bsdf::single(Lobe::Sheen(sheen))).granted(SHEEN).told(SHEEN_ALONE);
    }
    let turned = || {
        let mut turned = Bsdf::new();
        let frame = Frame::from_z_tangent(Vec3::Z, Vec3::new(0.5, -0.8, 0.0), 1.0);
        let lobe = RoughReflection::new(Micro::of([0.15, 0.6], EnergyTable::every_pair()), Fresnel::ONE);
        turned.push_in(Some(&frame), Lobe::RoughReflection(lobe), 1.0);
        turned
    };
    all.add("turned white conductor α [0.15, 0.6]", turned).lossless().granted(EVERY_PAIR);
    let coated_lambert = || {
        let mut white = Bsdf::single(Lobe::lambert(Spectrum::ONE));
        coat_over(&mut white, 0.8, 0.2, None);
        white
    };
    all.add("white under a coat", coated_lambert).lossless();
    let sheen_on_white = || {
        let mut white = Bsdf::single(Lobe::lambert(Spectrum::ONE));
        sheen_over(&mut white, 0.4);
        white
    };
    all.add("white under sheen", sheen_on_white).lossless().granted(SHEEN);
    let coated_gold = || {
        let mut gold = metal([0.15, 0.4], gold());
        coat_over(&mut gold, 1.0, 0.05, None);
        gold
    };
    all.add("gold α [0.15, 0.4] beneath a coat", coated_gold).told(BENEATH).sharp(true);
    let plastic = move || {
        let mut plastic = coated([0.3; 2], Spectrum::splat(0.04), grey);
        sheen_over(&mut plastic, 0.7);
        coat_over(&mut plastic, 1.0, 0.2, Some(Vec3::new(0.4, -0.2, 0.9).normalize()));
        plastic
    };
    all.add("plastic beneath sheen and a tilted coat", plastic).granted(SHEEN).told(BENEATH);
    all.0
}

/// White sheen of this roughness.
fn sheen_over(bsdf: &mut Bsdf, roughness: f32) {
    let albedo = SheenAlbedo::new(roughness);
    bsdf.cover(0, Layer::sheen(1.0, albedo));
    bsdf.push(Lobe::Sheen(Sheen::new(Spectrum::ONE, albedo)), 1.0);
}

/// A clear coat of index 1.5.
fn coat_over(bsdf: &mut Bsdf, factor: f32, alpha: f32, normal: Option<Vec3>) {
    let micro = Micro::new([alpha; 2]);
    bsdf.cover(0, Layer::coat(factor, 0.04, Some(*micro.energy()), normal));
    let lobe = RoughReflection::new(micro, Fresnel::schlick(Spectrum::splat(0.04), 1.0));
    bsdf.push_in(normal.map(Frame::from_z).as_ref(), Lobe::RoughReflection(lobe), factor);
}

struct Specimens(Vec<Specimen>);

impl Specimens {
    fn add(&mut self, name: impl Into<String>, make: impl FnOnce() -> Bsdf + Send + 'static) -> Added<'_> {
        self.0.push(Specimen {
            name: name.into(),
            bsdf: LazyLock::new(Box::new(make)),
            lossless: false,
            granted: TABLES,
            told: TABLES,
            refracts: false,
            thin: false,
            deltas: false,
            sharp: false,
        });
        Added(self.0.last_mut())
    }
}

/// The specimen that was added last, to say more of it.
struct Added<'a>(Option<&'a mut Specimen>);

impl Added<'_> {
    fn set(mut self, of: impl FnOnce(&mut Specimen)) -> Self {
        if let Some(specimen) = &mut self.0 {
            of(specimen);
        }
        self
    }
    fn lossless(self) -> Self {
        self.set(|s| s.lossless = true)
    }
    fn granted(self, error: f64) -> Self {
        self.set(|s| (s.granted, s.told) = (error, error))
    }
    fn told(self, error: f64) -> Self {
        self.set(|s| s.told = error)
    }
    fn refracts(self) -> Self {
        self.set(|s| s.refracts = true)
    }
    fn thin(self) -> Self {
        self.set(|s| s.thin = true)
    }
    fn deltas(self) -> Self {
        self.set(|s| s.deltas = true)
    }
    fn sharp(self, sharp: bool) -> Self {
        self.set(|s| s.sharp = sharp)
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
    let coat = Coat { f0, f90: 1.0, energy: Some(*micro.energy()) };
    let mut bsdf = Bsdf::new();
    bsdf.push(Lobe::RoughReflection(RoughReflection::new(micro, Fresnel::schlick(f0, 1.0))), 1.0);
    bsdf.push(Lobe::CoupledDiffuse(CoupledDiffuse::new(base, coat)), 1.0);
    bsdf
}

/// Two fringes from normal to grazing incidence.
const FILM: ThinFilm = ThinFilm { eta: 1.4, thickness: 550.0 };

/// A white base under a dielectric coat under a film.
fn filmed_white(alpha: Option<f32>) -> Bsdf {
    let (f0, micro) = (Spectrum::splat(0.04), alpha.map(|a| Micro::new([a; 2])));
    let fresnel = Fresnel::under_film(FILM, 1.0, f0, 1.0);
    let coat = Coat { f0, f90: 1.0, energy: micro.map(|m| *m.energy()) };
    let mut bsdf = Bsdf::new();
    bsdf.push(reflection(micro, fresnel.clone()), 1.0);
    bsdf.push(Lobe::CoupledDiffuse(CoupledDiffuse::under(Spectrum::ONE, coat, &fresnel)), 1.0);
    bsdf
}

/// What a coat reflects.
fn reflection(micro: Option<Micro>, fresnel: Fresnel) -> Lobe {
    match micro {
        None => Lobe::Mirror(Mirror { fresnel }),
        Some(micro) => Lobe::RoughReflection(RoughReflection::new(micro, fresnel)),
    }
}

fn cook_torrance(alpha: f32, fresnel: Fresnel) -> Bsdf {
    Bsdf::single(Lobe::CookTorrance(RoughReflection::new(Micro::beckmann([alpha; 2]), fresnel)))
}

/// A diffuse base under a smooth coat.
fn smooth_coated() -> Bsdf {
    let f0 = Spectrum::splat(0.04);
    let mut bsdf = Bsdf::new();
    bsdf.push(Lobe::Mirror(Mirror { fresnel: Fresnel::schlick(f0, 1.0) }), 1.0);
    bsdf.push(Lobe::CoupledDiffuse(CoupledDiffuse::new(Spectrum::ONE, Coat::smooth(0.04))), 1.0);
    bsdf
}

/// A thin clear sheet: what is not reflected goes through.
fn sheet(alpha: f32) -> Bsdf {
    let (micro, fresnel) = (Micro::new([alpha; 2]), Fresnel::schlick(Spectrum::splat(0.04), 1.0));
    let mut bsdf = Bsdf::new();
    bsdf.push(Lobe::RoughReflection(RoughReflection::new(micro, fresnel.clone())), 1.0);
    bsdf.push(Lobe::RoughThin(RoughThin::new(micro, fresnel, Spectrum::ONE)), 1.0);
    bsdf
}

/// A diffuse base that reflects the first and transmits the second, half of it each, under a coat on both sides.
fn diffuse_sheet(alpha: Option<f32>, eta: f32, [reflected, transmitted]: [Spectrum; 2]) -> Bsdf {
    let micro = alpha.map(|alpha| Micro::new([alpha; 2]));
    let coat = Coat { f0: Spectrum::splat(0.04), f90: 1.0, energy: micro.map(|m| *m.energy()) };
    let mut bsdf = Bsdf::new();
    bsdf.push(reflection(micro, Fresnel::schlick(coat.f0, 1.0)), 1.0);
    bsdf.push(Lobe::CoupledDiffuse(CoupledDiffuse::new(reflected, coat)), 0.5);
    bsdf.push(Lobe::DiffuseTransmission { base: CoupledDiffuse::new(transmitted, coat), eta }, 0.5);
    bsdf
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// The list of all variants and the match over them are one text: a new lobe does not compile before it stands here, and
    /// what stands here has a specimen.
    macro_rules! variants {
        ($($variant:ident)*) => {
            const ALL: &[&str] = &[$(stringify!($variant)),*];
            fn name(lobe: &Lobe) -> &'static str {
                match lobe { $(Lobe::$variant { .. } => stringify!($variant)),* }
            }
        };
    }
    variants! {
        Lambert Eon CoupledDiffuse DiffuseTransmission Mirror SmoothDielectric ThinTransmission RoughReflection CookTorrance
        Phong RoughThin RoughDielectric Sheen FilmedDielectric RoughFilmedDielectric
    }

    #[test]
    fn every_lobe_has_a_specimen() {
        let all = specimens();
        let seen: BTreeSet<_> = all.iter().flat_map(|s| s.bsdf.entries.iter().map(|e| name(&e.lobe))).collect();
        let without: Vec<_> = ALL.iter().filter(|name| !seen.contains(*name)).collect();
        assert!(without.is_empty(), "no specimen of {without:?}");
        for s in &all {
            assert_eq!(s.deltas, !s.bsdf.has_smooth(), "{}", s.name);
        }
    }
}
