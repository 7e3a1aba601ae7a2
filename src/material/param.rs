//! Parameters at a point: factor × texture × vertex colour. Constants touch no texture.

use crate::bsdf::fresnel;
use crate::desc::{ColorParam, Emission, ScalarParam, Sides};
use crate::spectrum::Spectrum;
use crate::texture::Textures;
use glam::{Vec2, Vec4};

/// Where parameters are evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Point<'a> {
    /// Both texture coordinates.
    pub uv: &'a [Vec2; 2],
    /// Vertex colour, linear RGBA; 1 where there is none.
    pub color: Vec4,
    /// The scene's textures.
    pub textures: &'a Textures,
    /// Index of what the surface encloses over what is really before it, where that is not the material's own over
    /// vacuum: in another medium, or of one lane of a dispersive one.
    pub eta: Option<f32>,
}

/// Evaluates what is the same everywhere.
pub(super) fn nowhere<T>(f: impl FnOnce(Point) -> T) -> T {
    f(Point { uv: &[Vec2::ZERO; 2], color: Vec4::ONE, textures: &Textures::default(), eta: None })
}

/// Whether a colour is constant over the surface.
pub fn is_constant(p: &ColorParam) -> bool {
    p.texture.is_none() && !p.vertex_color
}

/// Linear RGB, not below 0.
#[inline]
pub fn color(p: &ColorParam, at: Point) -> Spectrum {
    let mut rgb = Spectrum::from_rgb(p.factor).0;
    if let Some(t) = &p.texture {
        rgb *= lanes(at.textures.lookup(t, at.uv));
    }
    if p.vertex_color {
        rgb *= lanes(at.color);
    }
    Spectrum(rgb.max(Vec4::ZERO))
}

/// Linear RGB that is a share: in [0, 1].
#[inline]
pub fn share(p: &ColorParam, at: Point) -> Spectrum {
    color(p, at).min(Spectrum::ONE)
}

/// A number in [0, 1].
#[inline]
pub fn scalar(p: &ScalarParam, at: Point) -> f32 {
    at.textures.scalar(p, at.uv)
}

/// Radiance \[W·sr⁻¹·m⁻²\] emitted at the cosine `cos` to the normal, negative to the back.
#[inline]
pub fn emitted(emission: &Emission, cos: f32, at: Point) -> Spectrum {
    if cos <= 0.0 && emission.sides != Sides::Both {
        return Spectrum::ZERO;
    }
    let radiance = color(&emission.radiance, at);
    emission.coat.map_or(radiance, |coat| radiance * fresnel::through_coat(scalar(&coat, at), cos))
}

/// RGBA to lanes.
#[inline]
fn lanes(rgba: Vec4) -> Vec4 {
    Vec4::new(rgba.x, rgba.y, rgba.z, rgba.y)
}
