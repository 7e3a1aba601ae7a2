//! One visitor over the parameters of a material: whoever places, whitens, scans, prints, draws or writes materials goes
//! through it, and so meets the parameters of a new model without knowing it.
//!
//! A parameter says what it is called, where it may lie, what it is where nothing is said, what it is to its model, and
//! lends its value. [`Material::visit`] lends it to be changed; [`Material::scan`] only to be read.

use super::{
    Alpha, ColorParam, Dispersion, Emission, Fresnel, Interior, Layers, Material, MetallicRoughness, Model, NormalMap,
    Roughness, ScalarParam, TextureRef,
};

/// A parameter of a material, lent by [`Material::visit`] or [`Material::scan`].
#[derive(Debug, PartialEq)]
pub struct Parameter<'a> {
    /// In words, and unique in its model but for the parts of a mixture: `"roughness of the coat"`.
    pub name: &'static str,
    /// What it does.
    pub role: Role,
    /// Where its constant factor must lie, each channel alike.
    pub bounds: Bounds,
    /// Its constant factor where a TOML scene says nothing, each channel alike.
    pub default: f32,
    /// What it is.
    pub value: Value<'a>,
}

/// The value of a parameter.
#[derive(Debug, PartialEq)]
pub enum Value<'a> {
    /// Linear RGB that may vary over the surface.
    Color(&'a mut ColorParam),
    /// A number that may vary over the surface.
    Scalar(&'a mut ScalarParam),
    /// Linear RGB, the same everywhere.
    Rgb(&'a mut [f32; 3]),
    /// A number, the same everywhere.
    Number(&'a mut f32),
    /// One channel of a texture, which interpolates between two numbers.
    Between(&'a mut Option<(TextureRef, usize)>),
    /// A texture of directions in the tangent plane.
    Directions(&'a mut Option<TextureRef>),
    /// A map of normals.
    Normals(&'a mut Option<NormalMap>),
}

/// What a parameter is to its model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A share of what is scattered: where it is 1 in all channels, the lobe that it belongs to absorbs nothing.
    Albedo,
    /// Width of a microsurface, given as this.
    Width(Width),
    /// Weight of a part of a mixture; together at most 1.
    Weight,
    /// Anything else that shapes how the surface scatters.
    Shape,
    /// No part of how the surface scatters: emission, coverage, its interior.
    Beside,
}

/// What a number says of the width α of a microsurface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// Perceptual roughness r: α = r².
    Perceptual,
    /// Glossiness g: α = (1 − g)².
    Glossiness,
    /// α itself.
    Alpha,
    /// Exponent n of a cosine lobe, as wide as a microsurface of α² = 2/(n + 2).
    Exponent,
}

/// Closed interval in which a parameter must lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least that means something.
    pub least: f32,
    /// The greatest; infinite where any number will do.
    pub most: f32,
    /// Least and greatest of what occurs in practice, where random scenes draw.
    pub usual: [f32; 2],
}

impl Bounds {
    /// Shares and roughnesses, which are clamped to [0, 1].
    pub const SHARE: Self = Self::new(0.0, 1.0, [0.0, 1.0]);

    const fn new(least: f32, most: f32, usual: [f32; 2]) -> Self {
        Self { least, most, usual }
    }

    /// At least 0, usually up to `usual`.
    const fn not_negative(usual: f32) -> Self {
        Self::new(0.0, f32::INFINITY, [0.0, usual])
    }

    /// Above 0, usually within `usual`.
    const fn positive(usual: [f32; 2]) -> Self {
        Self::new(f32::MIN_POSITIVE, f32::INFINITY, usual)
    }

    /// Whether a number lies within, and is finite.
    pub fn contain(&self, x: f32) -> bool {
        x.is_finite() && self.least <= x && x <= self.most
    }

    /// In words: "a number in [0, 1], to which it is clamped".
    pub fn in_words(&self) -> &'static str {
        match self {
            Self { most: 1.0, .. } => "a number in [0, 1], to which it is clamped",
            Self { least: 0.0, .. } => "a number ≥ 0",
            Self { least: f32::NEG_INFINITY, .. } => "a finite number",
            _ => "a positive number",
        }
    }
}

impl Width {
    /// α of a number.
    pub fn alpha(self, x: f32) -> f32 {
        match self {
            Self::Perceptual => x * x,
            Self::Glossiness => (1.0 - x) * (1.0 - x),
            Self::Alpha => x,
            Self::Exponent => (2.0 / (x.max(0.0) + 2.0)).sqrt(),
        }
    }
}

impl Value<'_> {
    /// The texture that it reads.
    pub fn texture(&self) -> Option<TextureRef> {
        match self {
            Self::Color(color) => color.texture,
            Self::Scalar(scalar) => scalar.texture.map(|t| t.0),
            Self::Between(texture) => texture.map(|t| t.0),
            Self::Directions(texture) => **texture,
            Self::Normals(map) => map.map(|map| map.texture),
            Self::Rgb(_) | Self::Number(_) => None,
        }
    }

    /// The texture that it reads, to be changed.
    pub fn texture_mut(&mut self) -> Option<&mut TextureRef> {
        match self {
            Self::Color(color) => color.texture.as_mut(),
            Self::Scalar(scalar) => scalar.texture.as_mut().map(|t| &mut t.0),
            Self::Between(texture) => texture.as_mut().map(|t| &mut t.0),
            Self::Directions(texture) => texture.as_mut(),
            Self::Normals(map) => map.as_mut().map(|map| &mut map.texture),
            Self::Rgb(_) | Self::Number(_) => None,
        }
    }

    /// Its constant factors: one, three, or none of what is a texture alone.
    pub fn factors(&mut self) -> &mut [f32] {
        match self {
            Self::Color(color) => &mut color.factor,
            Self::Scalar(scalar) => std::slice::from_mut(&mut scalar.factor),
            Self::Rgb(rgb) => &mut rgb[..],
            Self::Number(number) => std::slice::from_mut(number),
            Self::Between(_) | Self::Directions(_) | Self::Normals(_) => &mut [],
        }
    }
}

/// Who is called with each parameter.
pub type Visitor<'v> = &'v mut dyn FnMut(Parameter<'_>);

impl Material {
    /// Lends every parameter, in a fixed order: those of the model first, then normal map, emission, coverage, interior.
    pub fn visit(&mut self, visitor: Visitor) {
        self.model.visit(visitor);
        shape(visitor, "normal map", Bounds::SHARE, 1.0, Value::Normals(&mut self.normal_map));
        if let Some(emission) = &mut self.emission {
            emission.visit(visitor);
        }
        if let Alpha::Mask { coverage, .. } | Alpha::Blend { coverage } = &mut self.alpha {
            beside(visitor, "opacity", Bounds::SHARE, 1.0, Value::Scalar(coverage));
        }
        if let Alpha::Mask { cutoff, .. } = &mut self.alpha {
            beside(visitor, "least opacity that is there", Bounds::SHARE, 0.5, Value::Number(cutoff));
        }
        if self.model.interior_index().is_some() {
            self.interior.visit(visitor);
        }
    }

    /// Shows every parameter in the order of [`visit`](Self::visit). What is lent belongs to a copy.
    pub fn scan(&self, visitor: Visitor) {
        self.clone().visit(visitor);
    }

    /// All textures that it reads, with repetitions.
    pub fn textures(&self) -> Vec<TextureRef> {
        let mut found = Vec::new();
        self.scan(&mut |parameter| found.extend(parameter.value.texture()));
        found
    }
}

impl Emission {
    /// Lends the parameters of an emission, as [`Material::visit`].
    pub fn visit(&mut self, visitor: Visitor) {
        beside(visitor, "emission", Bounds::not_negative(4.0), 0.0, Value::Color(&mut self.radiance));
        if let Some(coat) = &mut self.coat {
            beside(visitor, "coat over the emission", Bounds::SHARE, 0.0, Value::Scalar(coat));
        }
    }
}

impl Interior {
    fn visit(&mut self, visitor: Visitor) {
        beside(visitor, "absorption", Bounds::not_negative(2.0), 0.0, Value::Rgb(&mut self.absorption));
        match &mut self.dispersion {
            Dispersion::None => {}
            Dispersion::InverseAbbe(inverse) => {
                beside(visitor, "inverse Abbe number", Bounds::not_negative(0.05), 0.0, Value::Number(inverse));
            }
            Dispersion::Cauchy([a, b]) => {
                beside(visitor, "Cauchy's A", Bounds::positive([1.3, 1.8]), 1.5, Value::Number(a));
                let any = Bounds::new(f32::NEG_INFINITY, f32::INFINITY, [0.0, 0.015]);
                beside(visitor, "Cauchy's B", any, 0.0, Value::Number(b));
            }
        }
    }
}

impl Model {
    /// Lends every parameter of the model, as [`Material::visit`]; of a mixture the weights and parameters of its parts.
    pub fn visit(&mut self, v: Visitor) {
        match self {
            Self::Absorb => {}
            Self::Diffuse { reflectance } | Self::Mirror { reflectance } => albedo(v, "reflectance", reflectance),
            Self::RoughDiffuse { reflectance, roughness } => {
                albedo(v, "reflectance", reflectance);
                share(v, "roughness", 0.0, roughness);
            }
            Self::Phong { reflectance, exponent } => {
                albedo(v, "reflectance", reflectance);
                let bounds = Bounds::not_negative(500.0);
                width(v, "exponent", Width::Exponent, bounds, Value::Number(exponent));
            }
            Self::Dielectric { ior, roughness, tint } => {
                let bounds = Bounds::positive([1.05, 2.4]);
                shape(v, "index of refraction", bounds, 1.5, Value::Number(ior));
                roughness.visit(v);
                albedo(v, "tint", tint);
            }
            Self::Conductor { fresnel, roughness } | Self::CookTorrance { fresnel, roughness } => {
                roughness.visit(v);
                match fresnel {
                    Fresnel::Schlick { f0 } => albedo(v, "reflectance", f0),
                    Fresnel::Complex { eta, k } => {
                        shape(v, "η", Bounds::positive([0.1, 3.0]), 1.0, Value::Rgb(eta));
                        shape(v, "κ", Bounds::not_negative(7.0), 0.0, Value::Rgb(k));
                    }
                }
            }
            Self::Mix(parts) => {
                for (weight, part) in parts {
                    let value = Value::Number(weight);
                    v(Parameter { name: "weight", role: Role::Weight, bounds: Bounds::SHARE, default: 0.0, value });
                    part.visit(v);
                }
            }
            Self::MetallicRoughness(m) => m.visit(v),
            Self::SpecularGlossiness(m) => {
                albedo(v, "diffuse", &mut m.diffuse);
                shape(v, "specular", Bounds::SHARE, 1.0, Value::Color(&mut m.specular));
                width(v, "glossiness", Width::Glossiness, Bounds::SHARE, Value::Scalar(&mut m.glossiness));
            }
        }
    }
}

impl Roughness {
    fn visit(&mut self, v: Visitor) {
        match self {
            Self::Perceptual(p) => width(v, "roughness", Width::Perceptual, Bounds::SHARE, Value::Scalar(p)),
            Self::Glossiness(p) => width(v, "glossiness", Width::Glossiness, Bounds::SHARE, Value::Scalar(p)),
            Self::Alpha([along, across]) => {
                width(v, "α", Width::Alpha, Bounds::SHARE, Value::Number(along));
                width(v, "α of the bitangent", Width::Alpha, Bounds::SHARE, Value::Number(across));
            }
            Self::Stretched { roughness, strength } => {
                width(v, "roughness", Width::Perceptual, Bounds::SHARE, Value::Scalar(roughness));
                share(v, "anisotropy", 0.0, strength);
            }
        }
    }
}

impl MetallicRoughness {
    fn visit(&mut self, v: Visitor) {
        albedo(v, "base colour", &mut self.base_color);
        share(v, "metalness", 0.0, &mut self.metallic);
        width(v, "roughness", Width::Perceptual, Bounds::SHARE, Value::Scalar(&mut self.roughness));
        // An index of 0 stands for total reflection (KHR_materials_ior).
        let index = Bounds { usual: [1.05, 2.4], ..Bounds::not_negative(2.4) };
        shape(v, "index of refraction", index, 1.5, Value::Number(&mut self.ior));
        share(v, "specular", 1.0, &mut self.specular);
        shape(v, "specular colour", Bounds::not_negative(1.0), 1.0, Value::Color(&mut self.specular_color));
        if let Some(transmission) = &mut self.transmission {
            share(v, "transmission", 0.0, &mut transmission.factor);
        }
        if let Some(through) = &mut self.diffuse_transmission {
            share(v, "diffuse transmission", 0.0, &mut through.factor);
            albedo(v, "diffuse transmission colour", &mut through.color);
        }
        self.layers.visit(v);
        if let Some(film) = &mut self.iridescence {
            share(v, "iridescence", 0.0, &mut film.factor);
            shape(v, "index of the film", Bounds::positive([1.0, 2.5]), 1.3, Value::Number(&mut film.ior));
            let [thin, thick] = &mut film.thickness;
            let nanometres = Bounds::not_negative(1000.0);
            shape(v, "least thickness of the film", nanometres, 100.0, Value::Number(thin));
            shape(v, "thickness of the film", nanometres, 400.0, Value::Number(thick));
            let between = Value::Between(&mut film.thickness_texture);
            shape(v, "texture of the film's thickness", Bounds::SHARE, 1.0, between);
        }
    }
}

impl Layers {
    fn visit(&mut self, v: Visitor) {
        if let Some(anisotropy) = &mut self.anisotropy {
            share(v, "anisotropy", 0.0, &mut anisotropy.strength);
            let angle = Bounds::new(f32::NEG_INFINITY, f32::INFINITY, [-3.15, 3.15]);
            shape(v, "rotation of the anisotropy", angle, 0.0, Value::Number(&mut anisotropy.rotation));
            let directions = Value::Directions(&mut anisotropy.direction);
            shape(v, "directions of the anisotropy", Bounds::SHARE, 1.0, directions);
        }
        if let Some(sheen) = &mut self.sheen {
            shape(v, "sheen", Bounds::SHARE, 0.0, Value::Color(&mut sheen.color));
            share(v, "roughness of the sheen", 0.0, &mut sheen.roughness);
        }
        if let Some(coat) = &mut self.clearcoat {
            share(v, "coat", 0.0, &mut coat.factor);
            let roughness = Value::Scalar(&mut coat.roughness);
            width(v, "roughness of the coat", Width::Perceptual, Bounds::SHARE, roughness);
            shape(v, "normal map of the coat", Bounds::SHARE, 1.0, Value::Normals(&mut coat.normal_map));
        }
    }
}

fn albedo(visitor: Visitor, name: &'static str, color: &mut ColorParam) {
    let value = Value::Color(color);
    visitor(Parameter { name, role: Role::Albedo, bounds: Bounds::SHARE, default: 1.0, value });
}

fn width(visitor: Visitor, name: &'static str, width: Width, bounds: Bounds, value: Value<'_>) {
    visitor(Parameter { name, role: Role::Width(width), bounds, default: 0.0, value });
}

fn share(visitor: Visitor, name: &'static str, default: f32, scalar: &mut ScalarParam) {
    shape(visitor, name, Bounds::SHARE, default, Value::Scalar(scalar));
}

fn shape(visitor: Visitor, name: &'static str, bounds: Bounds, default: f32, value: Value<'_>) {
    visitor(Parameter { name, role: Role::Shape, bounds, default, value });
}

fn beside(visitor: Visitor, name: &'static str, bounds: Bounds, default: f32, value: Value<'_>) {
    visitor(Parameter { name, role: Role::Beside, bounds, default, value });
}
