//! `[material.NAME]`.

use super::build::Builder;
use super::color::{Radiance, Reflectance, Scalar};
use super::conductor::{Conductor, CookTorrance};
use super::gltf_models::{MetallicRoughnessTable, SpecularGlossinessTable};
use super::interior::InteriorTable;
use super::keys::{keys, one_of};
use super::mix::Mix;
use super::normal_map::NormalMapValue;
use super::number::{NonNegative, Positive};
use super::read::{At, Fault};
use super::roughness::RoughnessTable;
use super::words::words;
use super::writer::Names;
use crate::desc::{Alpha, Emission, Interior, Material, Model, ScalarParam, Sides};
use std::ops::Range;

keys! {
    /// A surface material.
    struct MaterialTable {
        /// Name for messages. Default: that of the table.
        name: Option<String>,
        /// Radiance that the surface emits in W/(sr m²), the same in all directions. Default: none.
        emission: Option<Radiance>,
        /// Which side emits: "front" or "both". Default "front".
        emission_sides: Sides = Sides::Front,
        /// Share of the surface under a clear coat, which takes some of the emitted light, a number in [0, 1] or a texture. Default: the material's `clearcoat`.
        emission_coat: Option<Scalar>,
        /// Share of the surface that is there: a number in [0, 1] or a texture. Default 1.
        opacity: Option<Scalar>,
        /// With it, the surface is there wherever the opacity is at least this. Default: there with the opacity as probability.
        opacity_cutoff: Option<NonNegative>,
        /// Tangent-space normal map: the name of a texture, or { texture = "name", scale = 1 }.
        normal_map: Option<NormalMapValue>,
        /// Whether glTF calls the surface double-sided. It makes no difference to the image. Default true.
        double_sided: bool = true,
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
        "specular-glossiness" => SpecularGlossinessTable,
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
        reflectance: Reflectance = Reflectance::one_everywhere(),
    }
}

keys! {
    /// Clear interface that reflects and refracts: glass, water.
    struct Dielectric {
        /// Index of refraction behind the surface, over vacuum; what the surface lies in is known from the path. Default 1.5.
        ior: Option<At<Positive>>,
        /// Factor on what is transmitted, each channel in [0, 1]. Default 1.
        tint: Reflectance = Reflectance::one_everywhere(),
        ..surface: RoughnessTable,
        ..interior: InteriorTable,
    }
}

keys! {
    /// Scatters nothing: black.
    struct Absorb {
    }
}

words! { Sides: "front" => Sides::Front, "both" => Sides::Both; }

