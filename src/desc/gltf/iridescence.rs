//! KHR_materials_iridescence: a thin film over the surface.

use super::Reader;
use super::extensions::kind;
use crate::desc::{Error, Iridescence, ScalarParam};
use gltf::json::extensions::material;

const NAME: &str = "KHR_materials_iridescence";
/// Channels of the textures.
const R: usize = 0;
const G: usize = 1;

impl Reader<'_> {
    /// The film of a material; `None` where its factor is 0.
    pub(super) fn iridescence(
        &mut self,
        extensions: Option<&material::Material>,
        place: &str,
    ) -> Result<Option<Iridescence>, Error> {
        let Some(film) = extensions.and_then(|e| e.others.get(NAME)) else { return Ok(None) };
        let place = format!("{place}/extensions/{NAME}");
        if !film.is_object() {
            return Err(self.source.invalid(place, format!("is {}; expected an object", kind(film))));
        }
        let at = |key: &str| format!("{place}/{key}");

        let factor = self.number_under(film, "iridescenceFactor", 0.0, &place)?;
        let factor = self.unit(factor, &at("iridescenceFactor"))?;
        if factor == 0.0 {
            return Ok(None);
        }
        let texture = self.texture_under(film, "iridescenceTexture", false, &place)?;
        let factor = ScalarParam { factor, texture: texture.map(|t| (t, R)) };

        let ior = self.number_under(film, "iridescenceIor", 1.3, &place)?;
        let ior = self.clamped(ior, 1.0, 1e3, &at("iridescenceIor"))?;
        let mut thickness = [0.0; 2];
        let keys = [("iridescenceThicknessMinimum", 100.0), ("iridescenceThicknessMaximum", 400.0)];
        for (x, (key, default)) in thickness.iter_mut().zip(keys) {
            let number = self.number_under(film, key, default, &place)?;
            *x = self.clamped(number, 0.0, f32::INFINITY, &at(key))?;
        }
        let texture = self.texture_under(film, "iridescenceThicknessTexture", false, &place)?;
        Ok(Some(Iridescence { factor, ior, thickness, thickness_texture: texture.map(|t| (t, G)) }))
    }
}
