//! What a glTF material encloses: the attenuation of KHR_materials_volume, and KHR_materials_dispersion.

use super::Reader;
use super::extensions::kind;
use crate::desc::{Dispersion, Error, Interior, absorption};
use gltf::json::extensions::material;

impl Reader<'_> {
    /// The interior of one material. Distances are in world space: the scale of nodes does not touch them. glTF has no
    /// priorities: of volumes that overlap the one entered last is there.
    pub(super) fn interior(&mut self, e: &material::Material, place: &str) -> Result<Interior, Error> {
        Ok(Interior {
            absorption: self.attenuation(e.volume.as_ref(), place)?,
            priority: 0,
            dispersion: self.dispersion(e, place)?,
        })
    }

    /// σ_a = −ln(attenuationColor)/attenuationDistance.
    fn attenuation(&mut self, volume: Option<&material::Volume>, place: &str) -> Result<[f32; 3], Error> {
        let Some(volume) = volume else { return Ok([0.0; 3]) };
        let at = |key: &str| format!("{place}/extensions/KHR_materials_volume/{key}");
        let mut color = volume.attenuation_color.0;
        for x in &mut color {
            *x = self.unit(*x, &at("attenuationColor"))?;
        }
        // Infinite where the key is absent.
        let distance = volume.attenuation_distance.0;
        if distance.is_nan() || distance <= 0.0 {
            let message = format!("is {distance}; expected a number above 0");
            return Err(self.source.invalid(at("attenuationDistance"), message));
        }
        Ok(absorption(color, distance))
    }

    /// KHR_materials_dispersion: 20/V.
    fn dispersion(&mut self, e: &material::Material, place: &str) -> Result<Dispersion, Error> {
        const NAME: &str = "KHR_materials_dispersion";
        let Some(value) = e.others.get(NAME).and_then(|extension| extension.get("dispersion")) else {
            return Ok(Dispersion::None);
        };
        let place = format!("{place}/extensions/{NAME}/dispersion");
        let Some(x) = value.as_f64() else {
            return Err(self.source.invalid(place, format!("is {}; expected a number", kind(value))));
        };
        let x = self.clamped(x as f32, 0.0, f32::INFINITY, &place)?;
        Ok(if x > 0.0 { Dispersion::InverseAbbe(x / 20.0) } else { Dispersion::None })
    }
}
