//! KHR_materials_anisotropy.

use super::Reader;
use crate::desc::{Anisotropy, Error, ScalarParam};
use gltf::json::extensions::material;

impl Reader<'_> {
    /// What the extension says of a material; `None` where its strength is 0.
    pub(super) fn anisotropy(
        &mut self,
        extensions: Option<&material::Material>,
        place: &str,
    ) -> Result<Option<Anisotropy>, Error> {
        let Some((object, place)) = self.untyped(extensions, "KHR_materials_anisotropy", place)? else {
            return Ok(None);
        };
        let strength = self.number_under(object, "anisotropyStrength", 0.0, &place)?;
        let factor = self.unit(strength, &format!("{place}/anisotropyStrength"))?;
        let rotation = self.number_under(object, "anisotropyRotation", 0.0, &place)?;
        if factor == 0.0 {
            return Ok(None);
        }
        // Directions in R and G, strength in B.
        let texture = self.texture_under(object, "anisotropyTexture", false, &place)?;
        let strength = ScalarParam { factor, texture: texture.map(|t| (t, 2)) };
        Ok(Some(Anisotropy { strength, rotation, direction: texture }))
    }
}
