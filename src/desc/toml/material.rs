//! `[material.NAME]`.

use super::build::Builder;
use super::color::{Radiance, Reflectance, Scalar};
use super::film::FilmTable;
use super::interior::{self, InteriorTable};
use super::keys::{keys, one_of};
use super::layers::LayersTable;
use super::metals;
use super::normal_map::NormalMapValue;
use super::read::{At, Fault, Fraction, Node, NonNegative, Number, Positive, Read, mismatch, suggest, words};
use super::schema::Defs;
use crate::desc::{
    Alpha, DiffuseTransmission, Emission, Fresnel, Interior, Material, MetallicRoughness, Model, Roughness,
    ScalarParam, Sides, Transmission,
};
use ::toml::de::DeValue;
use serde_json::{Value as Json, json};

keys! {
    /// A surface material.
    struct MaterialTable {
        /// Radiance that the surface emits in W/(sr m²), the same in all directions. Default: none.
        emission: Option<Radiance>,
        /// Which side emits: "front" or "both". Default "front".
        emission_sides: Sides = Sides::Front,
        /// Share of the surface that is there: a number in [0, 1] or a texture. Default 1.
        opacity: Option<Scalar>,
        /// With it, the surface is there wherever the opacity is at least this. Default: there with the opacity as probability.
        opacity_cutoff: Option<Fraction>,
        /// Tangent-space normal map: the name of a texture, or { texture = "name", scale = 1 }.
        normal_map: Option<NormalMapValue>,
        ..kind: MaterialKind,
    }
}

one_of! {
    /// A surface material.
    enum MaterialKind {
        "diffuse" => Diffuse,
        "mirror" => Mirror,
        "dielectric" => Dielectric,
        "conductor" => Conductor,
        "mix" => Mix,
        "metallic-roughness" => MetallicRoughnessTable,
        "phong" => Phong,
        "cook-torrance" => CookTorrance,
        "absorb" => Absorb,
    } default None
}

keys! {
    /// Lambert: scatters alike in all directions; with a roughness, Oren and Nayar's grooves without loss of energy (EON).
    struct Diffuse {
        /// Albedo, each channel in [0, 1].
        reflectance: Reflectance,
        /// Roughness in [0, 1], a number or a texture. Default 0: Lambert.
        roughness: Option<Scalar>,
    }
}

keys! {
    /// Phong's lobe about the mirror direction, normalised: (n + 2)/(2π) cosⁿα.
    struct Phong {
        /// Albedo at normal incidence, each channel in [0, 1].
        reflectance: Reflectance,
        /// Exponent n, at least 0.
        exponent: NonNegative,
    }
}

keys! {
    /// Perfect mirror.
    struct Mirror {
        /// Share reflected, each channel in [0, 1]. Default 1.
        reflectance: Reflectance = Reflectance::Constant([Fraction(1.0); 3]),
    }
}

keys! {
    /// Clear interface that reflects and refracts: glass, water.
    struct Dielectric {
        /// Index of refraction behind the surface, over vacuum; what the surface lies in is known from the path. Default 1.5.
        ior: Option<At<Positive>>,
        /// In place of it: [A, B] of Cauchy's formula n = A + B/wavelength², B in µm².
        cauchy: Option<At<[Number; 2]>>,
        /// Perceptual roughness in [0, 1] (GGX alpha is its square), a number or a texture. Default 0: smooth.
        roughness: Option<Scalar>,
        /// GGX alpha, a number or [along the tangent, along the bitangent], in place of the roughness.
        alpha: Option<At<AlphaValue>>,
        /// Factor on what is transmitted, each channel in [0, 1]. Default 1.
        tint: Reflectance = Reflectance::Constant([Fraction(1.0); 3]),
        ..interior: InteriorTable,
    }
}

keys! {
    /// Metal: give one of `metal`, `eta` with `k`, and `reflectance`.
    struct Conductor {
        /// A metal by its chemical symbol: Ag, Al, Au, Cr, Cu, Fe, Ni, Ti.
        metal: Option<At<String>>,
        /// Real part of the index of refraction for R, G and B.
        eta: Option<[Positive; 3]>,
        /// Extinction coefficient for R, G and B.
        k: Option<[NonNegative; 3]>,
        /// Reflectance at normal incidence (Schlick's approximation), each channel in [0, 1].
        reflectance: Option<Reflectance>,
        /// Perceptual roughness in [0, 1] (GGX alpha is its square), a number or a texture. Default 0: smooth.
        roughness: Option<Scalar>,
        /// GGX alpha, a number or [along the tangent, along the bitangent], in place of the roughness.
        alpha: Option<At<AlphaValue>>,
    }
}

