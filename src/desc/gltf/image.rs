//! Images, and which of them a texture shows: KHR_texture_basisu, EXT_texture_webp, or the core.

use super::Reader;
use super::extensions::kind;
use crate::desc::{Error, image_file};
use gltf::json;

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
