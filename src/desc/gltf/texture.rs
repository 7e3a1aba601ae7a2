//! Textures with their samplers and images, their uses, and the numbers beside these, wherever they stand: in the core, or
//! inside an extension's object that has no type.
//!
//! Which image a texture shows is said by KHR_texture_basisu, EXT_texture_webp, or the core.

use super::extensions::kind;
use super::{Reader, Source};
use crate::desc::{Error, Texture, TextureRef, Wrap, image_file};
use glam::{Affine2, Mat2, Vec2};
use gltf::json;
use json::extensions::texture::TextureTransform;
use json::texture::{MagFilter, WrappingMode};
use json::validation::Checked;
use serde::Deserialize;
use serde_json::Value;

/// A use of a texture: a `textureInfo` of glTF 2.0 (section 5.30) with its KHR_texture_transform.
pub(super) struct TextureUse {
    /// Which texture of the document.
    pub texture: usize,
    /// n of TEXCOORD_n.
    pub uv_set: u32,
    /// UV → UV before the look-up.
    pub transform: Affine2,
}

impl TextureUse {
    /// One that the `gltf` crate knows, at `place`.
    pub(super) fn of_info(info: &json::texture::Info, source: Source, place: &str) -> Result<Self, Error> {
        let transform = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
        Self::new(info.index.value(), info.tex_coord, transform, source, place)
    }

    /// That of a normal map, whose extensions the `gltf` crate leaves untyped.
    pub(super) fn of_normals(info: &json::material::NormalTexture, source: Source, place: &str) -> Result<Self, Error> {
        let transform = match info.extensions.as_ref().and_then(|e| e.others.get("KHR_texture_transform")) {
            Some(value) => Some(
                TextureTransform::deserialize(value)
                    .map_err(|e| source.invalid(format!("{place}/extensions/KHR_texture_transform"), e.to_string()))?,
            ),
            None => None,
        };
        Self::new(info.index.value(), info.tex_coord, transform.as_ref(), source, place)
    }

    /// One in plain JSON, at `place`.
    pub(super) fn of_json(value: &Value, source: Source, place: &str) -> Result<Self, Error> {
        if !value.is_object() {
            return Err(source.invalid(place, format!("is {}; expected an object with an index", kind(value))));
        }
        let info = json::texture::Info::deserialize(value).map_err(|e| source.invalid(place, e.to_string()))?;
        Self::of_info(&info, source, place)
    }

    fn new(
        texture: usize,
        uv_set: u32,
        transform: Option<&TextureTransform>,
        source: Source,
        place: &str,
    ) -> Result<Self, Error> {
        let Some(t) = transform else { return Ok(Self { texture, uv_set, transform: Affine2::IDENTITY }) };
        let transform = affine(t.offset.0.into(), t.rotation.0, t.scale.0.into());
        if !transform.is_finite() {
            let place = format!("{place}/extensions/KHR_texture_transform");
            return Err(source.invalid(place, "has numbers that are not finite"));
        }
        Ok(Self { texture, uv_set: t.tex_coord.unwrap_or(uv_set), transform })
    }
}

