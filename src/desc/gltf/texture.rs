//! Textures, samplers and images.

use super::Reader;
use crate::desc::{Error, Pixels, Texture, TextureRef, Wrap, image_file};
use glam::{Affine2, Mat2, Vec2};
use gltf::json;
use json::extensions::texture::TextureTransform;
use json::texture::{MagFilter, WrappingMode};
use json::validation::Checked;

/// A use of a texture, whatever the kind of reference in the document.
pub(super) struct Slot<'a> {
    texture: usize,
    uv_set: u32,
    transform: Option<&'a TextureTransform>,
}

impl<'a> From<&'a json::texture::Info> for Slot<'a> {
    fn from(info: &'a json::texture::Info) -> Self {
        let transform = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
        Self { texture: info.index.value(), uv_set: info.tex_coord, transform }
    }
}

impl<'a> Slot<'a> {
    /// That of a normal map, whose extensions the `gltf` crate leaves untyped.
    pub(super) fn of_normals(info: &json::material::NormalTexture, transform: Option<&'a TextureTransform>) -> Self {
        Self { texture: info.index.value(), uv_set: info.tex_coord, transform }
    }
}

impl Reader<'_> {
    /// A use of a texture. `None`, with a note, where it wants a UV set beyond the second.
    pub(super) fn texture(&mut self, slot: Slot, srgb: bool, place: &str) -> Result<Option<TextureRef>, Error> {
        let texture = self.document_texture(slot.texture, srgb, place)?;
        let (mut uv_set, mut transform) = (slot.uv_set, Affine2::IDENTITY);
        if let Some(t) = slot.transform {
            uv_set = t.tex_coord.unwrap_or(uv_set);
            transform = affine(t.offset.0.into(), t.rotation.0, t.scale.0.into());
            if !transform.is_finite() {
                let place = format!("{place}/extensions/KHR_texture_transform");
                return Err(self.source.invalid(place, "has numbers that are not finite"));
            }
        }
        let reference = |uv_set| TextureRef { texture, uv_set, transform };
        if uv_set > 1 {
            self.notes.at(place, "TEXCOORD_2 and above are not read: textures that use them are left out");
        }
        Ok((uv_set <= 1).then(|| reference(uv_set as usize)))
    }

    /// The texture `index` of the document, which `place` refers to.
    fn document_texture(&mut self, index: usize, srgb: bool, place: &str) -> Result<usize, Error> {
        if let Some(texture) = self.textures.get(&(index, srgb)) {
            return Ok(*texture);
        }
        let root = self.source.root;
        let texture = self.source.get(&root.textures, index, "texture", &format!("{place}/index"))?;
        let place = format!("/textures/{index}");
        if texture.source.value() == u32::MAX as usize {
            let names = texture.extensions.iter().flat_map(|e| e.others.keys()).cloned().collect::<Vec<_>>();
            let message = match names.is_empty() {
                true => "has no source; expected the index of an image".to_owned(),
                false => format!("has its image in `{}` alone, which is not honoured yet", names.join("`, `")),
            };
            return Err(Error::unsupported(self.source.file, format!("{place}/source"), message));
        }
        let image = self.image(texture.source.value(), &format!("{place}/source"))?;

        // Without a sampler: repeat, bilinear.
        let default = json::texture::Sampler::default();
        let (sampler, place) = match texture.sampler {
            Some(i) => {
                let sampler = self.source.get(&root.samplers, i.value(), "sampler", &format!("{place}/sampler"))?;
                (sampler, format!("/samplers/{}", i.value()))
            }
            None => (&default, place),
        };
        let axis = |mode: &Checked<WrappingMode>, key: &str| match mode {
            Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
            Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::Mirror),
            Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::Clamp),
            Checked::Invalid => {
                Err(self.source.invalid(format!("{place}/{key}"), "is no wrap mode; expected 10497, 33648 or 33071"))
            }
        };
        let wrap = [axis(&sampler.wrap_s, "wrapS")?, axis(&sampler.wrap_t, "wrapT")?];
        let nearest = match sampler.mag_filter {
            None | Some(Checked::Valid(MagFilter::Linear)) => false,
            Some(Checked::Valid(MagFilter::Nearest)) => true,
            Some(Checked::Invalid) => {
                return Err(self.source.invalid(format!("{place}/magFilter"), "is no filter; expected 9728 or 9729"));
            }
        };
        self.scene.textures.push(Texture::Image { image, srgb, wrap, nearest });
        self.textures.insert((index, srgb), self.scene.textures.len() - 1);
        Ok(self.scene.textures.len() - 1)
    }

    /// The image `index` of the document, decoded, which `place` refers to.
    pub(super) fn image(&mut self, index: usize, place: &str) -> Result<usize, Error> {
        if let Some(image) = self.images.get(&index) {
            return Ok(*image);
        }
        let image = self.source.get(&self.source.root.images, index, "image", place)?;
        let place = format!("/images/{index}");
        let fetched;
        let (name, bytes): (String, &[u8]) = match (&image.uri, image.buffer_view) {
            (Some(uri), None) => {
                let place = format!("{place}/uri");
                fetched = self.buffers.fetch(uri, &place, &self.budget)?;
                (fetched.0, &fetched.1)
            }
            (None, Some(view)) => {
                let name = image.name.clone().unwrap_or_else(|| format!("image {index}"));
                (name, self.buffers.view(view.value(), &format!("{place}/bufferView"), &self.budget)?.bytes)
            }
            _ => return Err(self.source.invalid(place, "has neither or both of uri and bufferView; expected one")),
        };
        let decoded = image_file::decode(&name, bytes).map_err(|message| self.source.invalid(&place, message))?;
        let texel = match decoded.pixels {
            Pixels::Rgba8(_) => 4,
            Pixels::Rgba32F(_) => 16,
        };
        let pixels = u64::from(decoded.size[0]) * u64::from(decoded.size[1]);
        self.budget.pixels(self.source, &place, texel * pixels)?;
        self.scene.images.push(decoded.into());
        self.images.insert(index, self.scene.images.len() - 1);
        Ok(self.scene.images.len() - 1)
    }
}

/// KHR_texture_transform: uv' = T R S uv, with R a counter-clockwise turn of UV as seen with v pointing downwards.
fn affine(offset: Vec2, rotation: f32, scale: Vec2) -> Affine2 {
    let (sin, cos) = rotation.sin_cos();
    let turn = Mat2::from_cols(Vec2::new(cos, -sin), Vec2::new(sin, cos));
    Affine2::from_mat2_translation(turn * Mat2::from_diagonal(scale), offset)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The extension's first example: the lower left quadrant of the image, turned clockwise by 90°.
    #[test]
    fn transform_selects_the_lower_left_quadrant() {
        let map = affine(Vec2::new(0.0, 1.0), std::f32::consts::FRAC_PI_2, Vec2::splat(0.5));
        for (uv, expected) in
            [([0.0, 0.0], [0.0, 1.0]), ([1.0, 0.0], [0.0, 0.5]), ([0.0, 1.0], [0.5, 1.0]), ([1.0, 1.0], [0.5, 0.5])]
        {
            assert!(map.transform_point2(uv.into()).abs_diff_eq(expected.into(), 1e-6), "{uv:?}");
        }
    }
}
