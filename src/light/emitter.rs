//! What the surface of an area light emits.

use crate::bsdf::fresnel;
use crate::desc::{self, Alpha, ScalarParam, Sides, TextureRef};
use crate::spectrum::Spectrum;
use crate::texture::Textures;
use glam::{Vec2, Vec4};
use std::f32::consts::PI;

/// Emitted radiance over the surface, the same in all directions of a side that emits, but for what a coat takes; and how
/// much of the surface is there to emit it.
///
/// A ray meets a surface of coverage c with probability c, and then finds Lₑ ([`le`](Self::le)); a point drawn on the light
/// stands for both cases and sends their mean c Lₑ ([`mean_le`](Self::mean_le)).
#[derive(Clone, Debug)]
pub struct Emitter {
    factor: Spectrum,
    texture: Option<TextureRef>,
    vertex_color: bool,
    sides: Sides,
    coat: Option<Box<ScalarParam>>,
    /// Where the surface has holes.
    alpha: Option<Box<Alpha>>,
}

impl Emitter {
    /// As written, on a surface without holes.
    pub fn new(emission: &desc::Emission) -> Self {
        let radiance = &emission.radiance;
        Self {
            factor: Spectrum::from_rgb(radiance.factor),
            texture: radiance.texture,
            vertex_color: radiance.vertex_color,
            sides: emission.sides,
            coat: emission.coat.map(Box::new),
            alpha: None,
        }
    }

    /// On a surface with these holes.
    #[must_use]
    pub fn with_alpha(self, alpha: Alpha) -> Self {
        Self { alpha: (alpha != Alpha::Opaque).then(|| Box::new(alpha)), ..self }
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

    /// Coverage × Lₑ: the mean over the two cases that the surface is there and that it is not.
    #[inline(always)]
    pub fn mean_le(&self, uv: &[Vec2; 2], color: Vec4, cos: f32, textures: &Textures) -> Spectrum {
        if self.alpha.is_none() && self.coat.is_none() && self.texture.is_none() && !self.vertex_color {
            return if self.emits(cos > 0.0) { self.factor } else { Spectrum::ZERO };
        }
        self.mean_le_here(uv, color, cos, textures)
    }

    /// [`Self::mean_le`] where it is not the same everywhere.
    #[inline(never)]
    fn mean_le_here(&self, uv: &[Vec2; 2], color: Vec4, cos: f32, textures: &Textures) -> Spectrum {
        let le = self.le(uv, color, cos, textures);
        match &self.alpha {
            None => le,
            Some(alpha) => le * textures.coverage(alpha, uv, color),
        }
    }

    /// Whether this side emits at all.
    #[inline]
    pub fn emits(&self, front: bool) -> bool {
        front || self.sides == Sides::Both
    }

    /// Whether coverage and Lₑ are the same at every point of a surface, whose vertices have colours or not.
    pub fn is_uniform(&self, colored: bool) -> bool {
        self.textures().next().is_none() && !(colored && (self.vertex_color || self.alpha.is_some()))
    }

    /// All that is looked up.
    fn textures(&self) -> impl Iterator<Item = &TextureRef> {
        let coat = self.coat.as_ref().and_then(|coat| coat.texture.as_ref());
        let coverage = self.coverage().and_then(|coverage| coverage.texture.as_ref());
        self.texture.iter().chain(coat.into_iter().chain(coverage).map(|(texture, _)| texture))
    }

    fn coverage(&self) -> Option<&ScalarParam> {
        match self.alpha.as_deref()? {
            Alpha::Opaque => None,
            Alpha::Mask { coverage, .. } | Alpha::Blend { coverage } => Some(coverage),
        }
    }

    /// Flux \[W\] of an `area` of mean vertex colour `color`, Φ = π A Lₑ for each side, as far as that is known without
    /// textures, which may darken it.
    pub fn power(&self, area: f32, color: Vec4) -> Spectrum {
        let mut le = self.factor;
        if self.vertex_color {
            le *= rgb(color);
        }
        if let Some(alpha) = self.alpha.as_deref()
            && self.coverage().is_none_or(|coverage| coverage.texture.is_none())
        {
            le *= Textures::default().coverage(alpha, &[Vec2::ZERO; 2], color);
        }
        self.flux(area, le)
    }

    /// Flux \[W\] of an `area` of this mean radiance.
    pub fn flux(&self, area: f32, le: Spectrum) -> Spectrum {
        let sides = if self.sides == Sides::Both { 2.0 } else { 1.0 };
        le * (PI * area * sides)
    }

    /// Texels along the longest edge of a triangle with these texture coordinates, in the finest texture; `None` without one.
    pub fn steps(&self, corners: &[[Vec2; 2]; 3], textures: &Textures) -> Option<f32> {
        let of = |texture: &TextureRef| {
            let resolution = textures.resolution(texture.texture);
            let at = corners.map(|uv| texture.transform.transform_point2(uv[texture.uv_set.min(1)]) * resolution);
            let [a, b, c] = at;
            let edges = [a.distance(b), b.distance(c), c.distance(a)];
            edges.into_iter().fold(0.0, |most: f32, edge| if edge.is_finite() { edge.max(most) } else { most })
        };
        self.textures().map(of).reduce(f32::max)
    }
}

/// What the coat lets out.
#[inline]
fn through_coat(coat: &ScalarParam, cos: f32, uv: &[Vec2; 2], textures: &Textures) -> f32 {
    fresnel::through_coat(textures.scalar(coat, uv), cos)
}

fn rgb(color: Vec4) -> Spectrum {
    Spectrum::from_rgb([color.x, color.y, color.z])
}
