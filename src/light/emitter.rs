//! What the surface of an area light emits.

use crate::bsdf::fresnel;
use crate::desc::{self, ScalarParam, Sides, TextureRef};
use crate::spectrum::Spectrum;
use crate::texture::Textures;
use glam::{Vec2, Vec4};
use std::f32::consts::PI;

/// Emitted radiance over the surface, the same in all directions of a side that emits, but for what a coat takes.
#[derive(Clone, Debug)]
pub struct Emitter {
    factor: Spectrum,
    texture: Option<TextureRef>,
    vertex_color: bool,
    sides: Sides,
    coat: Option<Box<ScalarParam>>,
}

impl Emitter {
    /// As written.
    pub fn new(emission: &desc::Emission) -> Self {
        let radiance = &emission.radiance;
        Self {
            factor: Spectrum::from_rgb(radiance.factor),
            texture: radiance.texture,
            vertex_color: radiance.vertex_color,
            sides: emission.sides,
            coat: emission.coat.map(Box::new),
        }
    }

    /// Lₑ \[W·sr⁻¹·m⁻²\] at texture coordinates `uv` and vertex colour `color` in the direction of cosine `cos` to the
    /// geometric normal, negative to the back.
    #[inline]
    pub fn le(&self, uv: &[Vec2; 2], color: Vec4, cos: f32, textures: &Textures) -> Spectrum {
        if !self.emits(cos > 0.0) {
            return Spectrum::ZERO;
        }
        let mut le = self.factor;
        if let Some(texture) = &self.texture {
            le *= rgb(textures.lookup(texture, uv));
        }
        if self.vertex_color {
            le *= rgb(color);
        }
        if let Some(coat) = &self.coat {
            le *= through_coat(coat, cos, uv, textures);
        }
        le
    }

    /// Whether this side emits at all.
    #[inline]
    pub fn emits(&self, front: bool) -> bool {
        front || self.sides == Sides::Both
    }

    /// Whether Lₑ is the same at every point.
    pub fn is_uniform(&self) -> bool {
        self.texture.is_none() && !self.vertex_color && self.coat.as_ref().is_none_or(|coat| coat.texture.is_none())
    }

    /// Flux \[W\] of an `area` of mean vertex colour `color`, Φ = π A Lₑ for each side, with the texture's mean taken
    /// for the part of it that the surface shows, and what a coat takes left out.
    pub fn power(&self, area: f32, color: Vec4, mean: &impl Fn(usize) -> Vec4) -> Spectrum {
        let mut le = self.factor;
        if let Some(texture) = &self.texture {
            le *= rgb(mean(texture.texture));
        }
        if self.vertex_color {
            le *= rgb(color);
        }
        self.flux(area, le)
    }

    /// Flux \[W\] of an `area` of this mean radiance.
    pub fn flux(&self, area: f32, le: Spectrum) -> Spectrum {
        let sides = if self.sides == Sides::Both { 2.0 } else { 1.0 };
        le * (PI * area * sides)
    }

    /// Texels along the longest edge of a triangle with these texture coordinates; `None` without a texture.
    pub fn steps(&self, corners: &[[Vec2; 2]; 3], textures: &Textures) -> Option<f32> {
        let texture = self.texture.as_ref()?;
        let resolution = textures.resolution(texture.texture);
        let [a, b, c] = corners.map(|uv| texture.transform.transform_point2(uv[texture.uv_set.min(1)]) * resolution);
        let edges = [a.distance(b), b.distance(c), c.distance(a)];
        Some(edges.into_iter().fold(0.0, |most, edge| if edge.is_finite() { edge.max(most) } else { most }))
    }
}

/// What the coat lets out.
#[inline]
fn through_coat(coat: &ScalarParam, cos: f32, uv: &[Vec2; 2], textures: &Textures) -> f32 {
    let share = coat.texture.map_or(1.0, |(texture, channel)| textures.lookup(&texture, uv).to_array()[channel.min(3)]);
    fresnel::through_coat((coat.factor * share).clamp(0.0, 1.0), cos)
}

fn rgb(color: Vec4) -> Spectrum {
    Spectrum::from_rgb([color.x, color.y, color.z])
}
