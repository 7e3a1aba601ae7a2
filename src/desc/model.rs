//! Scattering models as written: which there are, and what of each can be said without its numbers.
//!
//! A new model is a variant of [`Model`] with its kind, its parameters in [`super::parameter`], its specimen in
//! [`super::specimens`], its lobes in `material/` and its keys in `toml/`; an exporter needs an arm only where its target
//! has an equal.

use super::parameter::{Role, Value};
use super::{ColorParam, Layers, ScalarParam, TextureRef};

/// The scattering model.
#[derive(Clone, Debug, PartialEq)]
pub enum Model {
    /// Lambert.
    Diffuse {
        /// Albedo ρ, linear RGB in [0, 1].
        reflectance: ColorParam,
    },
    /// Rough diffuse, after Oren & Nayar: EON (Portsmouth, Kutz & Hill 2024).
    RoughDiffuse {
        /// Parameter ρ, the albedo of a smooth one, linear RGB in [0, 1].
        reflectance: ColorParam,
        /// In [0, 1]; 0: Lambert.
        roughness: ScalarParam,
    },
    /// Phong's lobe, normalised.
    Phong {
        /// Albedo at normal incidence, linear RGB in [0, 1].
        reflectance: ColorParam,
        /// Exponent of the cosine, at least 0.
        exponent: f32,
    },
    /// Perfect mirror of constant reflectance.
    Mirror {
        /// Share reflected, linear RGB.
        reflectance: ColorParam,
    },
    /// Interface between two dielectrics, reflecting and refracting.
    Dielectric {
        /// Index of refraction inside (behind the normal) over outside.
        ior: f32,
        /// 0: smooth.
        roughness: Roughness,
        /// Factor on what is transmitted; 1 is physical.
        tint: ColorParam,
    },
    /// Metal.
    Conductor {
        /// Its reflectance over angle.
        fresnel: Fresnel,
        /// 0: smooth.
        roughness: Roughness,
    },
    /// Cook and Torrance's microfacets: Beckmann's distribution of normals, and else as a conductor.
    CookTorrance {
        /// Its reflectance over angle.
        fresnel: Fresnel,
        /// 0: smooth.
        roughness: Roughness,
    },
    /// Constant-weight mixture, f = Σ wᵢ fᵢ; the weights sum to at most 1 (the rest absorbs).
    Mix(Vec<(f32, Model)>),
    /// glTF's metallic-roughness model with the extensions honoured.
    MetallicRoughness(Box<MetallicRoughness>),
    /// glTF's KHR_materials_pbrSpecularGlossiness.
    SpecularGlossiness(Box<SpecularGlossiness>),
    /// Scatters nothing: black (emitters, unlit).
    Absorb,
}

/// Reflectance of a conductor over the angle.
#[derive(Clone, Debug, PartialEq)]
pub enum Fresnel {
    /// Complex index of refraction η − iκ per RGB lane, over the outside.
    Complex {
        /// Real part.
        eta: [f32; 3],
        /// Extinction κ.
        k: [f32; 3],
    },
    /// Schlick's approximation with grazing reflectance 1.
    Schlick {
        /// Reflectance at normal incidence.
        f0: ColorParam,
    },
}

/// GGX roughness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Roughness {
    /// Perceptual roughness r in [0, 1]: α = r² both ways. α below 1e-4 is a smooth interface.
    Perceptual(ScalarParam),
    /// Glossiness g in [0, 1]: the perceptual roughness is 1 − g.
    Glossiness(ScalarParam),
    /// α along the tangent and the bitangent, constant.
    Alpha([f32; 2]),
    /// KHR_materials_anisotropy: α = mix(r², 1, strength²) along the direction, r² across it.
    Stretched {
        /// Perceptual roughness r.
        roughness: ScalarParam,
        /// Strength in [0, 1].
        strength: ScalarParam,
    },
}