keys! {
    /// Microfacets of Cook and Torrance: Beckmann's distribution of normals. Give one of `metal`, `eta` with `k`,
    /// `reflectance` and `ior`.
    struct CookTorrance {
        /// A metal by its chemical symbol: Ag, Al, Au, Cr, Cu, Fe, Ni, Ti.
        metal: Option<At<String>>,
        /// Real part of the index of refraction for R, G and B.
        eta: Option<[Positive; 3]>,
        /// Extinction coefficient for R, G and B.
        k: Option<[NonNegative; 3]>,
        /// Reflectance at normal incidence (Schlick's approximation), each channel in [0, 1].
        reflectance: Option<Reflectance>,
        /// Index of refraction of a dielectric, of which only the reflection is shown.
        ior: Option<Positive>,
        /// Perceptual roughness in [0, 1] (Beckmann's alpha is its square), a number or a texture. Default 0: smooth.
        roughness: Option<Scalar>,
        /// Beckmann's alpha, a number or [along the tangent, along the bitangent], in place of the roughness.
        alpha: Option<At<AlphaValue>>,
    }
}

keys! {
    /// Several materials at once, f = Σ weight f; what the weights lack to 1 is absorbed.
    struct Mix {
        /// [{ material = "name", weight = 0.5 }, …]; the weights sum to at most 1.
        parts: At<Vec<MixPart>>,
    }
}

keys! {
    /// One of the materials of a mixture. Only how it scatters counts, not its emission, opacity or normal map.
    struct MixPart {
        /// Name of the material.
        material: At<String>,
        /// Its weight in [0, 1].
        weight: Fraction,
    }
}

keys! {
    /// The metallic-roughness model of glTF 2.0.
    struct MetallicRoughnessTable {
        /// Albedo of the dielectric, reflectance of the metal, each channel in [0, 1]. Default 1.
        base_color: Reflectance = Reflectance::Constant([Fraction(1.0); 3]),
        /// Metalness in [0, 1], a number or a texture. Default 0.
        metallic: Scalar = Scalar::Constant(0.0),
        /// Perceptual roughness in [0, 1] (GGX alpha is its square), a number or a texture. Default 1.
        roughness: Scalar = Scalar::Constant(1.0),
        /// Index of refraction of the dielectric, at least 1. Default 1.5.
        ior: At<Number> = At { at: 0..0, value: Number(1.5) },
        /// Factor on the reflection of the dielectric in [0, 1], a number or a texture. Default 1.
        specular: Scalar = Scalar::Constant(1.0),
        /// Colour of the reflection of the dielectric at normal incidence, at least 0. Default 1.
        specular_color: Radiance = Radiance::Constant([NonNegative(1.0); 3]),
        /// Share of the diffuse light that passes through instead in [0, 1], a number or a texture. Default: none.
        transmission: Option<Scalar>,
        /// Share of what is left of the diffuse light that passes through diffusely in [0, 1], a number or a texture. Default: none.
        diffuse_transmission: Option<Scalar>,
        /// Colour of the diffuse light that passes through, each channel in [0, 1]. Default 1.
        diffuse_transmission_color: Reflectance = Reflectance::Constant([Fraction(1.0); 3]),
        /// Whether the surface is a thin sheet: what passes goes straight on instead of being refracted. Default true.
        thin: bool = true,
        /// A film on the surface that is so thin that the light of its two faces interferes. Default: none.
        film: Option<FilmTable>,
        ..interior: InteriorTable,
        ..layers: LayersTable,
    }
}

keys! {
    /// Scatters nothing: black.
    struct Absorb {
    }
}

words! { Sides: "front" => Sides::Front, "both" => Sides::Both; }

/// GGX α along the tangent and the bitangent.
#[derive(Clone, Copy, Debug)]
pub(super) struct AlphaValue([f32; 2]);