impl Reader<'_> {
    /// The texture under `key` of an extension's object, which stands at `place`; `None` where the object has no such
    /// key. `srgb`: it holds colours, not numbers.
    pub(super) fn texture_under(
        &mut self,
        object: &Value,
        key: &str,
        srgb: bool,
        place: &str,
    ) -> Result<Option<TextureRef>, Error> {
        let Some(value) = object.get(key) else { return Ok(None) };
        let place = format!("{place}/{key}");
        let used = TextureUse::of_json(value, self.source, &place)?;
        self.texture(used, srgb, &place)
    }

    /// The finite number under `key` of an extension's object, which stands at `place`; `default` where there is none.
    pub(super) fn number_under(&self, object: &Value, key: &str, default: f32, place: &str) -> Result<f32, Error> {
        let Some(value) = object.get(key) else { return Ok(default) };
        let place = format!("{place}/{key}");
        let number = value
            .as_f64()
            .ok_or_else(|| self.source.invalid(&place, format!("is {}; expected a number", kind(value))))?;
        self.finite(number as f32, &place)
    }

    /// The `N` finite numbers under `key` of an extension's object, which stands at `place`; `default` where there are
    /// none.
    pub(super) fn numbers_under<const N: usize>(
        &self,
        object: &Value,
        key: &str,
        default: [f32; N],
        place: &str,
    ) -> Result<[f32; N], Error> {
        let Some(value) = object.get(key) else { return Ok(default) };
        let place = format!("{place}/{key}");
        let numbers = value.as_array().filter(|list| list.len() == N);
        let numbers: Option<Vec<f64>> = numbers.and_then(|list| list.iter().map(Value::as_f64).collect());
        let numbers = numbers.ok_or_else(|| self.source.invalid(&place, format!("is not a list of {N} numbers")))?;
        let mut found = default;
        for (x, number) in found.iter_mut().zip(numbers) {
            *x = self.finite(number as f32, &place)?;
        }
        Ok(found)
    }
}

/// KHR_texture_transform: uv' = T R S uv, with R a counter-clockwise turn of UV as seen with v pointing downwards.
fn affine(offset: Vec2, rotation: f32, scale: Vec2) -> Affine2 {
    let (sin, cos) = rotation.sin_cos();
    let turn = Mat2::from_cols(Vec2::new(cos, -sin), Vec2::new(sin, cos));
    Affine2::from_mat2_translation(turn * Mat2::from_diagonal(scale), offset)
}

impl Reader<'_> {
    /// A use of a texture. `None`, with a note, where it wants a third UV set of the material.
    pub(super) fn texture(&mut self, used: TextureUse, srgb: bool, place: &str) -> Result<Option<TextureRef>, Error> {
        let texture = self.document_texture(used.texture, srgb, place)?;
        let uv_set = self.uv_sets.place(used.uv_set);
        if uv_set.is_none() {
            self.notes
                .at(place, "a material's textures look at more than two UV sets: those of the third are left out");
        }
        Ok(uv_set.map(|uv_set| TextureRef { texture, uv_set, transform: used.transform }))
    }

    /// A texture of the core's; `srgb`: its RGB are colours, stored with the sRGB curve, not numbers.
    pub(super) fn core_texture(
        &mut self,
        info: Option<&json::texture::Info>,
        srgb: bool,
        place: &str,
    ) -> Result<Option<TextureRef>, Error> {
        let Some(info) = info else { return Ok(None) };
        let used = TextureUse::of_info(info, self.source, place)?;
        self.texture(used, srgb, place)
    }

    /// The texture `index` of the document, which `place` refers to.
    fn document_texture(&mut self, index: usize, srgb: bool, place: &str) -> Result<usize, Error> {
        if let Some(texture) = self.textures.get(&(index, srgb)) {
            return Ok(*texture);
        }
        let root = self.source.root;
        let texture = self.source.get(&root.textures, index, "texture", &format!("{place}/index"))?;
        let place = format!("/textures/{index}");
        let image = self.image_of(texture, srgb, &place)?;

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
}

/// Extensions that give a texture its image in another format, the preferred one first.
const FORMATS: [(&str, &str); 2] = [("KHR_texture_basisu", "KTX2"), ("EXT_texture_webp", "WebP")];

/// An image in the scene.
#[derive(Clone, Copy)]
pub(super) struct Decoded {
    /// Which image.
    pub(super) image: usize,
    /// Whether the file says that it holds sRGB; few formats say.
    srgb: Option<bool>,
}

