//! KHR_materials_pbrSpecularGlossiness, archived and still in files. It stands before the core's metallic-roughness.

use super::Reader;
use super::extensions::kind;
use crate::desc::{ColorParam, Error, ScalarParam, SpecularGlossiness};
use gltf::json::extensions::material;

const NAME: &str = "KHR_materials_pbrSpecularGlossiness";
/// Alpha.
const A: usize = 3;

impl Reader<'_> {
    /// The model and its coverage; `None` where the material has no such extension.
    pub(super) fn specular_glossiness(
        &mut self,
        extensions: Option<&material::Material>,
        place: &str,
    ) -> Result<Option<(SpecularGlossiness, ScalarParam)>, Error> {
        let Some(gloss) = extensions.and_then(|e| e.others.get(NAME)) else { return Ok(None) };
        let place = format!("{place}/extensions/{NAME}");
        if !gloss.is_object() {
            return Err(self.source.invalid(place, format!("is {}; expected an object", kind(gloss))));
        }
        let at = |key: &str| format!("{place}/{key}");

        // The base's colour and its coverage share factor and texture.
        let mut factor = self.numbers_under(gloss, "diffuseFactor", [1.0; 4], &place)?;
        for x in &mut factor {
            *x = self.unit(*x, &at("diffuseFactor"))?;
        }
        let texture = self.texture_under(gloss, "diffuseTexture", true, &place)?;
        let [r, g, b, a] = factor;
        let diffuse = ColorParam { factor: [r, g, b], texture, vertex_color: true };
        let coverage = ScalarParam { factor: a, texture: texture.map(|t| (t, A)) };

        // So do specular colour, in sRGB, and glossiness, which is linear as every alpha.
        let mut factor = self.numbers_under(gloss, "specularFactor", [1.0; 3], &place)?;
        for x in &mut factor {
            *x = self.unit(*x, &at("specularFactor"))?;
        }
        let texture = self.texture_under(gloss, "specularGlossinessTexture", true, &place)?;
        let specular = ColorParam { factor, texture, vertex_color: false };
        let factor = self.number_under(gloss, "glossinessFactor", 1.0, &place)?;
        let factor = self.unit(factor, &at("glossinessFactor"))?;
        let glossiness = ScalarParam { factor, texture: texture.map(|t| (t, A)) };
        Ok(Some((SpecularGlossiness { diffuse, specular, glossiness }, coverage)))
    }
}