impl MaterialTable {
    /// The material. `at` is the place of its name.
    pub(super) fn build(&self, name: &str, at: &Range<usize>, b: &mut Builder<'_>) -> Result<Material, Fault> {
        let name = self.name.as_deref().unwrap_or(name);
        let mut material = Material::new(name, self.kind.build(at, b)?);
        material.interior = self.kind.interior()?;
        material.double_sided = self.double_sided;
        if let Some(radiance) = &self.emission {
            let coat = match &self.emission_coat {
                // A share of 0 says that there is none.
                Some(coat) => Some(coat.build(b)?).filter(|coat| *coat != ScalarParam::constant(0.0)),
                None => own_coat(&material.model),
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

    /// The inverse of [`Self::build`]; `name` is that of the table.
    pub(super) fn of(material: &Material, name: &str, names: &Names) -> Self {
        let Material { name: own, model, emission, normal_map, alpha, interior, double_sided } = material;
        let (opacity, opacity_cutoff) = match alpha {
            Alpha::Opaque => (None, None),
            Alpha::Blend { coverage } => (Some(coverage), None),
            Alpha::Mask { coverage, cutoff } => (Some(coverage), Some(NonNegative(*cutoff))),
        };
        let coat = emission.map(|e| e.coat).filter(|coat| *coat != own_coat(model));
        let coat = coat.map(|coat| coat.unwrap_or(ScalarParam::constant(0.0)));
        Self {
            name: (own != name).then(|| own.clone()),
            emission: emission.map(|e| Radiance::of(&e.radiance, names)),
            emission_sides: emission.map_or(Sides::Front, |e| e.sides),
            emission_coat: coat.map(|coat| Scalar::of(&coat, names)),
            opacity: opacity.map(|coverage| Scalar::of(coverage, names)),
            opacity_cutoff,
            normal_map: normal_map.map(|map| NormalMapValue::of(&map, names)),
            double_sided: *double_sided,
            kind: MaterialKind::of(model, interior, names),
        }
    }

    /// Whether there is more to it than how it scatters.
    pub(super) fn is_more_than_a_model(&self) -> bool {
        self.emission.is_some() || self.opacity.is_some() || self.normal_map.is_some()
    }
}

/// The coat of a model, through which the light of its surface passes too.
fn own_coat(model: &Model) -> Option<ScalarParam> {
    match model {
        Model::MetallicRoughness(m) => m.layers.clearcoat.map(|coat| coat.factor),
        _ => None,
    }
}

impl MaterialKind {
    /// The scattering model. `at` is the place of the material's name.
    pub(super) fn build(&self, at: &Range<usize>, b: &mut Builder<'_>) -> Result<Model, Fault> {
        Ok(match self {
            Self::Diffuse(m) => {
                let reflectance = m.reflectance.build_base(b)?;
                match m.roughness.as_ref().map(|r| r.build(b)).transpose()? {
                    Some(roughness) => Model::RoughDiffuse { reflectance, roughness },
                    None => Model::Diffuse { reflectance },
                }
            }
            Self::Phong(m) => Model::Phong { reflectance: m.reflectance.build_base(b)?, exponent: m.exponent.0 },
            Self::Mirror(m) => Model::Mirror { reflectance: m.reflectance.build(b)? },
            Self::Dielectric(m) => {
                let roughness = m.surface.build(b)?;
                Model::Dielectric { ior: m.interior.index(m.ior.as_ref())?, roughness, tint: m.tint.build(b)? }
            }
            Self::Conductor(m) => m.build(at, b)?,
            Self::CookTorrance(m) => m.build(at, b)?,
            Self::Mix(m) => m.build(b)?,
            Self::MetallicRoughnessTable(m) => m.build(b)?,
            Self::SpecularGlossinessTable(m) => m.build(b)?,
            Self::Absorb(_) => Model::Absorb,
        })
    }

    /// What it encloses; of models that nothing enters nothing.
    pub(super) fn interior(&self) -> Result<Interior, Fault> {
        match self {
            Self::Dielectric(Dielectric { interior, .. })
            | Self::MetallicRoughnessTable(MetallicRoughnessTable { interior, .. })
            | Self::Mix(Mix { interior, .. }) => interior.build(),
            _ => Ok(Interior::default()),
        }
    }

    /// The inverse of [`Self::build`] and [`Self::interior`].
    pub(super) fn of(model: &Model, interior: &Interior, names: &Names) -> Self {
        match model {
            Model::Diffuse { reflectance } => {
                Self::Diffuse(Diffuse { reflectance: Reflectance::of_base(reflectance, names), roughness: None })
            }
            Model::RoughDiffuse { reflectance, roughness } => Self::Diffuse(Diffuse {
                reflectance: Reflectance::of_base(reflectance, names),
                roughness: Some(Scalar::of(roughness, names)),
            }),
            Model::Phong { reflectance, exponent } => Self::Phong(Phong {
                reflectance: Reflectance::of_base(reflectance, names),
                exponent: NonNegative(*exponent),
            }),
            Model::Mirror { reflectance } => Self::Mirror(Mirror { reflectance: Reflectance::of(reflectance, names) }),
            Model::Dielectric { ior, roughness, tint } => {
                let interior = InteriorTable::of(interior);
                let ior = interior.ior_of(*ior).map(|ior| At::nowhere(Positive(ior)));
                let surface = RoughnessTable::of(roughness, names);
                Self::Dielectric(Dielectric { ior, tint: Reflectance::of(tint, names), surface, interior })
            }
            Model::Conductor { fresnel, roughness } => Self::Conductor(Conductor::of(fresnel, roughness, names)),
            Model::CookTorrance { fresnel, roughness } => {
                Self::CookTorrance(CookTorrance::of(fresnel, roughness, names))
            }
            Model::Mix(parts) => Self::Mix(Mix::of(parts, interior, names)),
            Model::MetallicRoughness(m) => Self::MetallicRoughnessTable(MetallicRoughnessTable::of(m, interior, names)),
            Model::SpecularGlossiness(m) => Self::SpecularGlossinessTable(SpecularGlossinessTable::of(m, names)),
            Model::Absorb => Self::Absorb(Absorb {}),
        }
    }
}
