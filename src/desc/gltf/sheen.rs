//! KHR_materials_sheen.

use super::Reader;
use crate::desc::{ColorParam, Error, ScalarParam, Sheen};
use gltf::json::extensions::material;

impl Reader<'_> {
    /// What the extension says of a material; `None` where its colour is black.
    pub(super) fn sheen(
        &mut self,
        extensions: Option<&material::Material>,
        place: &str,
    ) -> Result<Option<Sheen>, Error> {
        let Some((object, place)) = self.untyped(extensions, "KHR_materials_sheen", place)? else {
            return Ok(None);
        };
        let mut factor = self.numbers_under(object, "sheenColorFactor", [0.0; 3], &place)?;
        for x in &mut factor {
            *x = self.unit(*x, &format!("{place}/sheenColorFactor"))?;
        }
        let roughness = self.number_under(object, "sheenRoughnessFactor", 0.0, &place)?;
        let roughness = self.unit(roughness, &format!("{place}/sheenRoughnessFactor"))?;
        if factor == [0.0; 3] {
            return Ok(None);
        }
        let texture = self.texture_under(object, "sheenColorTexture", true, &place)?;
        let color = ColorParam { factor, texture, vertex_color: false };
        let texture = self.texture_under(object, "sheenRoughnessTexture", false, &place)?;
        Ok(Some(Sheen { color, roughness: ScalarParam { factor: roughness, texture: texture.map(|t| (t, 3)) } }))
    }
}
