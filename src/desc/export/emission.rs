//! What a surface with holes emits.
//!
//! pbrt finds a light where it finds the surface, and samples it likewise. Mitsuba's `area` emitter shines in full wherever a
//! path meets the shape, whatever the `mask` about its BSDF lets through: there the radiance itself is that of what is there,
//! coverage × Lₑ. To rays of the camera alone its `path` integrator shows the shape by its coverage (3.9), once too often.

use super::ExportError;
use super::beside::Beside;
use super::picture::{Cover, Map, Picture};
use super::value::{Color, Pattern, Source};
use crate::desc::{Alpha, ColorParam, ScalarParam, Texture, TextureRef};

impl Beside<'_> {
    /// Coverage × radiance, as far as one texture holds both; else all of the surface shines, and a note says so.
    pub(super) fn covered_radiance(&mut self, radiance: &ColorParam, alpha: &Alpha) -> Result<Color, ExportError> {
        if *alpha != Alpha::Opaque {
            self.note("what emits through holes is dimmed by them twice where the camera itself sees it");
        }
        let (coverage, map) = match alpha {
            Alpha::Opaque => return self.radiance(radiance),
            Alpha::Mask { coverage, cutoff } => (coverage, Map::AtLeast(*cutoff)),
            Alpha::Blend { coverage } => (coverage, Map::Same),
        };
        let Some((texture, channel)) = coverage.texture else {
            let share = map.apply(coverage.factor);
            return self.radiance(&ColorParam { factor: radiance.factor.map(|x| x * share), ..*radiance });
        };
        let one = radiance.texture.is_none_or(|other| alike(self, &other, &texture));
        if !one || radiance.vertex_color {
            self.note("what emits through holes of another texture than that of its radiance emits as if it had none");
            return self.radiance(radiance);
        }
        Ok(Color::Texture(self.cut(radiance, coverage, texture, channel, map)?))
    }

    /// Radiance and coverage of one texture.
    fn cut(
        &mut self,
        radiance: &ColorParam,
        coverage: &ScalarParam,
        texture: TextureRef,
        channel: usize,
        map: Map,
    ) -> Result<Source<[f32; 3]>, ExportError> {
        let (factor, colored) = (radiance.factor, radiance.texture);
        let pattern = match self.scene.textures[texture.texture] {
            Texture::Image { image, srgb, wrap, nearest } => {
                self.note("what emits through holes is cut texel by texel, not between them");
                let color = colored.map(|t| self.is_srgb(&t));
                let cover = Cover { srgb, channel, factor: coverage.factor, map };
                let (file, linear) = self.picture(Picture::Covered { image, color, factor, cover })?;
                let nearest = nearest || matches!(map, Map::AtLeast(_));
                Pattern::Image { file, linear, wrap, nearest }
            }
            Texture::Checker { even, odd, scale } => {
                let value = |rgb: [f32; 3]| {
                    let share = map.apply(coverage.factor * rgb.get(channel).copied().unwrap_or(1.0));
                    let color = if colored.is_some() { rgb } else { [1.0; 3] };
                    [0, 1, 2].map(|i| (color[i] * factor[i] * share).max(0.0))
                };
                Pattern::Checker { even: value(even), odd: value(odd), scale }
            }
        };
        Ok(Source { transform: texture.transform, pattern })
    }

    fn is_srgb(&self, texture: &TextureRef) -> bool {
        matches!(self.scene.textures[texture.texture], Texture::Image { srgb: true, .. })
    }
}

/// Whether both look up one image in one way, be it as colours and as numbers.
fn alike(beside: &Beside, a: &TextureRef, b: &TextureRef) -> bool {
    let same = match (&beside.scene.textures[a.texture], &beside.scene.textures[b.texture]) {
        (Texture::Image { image, wrap, .. }, Texture::Image { image: other, wrap: others, .. }) => {
            image == other && wrap == others
        }
        _ => a.texture == b.texture,
    };
    same && a.uv_set == b.uv_set && a.transform == b.transform
}