impl Read for AlphaValue {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::Array(_) => <[Fraction; 2]>::read(node).map(|a| Self(a.map(|x| x.0))),
            DeValue::Float(_) | DeValue::Integer(_) => Fraction::read(node).map(|x| Self([x.0; 2])),
            _ => Err(mismatch::<Self>(node)),
        }
    }
    fn one() -> String {
        format!("{} or {}", Fraction::one(), <[Fraction; 2]>::one())
    }
    fn many() -> String {
        Fraction::many()
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "anyOf": [Fraction::schema(defs), <[Fraction; 2]>::schema(defs)] })
    }
}

impl MaterialTable {
    /// The material. `at` is the place of its name.
    pub(super) fn build(
        &self,
        name: &str,
        at: &std::ops::Range<usize>,
        b: &mut Builder<'_>,
    ) -> Result<Material, Fault> {
        let mut material = Material::new(name, self.kind.build(at, b)?);
        material.interior = self.kind.interior()?;
        if let Some(radiance) = &self.emission {
            let coat = match &material.model {
                Model::MetallicRoughness(m) => m.layers.clearcoat.map(|coat| coat.factor),
                _ => None,
            };
            material.emission = Some(Emission { radiance: radiance.build(b)?, sides: self.emission_sides, coat });
        }
        if let Some(map) = &self.normal_map {
            material.normal_map = Some(map.build(b)?);
        }
        material.alpha = match (&self.opacity, self.opacity_cutoff) {
            (None, None) => Alpha::Opaque,
            (None, Some(_)) => return Err(Fault::new(at, "`opacity_cutoff` is given without `opacity`")),
            (Some(opacity), None) => Alpha::Blend { coverage: opacity.build(b)? },
            (Some(opacity), Some(cutoff)) => Alpha::Mask { coverage: opacity.build(b)?, cutoff: cutoff.0 },
        };
        Ok(material)
    }

    /// Whether there is more to it than how it scatters.
    pub(super) fn is_more_than_a_model(&self) -> bool {
        self.emission.is_some() || self.opacity.is_some() || self.normal_map.is_some()
    }
}

impl MaterialKind {
    /// The scattering model.
    pub(super) fn build(&self, at: &std::ops::Range<usize>, b: &mut Builder<'_>) -> Result<Model, Fault> {
        Ok(match self {
            Self::Diffuse(m) => {
                let reflectance = m.reflectance.build_base(b)?;
                match m.roughness.as_ref().map(|r| r.build(b)).transpose()? {
                    Some(roughness) if roughness != ScalarParam::constant(0.0) => {
                        Model::RoughDiffuse { reflectance, roughness }
                    }
                    _ => Model::Diffuse { reflectance },
                }
            }
            Self::Phong(m) => Model::Phong { reflectance: m.reflectance.build_base(b)?, exponent: m.exponent.0 },
            Self::Mirror(m) => Model::Mirror { reflectance: m.reflectance.build(b)? },
            Self::Dielectric(m) => {
                let roughness = roughness(m.roughness.as_ref(), m.alpha.as_ref(), b)?;
                let ior = interior::index(m.ior.as_ref(), m.cauchy.as_ref(), &mut m.interior.build()?)?;
                Model::Dielectric { ior, roughness, tint: m.tint.build(b)? }
            }
            Self::Conductor(m) => {
                let roughness = roughness(m.roughness.as_ref(), m.alpha.as_ref(), b)?;
                Model::Conductor { fresnel: m.fresnel(at, b)?, roughness }
            }
            Self::CookTorrance(m) => {
                let roughness = roughness(m.roughness.as_ref(), m.alpha.as_ref(), b)?;
                Model::CookTorrance { fresnel: m.fresnel(at, b)?, roughness }
            }
            Self::Mix(m) => m.build(b)?,
            Self::MetallicRoughnessTable(m) => m.build(b)?,
            Self::Absorb(_) => Model::Absorb,
        })
    }
}

impl MaterialKind {
    /// What it encloses; of a mixture nothing of its own.
    pub(super) fn interior(&self) -> Result<Interior, Fault> {
        match self {
            Self::Dielectric(m) => {
                let mut interior = m.interior.build()?;
                interior::index(m.ior.as_ref(), m.cauchy.as_ref(), &mut interior)?;
                Ok(interior)
            }
            Self::MetallicRoughnessTable(m) => m.interior.build(),
            _ => Ok(Interior::default()),
        }
    }
}

