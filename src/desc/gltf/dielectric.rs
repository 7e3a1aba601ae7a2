//! The dielectric side of a material: KHR_materials_ior, _specular, _transmission and _volume.

use super::Reader;
use crate::desc::{ColorParam, Error, Interior, ScalarParam, Transmission};
use gltf::json::extensions::material;

/// What the four extensions say, or their defaults.
pub(super) struct Dielectric {
    pub ior: f32,
    pub specular: ScalarParam,
    pub specular_color: ColorParam,
    pub transmission: Option<Transmission>,
    pub interior: Interior,
}

impl Reader<'_> {
    /// The four extensions of one material.
    pub(super) fn dielectric(&mut self, e: Option<&material::Material>, place: &str) -> Result<Dielectric, Error> {
        let mut dielectric = Dielectric {
            ior: 1.5,
            specular: ScalarParam::constant(1.0),
            specular_color: ColorParam::constant([1.0; 3]),
            transmission: None,
            interior: Interior::default(),
        };
        let Some(e) = e else { return Ok(dielectric) };
        dielectric.interior = self.interior(e, place)?;
        let at = |name: &str, key: &str| format!("{place}/extensions/KHR_materials_{name}/{key}");

        // 0 is a code for total reflection; below 1 there is nothing else.
        if let Some(ior) = &e.ior
            && ior.ior.0 != 0.0
        {
            dielectric.ior = self.clamped(ior.ior.0, 1.0, f32::INFINITY, &at("ior", "ior"))?;
        } else if e.ior.is_some() {
            dielectric.ior = 0.0;
        }
        if let Some(specular) = &e.specular {
            let factor = self.unit(specular.specular_factor.0, &at("specular", "specularFactor"))?;
            let texture = self.data_texture(specular.specular_texture.as_ref(), &at("specular", "specularTexture"))?;
            dielectric.specular = ScalarParam { factor, texture: texture.map(|t| (t, 3)) };
            let mut factor = specular.specular_color_factor.0;
            for x in &mut factor {
                *x = self.clamped(*x, 0.0, f32::INFINITY, &at("specular", "specularColorFactor"))?;
            }
            let info = specular.specular_color_texture.as_ref();
            let texture = self.color_texture(info, &at("specular", "specularColorTexture"))?;
            dielectric.specular_color = ColorParam { factor, texture, vertex_color: false };
        }
        if let Some(transmission) = &e.transmission {
            let factor = self.unit(transmission.transmission_factor.0, &at("transmission", "transmissionFactor"))?;
            if factor > 0.0 {
                let info = transmission.transmission_texture.as_ref();
                let texture = self.data_texture(info, &at("transmission", "transmissionTexture"))?;
                let factor = ScalarParam { factor, texture: texture.map(|t| (t, 0)) };
                let thin = self.thin(e.volume.as_ref(), place)?;
                dielectric.transmission = Some(Transmission { factor, thin });
            }
        }
        Ok(dielectric)
    }

    /// Whether what is transmitted passes a sheet without thickness, not into a volume.
    pub(super) fn thin(&mut self, volume: Option<&material::Volume>, place: &str) -> Result<bool, Error> {
        let Some(volume) = volume else { return Ok(true) };
        let place = format!("{place}/extensions/KHR_materials_volume");
        let thickness = self.finite(volume.thickness_factor.0, &format!("{place}/thicknessFactor"))?;
        if thickness <= 0.0 {
            return Ok(true);
        }
        if volume.thickness_texture.is_some() {
            self.notes.at(&place, "thickness textures are ignored: the mesh itself says how thick it is");
        }
        Ok(false)
    }
}
