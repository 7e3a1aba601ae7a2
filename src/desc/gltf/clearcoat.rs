//! KHR_materials_clearcoat.

use super::Reader;
use crate::desc::{Clearcoat, Error, NormalMap, ScalarParam};
use gltf::json::extensions::material;

impl Reader<'_> {
    /// What the extension says of a material; `None` where nothing is coated.
    pub(super) fn clearcoat(
        &mut self,
        extensions: Option<&material::Material>,
        place: &str,
    ) -> Result<Option<Clearcoat>, Error> {
        let Some((object, place)) = self.untyped(extensions, "KHR_materials_clearcoat", place)? else {
            return Ok(None);
        };
        let factor = self.number_under(object, "clearcoatFactor", 0.0, &place)?;
        let factor = self.unit(factor, &format!("{place}/clearcoatFactor"))?;
        let roughness = self.number_under(object, "clearcoatRoughnessFactor", 0.0, &place)?;
        let roughness = self.unit(roughness, &format!("{place}/clearcoatRoughnessFactor"))?;
        if factor == 0.0 {
            return Ok(None);
        }
        let texture = self.texture_under(object, "clearcoatTexture", false, &place)?;
        let factor = ScalarParam { factor, texture: texture.map(|t| (t, 0)) };
        let texture = self.texture_under(object, "clearcoatRoughnessTexture", false, &place)?;
        let roughness = ScalarParam { factor: roughness, texture: texture.map(|t| (t, 1)) };
        let normal_map = match object.get("clearcoatNormalTexture") {
            None => None,
            Some(info) => {
                let scale = self.number_under(info, "scale", 1.0, &format!("{place}/clearcoatNormalTexture"))?;
                let texture = self.texture_under(object, "clearcoatNormalTexture", false, &place)?;
                texture.map(|texture| NormalMap { texture, scale })
            }
        };
        Ok(Some(Clearcoat { factor, roughness, normal_map }))
    }
}
