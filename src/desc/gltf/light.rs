//! KHR_lights_punctual.

use super::Reader;
use crate::desc::{Error, Light};
use glam::{DMat4, DVec3};
use gltf::json;
use json::extensions::scene::khr_lights_punctual as khr;
use json::validation::Checked;

impl Reader<'_> {
    /// The light `index`, which the node at `place` puts at `world`; its scale does not matter.
    pub(super) fn light(&mut self, index: usize, world: &DMat4, place: &str) -> Result<(), Error> {
        let extension = self.source.root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        let lights = extension.map_or(&[][..], |e| &e.lights);
        let from = format!("{place}/extensions/KHR_lights_punctual/light");
        let light = self.source.get(lights, index, "light", &from)?;
        let at = |key: &str| format!("/extensions/KHR_lights_punctual/lights/{index}/{key}");

        let intensity = self.clamped(light.intensity, 0.0, f32::INFINITY, &at("intensity"))?;
        let mut radiant = light.color;
        for x in &mut radiant {
            *x = self.clamped(*x, 0.0, f32::INFINITY, &at("color"))?;
            *x = self.finite(*x * intensity, &at("color"))?;
        }
        // Beyond its range a light is to be ignored.
        let range = match light.range {
            None => f32::INFINITY,
            Some(range) if range > 0.0 => range,
            Some(_) => {
                self.notes.at(&at("range"), "ranges that are not positive are ignored: the light does not end");
                f32::INFINITY
            }
        };

        // Lights shine along −z of their node.
        let position = world.w_axis.truncate().as_vec3();
        let axis = (-world.z_axis.truncate()).try_normalize().map(DVec3::as_vec3);
        let described = match &light.type_ {
            Checked::Valid(khr::Type::Point) => Some(Light::Point { position, intensity: radiant, range }),
            Checked::Valid(khr::Type::Directional) => {
                axis.map(|direction| Light::Directional { direction, irradiance: radiant })
            }
            Checked::Valid(khr::Type::Spot) => {
                let [inner, outer] = self.cone(light.spot.as_ref(), &at("spot"))?;
                axis.map(|direction| Light::Spot { position, direction, intensity: radiant, inner, outer, range })
            }
            Checked::Invalid => {
                let message = "is no light type; expected \"point\", \"spot\" or \"directional\"";
                return Err(self.source.invalid(at("type"), message));
            }
        };
        match described {
            Some(light) => self.scene.lights.push(light),
            None => self.notes.at(place, "lights whose axis is scaled to nothing are left out"),
        }
        Ok(())
    }

    /// Half-angles of the inner and the outer cone, 0 ≤ inner ≤ outer ≤ π/2.
    fn cone(&mut self, spot: Option<&khr::Spot>, place: &str) -> Result<[f32; 2], Error> {
        let Some(spot) = spot else {
            return Err(self.source.invalid(place, "is missing; expected the cone angles of a spot light"));
        };
        let outer =
            self.clamped(spot.outer_cone_angle, 0.0, std::f32::consts::FRAC_PI_2, &format!("{place}/outerConeAngle"))?;
        if outer == 0.0 {
            return Err(self.source.invalid(format!("{place}/outerConeAngle"), "is 0; expected a positive angle"));
        }
        let inner = self.finite(spot.inner_cone_angle, &format!("{place}/innerConeAngle"))?;
        if !(0.0..=outer).contains(&inner) {
            self.notes.at(place, "inner cone angles are clamped to [0, outer cone angle]");
        }
        Ok([inner.clamp(0.0, outer), outer])
    }
}
