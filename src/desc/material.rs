//! Materials as written: parameters, textures, and what they mean; lobes are made of them in `material/`.

use super::{Interior, Layers, TextureRef};

/// A surface material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name for messages.
    pub name: String,
    /// How it scatters.
    pub model: Model,
    /// Radiance that it emits.
    pub emission: Option<Emission>,
    /// Bump of the shading normal.
    pub normal_map: Option<NormalMap>,
    /// Coverage: what share of the surface is there at all.
    pub alpha: Alpha,
    /// What its closed surfaces enclose, where it refracts.
    pub interior: Interior,
    /// The back is shaded as the front (glTF). Opaque lobes are always two-sided in a path tracer; kept for reports.
    pub double_sided: bool,
}

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

/// Linear RGB: factor × texture × vertex colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorParam {
    /// Constant factor.
    pub factor: [f32; 3],
    /// RGB of this texture, if any.
    pub texture: Option<TextureRef>,
    /// Times RGB of the vertex colour where the mesh has one.
    pub vertex_color: bool,
}

/// A number: factor × one channel of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScalarParam {
    /// Constant factor.
    pub factor: f32,
    /// Texture and channel (0–3: R, G, B, A), if any.
    pub texture: Option<(TextureRef, usize)>,
}

/// Tangent-space normal map: n = (2 rgb − 1) × (scale, scale, 1), normalised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalMap {
    /// The texture, linear.
    pub texture: TextureRef,
    /// Factor on x and y.
    pub scale: f32,
}

/// Emitted radiance \[W·sr⁻¹·m⁻²\], the same in all directions of a side but for a coat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Linear RGB.
    pub radiance: ColorParam,
    /// Which side emits.
    pub sides: Sides,
    /// Share of the surface under a clear coat, which takes c F(θ) of the light (KHR_materials_clearcoat): F is Schlick's
    /// for the index 1.5, θ the angle to the geometric normal.
    pub coat: Option<ScalarParam>,
}

/// Sides of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// The side of the geometric normal.
    Front,
    /// Both.
    Both,
}

/// Coverage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alpha {
    /// All there.
    Opaque,
    /// There where the coverage (× vertex alpha) is at least `cutoff`.
    Mask {
        /// Coverage.
        coverage: ScalarParam,
        /// Threshold.
        cutoff: f32,
    },
    /// There with this probability (× vertex alpha).
    Blend {
        /// Coverage.
        coverage: ScalarParam,
    },
}

impl ColorParam {
    /// A constant.
    pub const fn constant(factor: [f32; 3]) -> Self {
        Self { factor, texture: None, vertex_color: false }
    }
}

impl ScalarParam {
    /// A constant.
    pub const fn constant(factor: f32) -> Self {
        Self { factor, texture: None }
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

impl Model {
    /// All its colours.
    fn colors_mut(&mut self) -> Vec<&mut ColorParam> {
        match self {
            Self::Diffuse { reflectance }
            | Self::RoughDiffuse { reflectance, .. }
            | Self::Phong { reflectance, .. }
            | Self::Mirror { reflectance } => vec![reflectance],
            Self::Dielectric { tint, .. } => vec![tint],
            Self::Conductor { fresnel, .. } | Self::CookTorrance { fresnel, .. } => match fresnel {
                Fresnel::Schlick { f0 } => vec![f0],
                Fresnel::Complex { .. } => Vec::new(),
            },
            Self::Absorb => Vec::new(),
            Self::Mix(parts) => parts.iter_mut().flat_map(|(_, model)| model.colors_mut()).collect(),
            Self::MetallicRoughness(m) => {
                let sheen = m.layers.sheen.as_mut().map(|sheen| &mut sheen.color);
                let through = m.diffuse_transmission.as_mut().map(|t| &mut t.color);
                [&mut m.base_color, &mut m.specular_color].into_iter().chain(sheen).chain(through).collect()
            }
            Self::SpecularGlossiness(m) => vec![&mut m.diffuse, &mut m.specular],
        }
    }
}

impl Material {
    /// Where no mesh has vertex colours, nothing varies with them.
    pub fn ignore_vertex_colors(&mut self) {
        let emitted = self.emission.as_mut().map(|e| &mut e.radiance);
        for color in self.model.colors_mut().into_iter().chain(emitted) {
            color.vertex_color = false;
        }
    }

    /// A material of this model, without emission, maps or holes.
    pub fn new(name: impl Into<String>, model: Model) -> Self {
        Self {
            name: name.into(),
            model,
            emission: None,
            normal_map: None,
            alpha: Alpha::Opaque,
            interior: Interior::default(),
            double_sided: true,
        }
    }
}
