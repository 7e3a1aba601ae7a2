//! Textures, samplers and images.

use super::Reader;
use super::slot::Slot;
use crate::desc::{Error, Pixels, Texture, TextureRef, Wrap, image_file};
use gltf::json;
use json::texture::{MagFilter, WrappingMode};
use json::validation::Checked;

impl Reader<'_> {
    /// A use of a texture. `None`, with a note, where it wants a UV set beyond the second.
    pub(super) fn texture(&mut self, slot: Slot, srgb: bool, place: &str) -> Result<Option<TextureRef>, Error> {
        let texture = self.document_texture(slot.texture, srgb, place)?;
        let Slot { uv_set, transform, .. } = slot;
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
    fn image(&mut self, index: usize, place: &str) -> Result<usize, Error> {
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
