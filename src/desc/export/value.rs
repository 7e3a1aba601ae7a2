//! Parameters as targets know them: constants, images, checkers.

use super::ExportError;
use super::beside::Beside;
use super::picture::{Map, Picture};
use crate::desc::{ColorParam, NormalMap, ScalarParam, Texture, Wrap};
use glam::Affine2;

/// A colour.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Color {
    Constant([f32; 3]),
    Texture(Source<[f32; 3]>),
    /// The vertices' colour times a factor.
    Vertex(f32),
}

/// A number.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Scalar {
    Constant(f32),
    Texture(Source<f32>),
}

/// A function of the texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Source<T> {
    /// UV → UV before the look-up.
    pub(super) transform: Affine2,
    pub(super) pattern: Pattern<T>,
}

/// What is looked up.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Pattern<T> {
    Image { file: String, linear: bool, wrap: [Wrap; 2], nearest: bool },
    Checker { even: T, odd: T, scale: [f32; 2] },
}

impl<T> Source<T> {
    /// The image's file.
    pub(super) fn file(&self) -> Option<&str> {
        match &self.pattern {
            Pattern::Image { file, .. } => Some(file),
            Pattern::Checker { .. } => None,
        }
    }
}

impl Scalar {
    pub(super) fn constant(&self) -> Option<f32> {
        match self {
            Self::Constant(x) => Some(*x),
            Self::Texture(_) => None,
        }
    }
}

impl Color {
    pub(super) fn constant(&self) -> Option<[f32; 3]> {
        match self {
            Self::Constant(x) => Some(*x),
            _ => None,
        }
    }
}

impl Beside<'_> {
    /// A reflectance, in [0, 1].
    pub(super) fn share(&mut self, param: &ColorParam) -> Result<Color, ExportError> {
        self.color(param, true)
    }

    /// A radiance.
    pub(super) fn radiance(&mut self, param: &ColorParam) -> Result<Color, ExportError> {
        self.color(param, false)
    }

    fn color(&mut self, param: &ColorParam, share: bool) -> Result<Color, ExportError> {
        let clean = |x: f32| if x > 0.0 { x.min(if share { 1.0 } else { f32::MAX }) } else { 0.0 };
        let factor = param.factor;
        let colored =
            self.scene.shapes.iter().any(|s| matches!(s, crate::desc::Shape::Mesh(m) if !m.colors.is_empty()));
        let Some(texture) = &param.texture else {
            if !(param.vertex_color && colored) {
                return Ok(Color::Constant(factor.map(clean)));
            }
            let mean = factor.iter().sum::<f32>() / 3.0;
            if factor.iter().any(|x| (x - mean).abs() > 1e-3 * mean) {
                self.note("the coloured factor on vertex colours is written as a grey one");
            }
            return Ok(Color::Vertex(mean));
        };
        if param.vertex_color && colored {
            self.note("vertex colours that multiply a texture are left out");
        }
        let pattern = match self.scene.textures[texture.texture] {
            Texture::Image { image, srgb, wrap, nearest } => {
                let (file, linear) = self.picture(Picture::Color { image, srgb, factor, share })?;
                Pattern::Image { file, linear, wrap, nearest }
            }
            Texture::Checker { even, odd, scale } => {
                let tinted = |rgb: [f32; 3]| [0, 1, 2].map(|i| clean(rgb[i] * factor[i]));
                Pattern::Checker { even: tinted(even), odd: tinted(odd), scale }
            }
        };
        Ok(Color::Texture(Source { transform: texture.transform, pattern }))
    }

    /// A number in [0, 1], and what of it the target wants.
    pub(super) fn scalar(&mut self, param: &ScalarParam, map: Map) -> Result<Scalar, ExportError> {
        let factor = param.factor;
        let Some((texture, channel)) = param.texture else { return Ok(Scalar::Constant(map.apply(factor))) };
        let pattern = match self.scene.textures[texture.texture] {
            Texture::Image { image, srgb, wrap, nearest } => {
                let (file, linear) = self.picture(Picture::Channel { image, srgb, channel, factor, map })?;
                // What is cut at a threshold must not be interpolated.
                let nearest = nearest || matches!(map, Map::AtLeast(_));
                Pattern::Image { file, linear, wrap, nearest }
            }
            Texture::Checker { even, odd, scale } => {
                let value = |rgb: [f32; 3]| map.apply(factor * rgb.get(channel).copied().unwrap_or(1.0));
                Pattern::Checker { even: value(even), odd: value(odd), scale }
            }
        };
        Ok(Scalar::Texture(Source { transform: texture.transform, pattern }))
    }

    /// The image of a normal map, its y turned or not; `None` where it is no image.
    pub(super) fn normals(&mut self, map: &NormalMap, turned: bool) -> Result<Option<Source<f32>>, ExportError> {
        let Texture::Image { image, wrap, nearest, .. } = self.scene.textures[map.texture.texture] else {
            self.note("a checker as a normal map is left out");
            return Ok(None);
        };
        let scale = [map.scale, if turned { -map.scale } else { map.scale }];
        let (file, _) = self.picture(Picture::Normals { image, scale })?;
        let pattern = Pattern::Image { file, linear: true, wrap, nearest };
        Ok(Some(Source { transform: map.texture.transform, pattern }))
    }
}
