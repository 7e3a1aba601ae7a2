//! Materials as written: parameters, textures, and what they mean; lobes are made of them in `material/`.

use super::parameter::Value;
use super::{Interior, Model, TextureRef};

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

impl Emission {
    /// It may emit: its factor is not black.
    pub fn is_light(&self) -> bool {
        self.radiance.factor.iter().any(|x| *x > 0.0)
    }
}

impl Material {
    /// Where no mesh has vertex colours, nothing varies with them.
    pub fn ignore_vertex_colors(&mut self) {
        self.visit(&mut |parameter| {
            if let Value::Color(color) = parameter.value {
                color.vertex_color = false;
            }
        });
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
