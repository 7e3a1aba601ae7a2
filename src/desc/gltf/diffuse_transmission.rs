//! KHR_materials_diffuse_transmission (release candidate).

use super::Reader;
use super::extensions::kind;
use crate::desc::{ColorParam, DiffuseTransmission, Error, ScalarParam};
use gltf::json::extensions::material;

impl Reader<'_> {
    /// The extension of one material; `None` where it is absent, or its factor 0.
    pub(super) fn diffuse_transmission(
        &mut self,
        e: Option<&material::Material>,
        place: &str,
    ) -> Result<Option<DiffuseTransmission>, Error> {
        const NAME: &str = "KHR_materials_diffuse_transmission";
        let Some(e) = e else { return Ok(None) };
        let Some(object) = e.others.get(NAME) else { return Ok(None) };
        let at = format!("{place}/extensions/{NAME}");
        if !object.is_object() {
            return Err(self.source.invalid(at, format!("is {}; expected an object", kind(object))));
        }
        let factor = self.number_under(object, "diffuseTransmissionFactor", 0.0, &at)?;
        let factor = self.unit(factor, &format!("{at}/diffuseTransmissionFactor"))?;
        let texture = self.texture_under(object, "diffuseTransmissionTexture", false, &at)?;
        let mut rgb = self.numbers_under(object, "diffuseTransmissionColorFactor", [1.0; 3], &at)?;
        for x in &mut rgb {
            *x = self.unit(*x, &format!("{at}/diffuseTransmissionColorFactor"))?;
        }
        let color = self.texture_under(object, "diffuseTransmissionColorTexture", true, &at)?;
        let thin = self.thin(e.volume.as_ref(), place)?;
        Ok((factor > 0.0).then_some(DiffuseTransmission {
            factor: ScalarParam { factor, texture: texture.map(|t| (t, 3)) },
            color: ColorParam { factor: rgb, texture: color, vertex_color: false },
            thin,
        }))
    }
}