impl Reader<'_> {
    /// The image of a texture, which is used as colours (`srgb`) or as numbers.
    ///
    /// Where an extension gives the image, that one is read: should it be damaged, this is an error, and no reason to
    /// take the core's.
    pub(super) fn image_of(&mut self, texture: &json::Texture, srgb: bool, place: &str) -> Result<usize, Error> {
        let extensions = || texture.extensions.iter().flat_map(|e| &e.others);
        for (name, format) in FORMATS {
            let Some((_, extension)) = extensions().find(|(key, _)| *key == name) else { continue };
            let place = format!("{place}/extensions/{name}/source");
            let index = extension
                .get("source")
                .ok_or_else(|| self.source.invalid(&place, "is missing; expected the index of an image"))?;
            let index = index.as_u64().and_then(|i| usize::try_from(i).ok()).ok_or_else(|| {
                let found = if index.is_number() { index.to_string() } else { kind(index).to_owned() };
                self.source.invalid(&place, format!("is {found}; expected the index of an image"))
            })?;
            let decoded = self.image(index, Some(format), &place)?;
            if decoded.srgb.is_some_and(|stored| stored != srgb) {
                let (stored, used) = if srgb { ("numbers", "colours") } else { ("sRGB colours", "numbers") };
                self.notes
                    .at(&place, format!("KTX2 images that say they hold {stored} are used as {used}, by their use"));
            }
            return Ok(decoded.image);
        }
        if texture.source.value() == u32::MAX as usize {
            let names = extensions().map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>();
            let message = match names.is_empty() {
                true => "has no source; expected the index of an image".to_owned(),
                false => format!("has its image in {} alone, which is not honoured", names.join(", ")),
            };
            return Err(Error::unsupported(self.source.file, format!("{place}/source"), message));
        }
        Ok(self.image(texture.source.value(), None, &format!("{place}/source"))?.image)
    }

    /// The image `index` of the document, decoded, which `place` refers to; in this format, if one is named.
    pub(super) fn image(&mut self, index: usize, format: Option<&str>, place: &str) -> Result<Decoded, Error> {
        if let Some(decoded) = self.images.get(&index) {
            return Ok(*decoded);
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

        // What a texture's extension says that the file is, it must be; the core knows PNG and JPEG.
        let found = image_file::format(bytes).map_err(|message| self.source.invalid(&place, message))?;
        match format {
            Some(format) if found != format => {
                return Err(self.source.invalid(place, format!("is {found}; expected {format}")));
            }
            None if !["PNG", "JPEG"].contains(&found) => {
                self.notes
                    .at(&place, format!("images in {found} are read, though the core of glTF knows PNG and JPEG"));
            }
            _ => {}
        }
        let decoded = image_file::decode(&name, bytes).map_err(|message| self.source.invalid(&place, message))?;
        let srgb = image_file::ktx2_is_srgb(bytes);
        self.budget.pixels(self.source, &place, decoded.pixels.memory())?;
        self.scene.images.push(decoded.into());
        let decoded = Decoded { image: self.scene.images.len() - 1, srgb };
        self.images.insert(index, decoded);
        Ok(decoded)
    }
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

    /// A use in plain JSON says the same as a typed one: index, set (overridden by the transform), transform.
    #[test]
    fn uses_in_plain_json() {
        let root = json::Root::default();
        let source = Source { file: std::path::Path::new("x.gltf"), root: &root, json: &serde_json::Value::Null };
        let transform = serde_json::json!({ "offset": [1, 2], "scale": [3, 4], "texCoord": 5 });
        let plain =
            serde_json::json!({ "index": 7, "texCoord": 1, "extensions": { "KHR_texture_transform": transform } });
        let used = TextureUse::of_json(&plain, source, "/x").unwrap();
        assert_eq!((used.texture, used.uv_set), (7, 5));
        assert_eq!(used.transform.transform_point2(Vec2::ONE), Vec2::new(4.0, 6.0));
        for (bad, place) in [
            (serde_json::json!(3), "/x"),
            (serde_json::json!({ "texCoord": 0 }), "/x"),
            (
                serde_json::json!({ "index": 0, "extensions": { "KHR_texture_transform": { "scale": [1e39, 1] } } }),
                "/x/extensions/KHR_texture_transform",
            ),
        ] {
            assert_eq!(TextureUse::of_json(&bad, source, "/x").err().unwrap().place, place, "{bad}");
        }
    }
}