/// glTF 2.0, section 3.9 and appendix B.
#[derive(Clone, Debug, PartialEq)]
pub struct MetallicRoughness {
    /// Base colour.
    pub base_color: ColorParam,
    /// Metalness.
    pub metallic: ScalarParam,
    /// Perceptual roughness; α = r².
    pub roughness: ScalarParam,
    /// KHR_materials_ior; 1.5 without. 0 stands for F0 = 1.
    pub ior: f32,
    /// KHR_materials_specular: factor on the dielectric reflection; 1 without.
    pub specular: ScalarParam,
    /// KHR_materials_specular: colour of the dielectric F0; white without.
    pub specular_color: ColorParam,
    /// KHR_materials_transmission, with KHR_materials_volume deciding whether it is thin.
    pub transmission: Option<Transmission>,
    /// Anisotropy, sheen and clear coat.
    pub layers: Layers,
    /// KHR_materials_diffuse_transmission.
    pub diffuse_transmission: Option<DiffuseTransmission>,
    /// KHR_materials_iridescence.
    pub iridescence: Option<Iridescence>,
}

/// KHR_materials_pbrSpecularGlossiness: a diffuse base under GGX with Schlick's Fresnel.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecularGlossiness {
    /// Albedo of the base.
    pub diffuse: ColorParam,
    /// Reflectance at normal incidence.
    pub specular: ColorParam,
    /// 1 − perceptual roughness.
    pub glossiness: ScalarParam,
}

/// KHR_materials_iridescence: a film whose two faces interfere lies on the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iridescence {
    /// Share of the surface that is under the film.
    pub factor: ScalarParam,
    /// Index of refraction of the film, at least 1.
    pub ior: f32,
    /// Thickness \[nm\] where the texture is 0, and where it is 1 or there is none.
    pub thickness: [f32; 2],
    /// What the thickness is interpolated by: a texture and its channel.
    pub thickness_texture: Option<(TextureRef, usize)>,
}

/// KHR_materials_transmission.
#[derive(Clone, Debug, PartialEq)]
pub struct Transmission {
    /// Share of the diffuse base that is transmitted instead.
    pub factor: ScalarParam,
    /// True: an infinitely thin sheet that does not bend light; false (KHR_materials_volume with thickness): refracts.
    pub thin: bool,
}

/// KHR_materials_diffuse_transmission: what of the diffuse base is not transmitted otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct DiffuseTransmission {
    /// Share of the diffuse base that transmits instead of reflecting.
    pub factor: ScalarParam,
    /// Colour of what it transmits.
    pub color: ColorParam,
    /// True: a sheet; false (KHR_materials_volume with thickness): the surface of a volume.
    pub thin: bool,
}

impl Default for MetallicRoughness {
    /// A white dielectric of index 1.5, as rough as can be, without extensions.
    fn default() -> Self {
        Self {
            base_color: ColorParam::constant([1.0; 3]),
            metallic: ScalarParam::constant(0.0),
            roughness: ScalarParam::constant(1.0),
            ior: 1.5,
            specular: ScalarParam::constant(1.0),
            specular_color: ColorParam::constant([1.0; 3]),
            transmission: None,
            layers: Layers::default(),
            diffuse_transmission: None,
            iridescence: None,
        }
    }
}

impl MetallicRoughness {
    /// Light passes into a volume behind the surface.
    pub fn encloses(&self) -> bool {
        self.refracts() || self.diffuse_transmission.as_ref().is_some_and(|t| !t.thin && t.factor.factor > 0.0)
    }

    /// Some of that is refracted at the surface.
    pub fn refracts(&self) -> bool {
        self.transmission.as_ref().is_some_and(|t| !t.thin && t.factor.factor > 0.0)
    }
}

/// Names the variants: `kind` and the list of all kinds come of one table, so that neither forgets one.
macro_rules! kinds {
    ($($pattern:pat => $kind:literal,)*) => {
        impl Model {
            /// Every kind of model, by the name that [`kind`](Self::kind) gives it.
            pub const KINDS: &[&str] = &[$($kind),*];

            /// Name of the variant: `"rough diffuse"`.
            pub fn kind(&self) -> &'static str {
                match self {
                    $($pattern => $kind,)*
                }
            }
        }
    };
}

kinds! {
    Self::Diffuse { .. } => "diffuse",
    Self::RoughDiffuse { .. } => "rough diffuse",
    Self::Phong { .. } => "Phong",
    Self::Mirror { .. } => "mirror",
    Self::Dielectric { .. } => "dielectric",
    Self::Conductor { .. } => "conductor",
    Self::CookTorrance { .. } => "Cook-Torrance",
    Self::Mix(_) => "mix",
    Self::MetallicRoughness(_) => "metallic-roughness",
    Self::SpecularGlossiness(_) => "specular-glossiness",
    Self::Absorb => "absorb",
}

