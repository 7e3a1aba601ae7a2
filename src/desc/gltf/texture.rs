//! Textures and samplers.

use super::Reader;
use super::slot::Slot;
use crate::desc::{Error, Texture, TextureRef, Wrap};
use gltf::json;
use json::texture::{MagFilter, WrappingMode};
use json::validation::Checked;

impl Reader<'_> {
    /// A use of a texture. `None`, with a note, where it wants a third UV set of the material.
    pub(super) fn texture(&mut self, slot: Slot, srgb: bool, place: &str) -> Result<Option<TextureRef>, Error> {
        let texture = self.document_texture(slot.texture, srgb, place)?;
        let uv_set = self.uv_sets.place(slot.uv_set);
        if uv_set.is_none() {
            self.notes
                .at(place, "a material's textures look at more than two UV sets: those of the third are left out");
        }
        Ok(uv_set.map(|uv_set| TextureRef { texture, uv_set, transform: slot.transform }))
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