/// The roughness of `roughness` or `alpha`; smooth where neither is given.
fn roughness(
    perceptual: Option<&Scalar>,
    alpha: Option<&At<AlphaValue>>,
    b: &mut Builder<'_>,
) -> Result<Roughness, Fault> {
    match (perceptual, alpha) {
        (Some(_), Some(alpha)) => Err(Fault::new(&alpha.at, "`roughness` is given too; expected one of the two")),
        (Some(r), None) => Ok(Roughness::Perceptual(r.build(b)?)),
        (None, Some(alpha)) => Ok(Roughness::Alpha(alpha.value.0)),
        (None, None) => Ok(Roughness::Perceptual(ScalarParam::constant(0.0))),
    }
}

impl Conductor {
    fn fresnel(&self, at: &std::ops::Range<usize>, b: &mut Builder<'_>) -> Result<Fresnel, Fault> {
        match (&self.metal, self.eta, self.k, &self.reflectance) {
            (Some(metal), None, None, None) => metals::fresnel(&metal.value).ok_or_else(|| {
                let hint = suggest(&metal.value, metals::names());
                Fault::new(&metal.at, format!("unknown metal `{}`; {hint}", metal.value))
            }),
            (None, Some(eta), Some(k), None) => Ok(Fresnel::Complex { eta: eta.map(|x| x.0), k: k.map(|x| x.0) }),
            (None, None, None, Some(f0)) => Ok(Fresnel::Schlick { f0: f0.build(b)? }),
            _ => Err(Fault::new(at, "a conductor needs one of `metal`, `eta` with `k`, and `reflectance`")),
        }
    }
}

impl CookTorrance {
    fn fresnel(&self, at: &std::ops::Range<usize>, b: &mut Builder<'_>) -> Result<Fresnel, Fault> {
        let Self { metal, eta, k, reflectance, .. } = self.clone();
        match self.ior {
            // A dielectric is a conductor that does not absorb.
            Some(ior) if metal.is_none() && eta.is_none() && k.is_none() && reflectance.is_none() => {
                Ok(Fresnel::Complex { eta: [ior.0; 3], k: [0.0; 3] })
            }
            Some(_) => Err(Fault::new(at, "`ior` is given beside `metal`, `eta`, `k` or `reflectance`; expected one")),
            None => Conductor { metal, eta, k, reflectance, roughness: None, alpha: None }.fresnel(at, b),
        }
    }
}

impl Mix {
    fn build(&self, b: &mut Builder<'_>) -> Result<Model, Fault> {
        let sum: f64 = self.parts.value.iter().map(|p| f64::from(p.weight.0)).sum();
        // The written decimals are rounded, so that 0.7 + 0.2 + 0.1 may be an ulp above 1.
        if sum > 1.0 + 1e-6 {
            return Err(Fault::new(&self.parts.at, format!("the weights sum to {}, expected at most 1", sum as f32)));
        }
        let parts = self.parts.value.iter().map(|p| Ok((p.weight.0, b.model(&p.material)?)));
        Ok(Model::Mix(parts.collect::<Result<_, Fault>>()?))
    }
}

impl MetallicRoughnessTable {
    fn build(&self, b: &mut Builder<'_>) -> Result<Model, Fault> {
        let ior = self.ior.value.0;
        if ior < 1.0 {
            return Err(Fault::new(&self.ior.at, format!("`ior` is {ior}, expected at least 1")));
        }
        let transmission = match &self.transmission {
            None => None,
            Some(factor) => Some(Transmission { factor: factor.build(b)?, thin: self.thin }),
        };
        let diffuse_transmission = match &self.diffuse_transmission {
            None => None,
            Some(factor) => {
                let color = self.diffuse_transmission_color.build(b)?;
                Some(DiffuseTransmission { factor: factor.build(b)?, color, thin: self.thin })
            }
        };
        Ok(Model::MetallicRoughness(Box::new(MetallicRoughness {
            base_color: self.base_color.build_base(b)?,
            metallic: self.metallic.build(b)?,
            roughness: self.roughness.build(b)?,
            ior,
            specular: self.specular.build(b)?,
            specular_color: self.specular_color.build(b)?,
            transmission,
            layers: self.layers.build(b)?,
            diffuse_transmission,
            iridescence: self.film.as_ref().map(|film| film.build(b)).transpose()?,
        })))
    }
}