impl Model {
    /// Index of refraction of the volume behind the surface, over vacuum; `None` where light enters none: opaque
    /// surfaces, metals, thin sheets. Of a mixture that of its first part that has one.
    pub fn interior_index(&self) -> Option<f32> {
        match self {
            Self::Dielectric { ior, .. } => Some(*ior),
            Self::MetallicRoughness(m) => m.encloses().then_some(m.ior),
            Self::Mix(parts) => parts.iter().filter(|(weight, _)| *weight > 0.0).find_map(|(_, m)| m.interior_index()),
            _ => None,
        }
        .filter(|n| *n > 0.0 && n.is_finite())
    }

    /// Some of the light is bent on its way through, so that the two sides differ and there must be a way out.
    pub fn refracts(&self) -> bool {
        match self {
            Self::Dielectric { .. } => true,
            Self::MetallicRoughness(m) => m.refracts(),
            Self::Mix(parts) => parts.iter().any(|(weight, part)| *weight > 0.0 && part.refracts()),
            _ => false,
        }
    }

    /// The model made lossless: every [`Role::Albedo`] is 1 and mixtures are filled up to 1, so that it scatters all that
    /// it receives; widths, indices and shares stay. `None` for models that absorb whatever their parameters are.
    pub fn lossless(&self) -> Option<Self> {
        let mut model = self.clone();
        match &mut model {
            // Of Phong's lobe a part is below the horizon.
            Self::Absorb | Self::Phong { .. } => return None,
            Self::Mix(parts) => {
                parts.retain(|(_, part)| part.lossless().is_some());
                let sum: f32 = parts.iter().map(|(weight, _)| weight).sum();
                if parts.is_empty() || sum.is_nan() || sum <= 0.0 {
                    return None;
                }
                for (weight, part) in parts {
                    *weight /= sum;
                    *part = part.lossless()?;
                }
                return Some(model);
            }
            Self::Conductor { fresnel, .. } | Self::CookTorrance { fresnel, .. } => {
                *fresnel = Fresnel::Schlick { f0: ColorParam::constant([1.0; 3]) };
            }
            Self::MetallicRoughness(m) => {
                (m.layers.sheen, m.layers.clearcoat) = (None, None);
                // A base under a film whose fringes are too many for its series is coupled to more than the film reflects.
                m.iridescence = None;
                // Of what passes diffusely into a thinner medium only 1/η² does.
                if m.refracts() {
                    m.diffuse_transmission = None;
                }
            }
            _ => {}
        }
        model.visit(&mut |parameter| {
            if let (Role::Albedo, Value::Color(color)) = (parameter.role, parameter.value) {
                *color = ColorParam::constant([1.0; 3]);
            }
        });
        Some(model)
    }

    /// The plainer model that stands for one which a target of export has no arm for, and what is lost.
    pub fn plainer(&self) -> (Self, &'static str) {
        match self {
            Self::RoughDiffuse { reflectance, .. } => {
                (Self::Diffuse { reflectance: *reflectance }, "no rough diffuse surface; this one is smooth (Lambert)")
            }
            _ => (Self::Absorb, "nothing like its model; it is black"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mixtures_are_filled_up() {
        let grey = ColorParam::constant([0.5; 3]);
        let mix = Model::Mix(vec![
            (0.2, Model::Diffuse { reflectance: grey }),
            (0.3, Model::Mirror { reflectance: grey }),
            (0.5, Model::Absorb),
        ]);
        let Some(Model::Mix(parts)) = mix.lossless() else { panic!("a mixture stays one") };
        assert_eq!(parts.iter().map(|(w, _)| *w).collect::<Vec<_>>(), [0.4, 0.6]);
        assert_eq!(parts[0].1, Model::Diffuse { reflectance: ColorParam::constant([1.0; 3]) });
        assert_eq!(Model::Mix(vec![(1.0, Model::Absorb)]).lossless(), None);
    }
}
