//! EXT_lights_ies.

use super::Reader;
use super::extensions::kind;
use crate::desc::{Error, Light, ies};
use glam::DMat4;
use serde_json::Value;
use std::sync::Arc;

/// The extension's name.
const NAME: &str = "EXT_lights_ies";

impl Reader<'_> {
    /// The light that `extension` of the node at `place` puts at `world`; its scale does not matter.
    pub(super) fn profile_light(&mut self, extension: &Value, world: &DMat4, place: &str) -> Result<(), Error> {
        let at = |key: &str| format!("{place}/extensions/{NAME}/{key}");
        let index = self.whole(extension.get("light"), &at("light"))?;
        let profile = self.profile(index, &at("light"))?;
        let multiplier = match extension.get("multiplier") {
            None => 1.0,
            Some(value) => {
                let x = self.number(value, &at("multiplier"))?;
                self.clamped(x, 0.0, f32::INFINITY, &at("multiplier"))?
            }
        };
        let mut intensity = [multiplier; 3];
        if let Some(color) = extension.get("color") {
            let Some([r, g, b]) = color.as_array().map(Vec::as_slice) else {
                let message = format!("is {}; expected three numbers", kind(color));
                return Err(self.source.invalid(at("color"), message));
            };
            for (lane, value) in intensity.iter_mut().zip([r, g, b]) {
                let x = self.number(value, &at("color"))?;
                *lane *= self.unit(x, &at("color"))?;
            }
        }

        // The node's rotation; the light aims along −z.
        let axis = |v: glam::DVec4| v.truncate().try_normalize().map(|v| v.as_vec3());
        let position = world.w_axis.truncate().as_vec3();
        match axis(world.z_axis) {
            Some(z) => {
                let to_world = ies::frame(z, axis(world.x_axis).unwrap_or(z));
                self.scene.lights.push(Light::Profile { position, to_world, intensity, profile });
            }
            None => self.notes.at(place, "lights whose axis is scaled to nothing are left out"),
        }
        Ok(())
    }

    /// Profile `index` of the document, which `from` refers to.
    fn profile(&mut self, index: usize, from: &str) -> Result<Arc<ies::Profile>, Error> {
        if let Some(profile) = self.profiles.get(&index) {
            return Ok(profile.clone());
        }
        let extensions = self.source.root.extensions.as_ref();
        let lights =
            extensions.and_then(|e| e.others.get(NAME)).and_then(|e| e.get("lights")).and_then(Value::as_array);
        let light = self.source.get(lights.map_or(&[][..], Vec::as_slice), index, "light profile", from)?;
        let place = format!("/extensions/{NAME}/lights/{index}");
        let fetched;
        let mut folder = String::new();
        let (place, bytes) = match (light.get("uri").and_then(Value::as_str), light.get("bufferView")) {
            (Some(uri), None) => {
                let place = format!("{place}/uri");
                fetched = self.buffers.fetch(uri, &place, &self.budget)?;
                if let (false, Some(end)) = (uri.starts_with("data:"), fetched.0.rfind('/')) {
                    folder = fetched.0[..=end].into();
                }
                (place, &fetched.1[..])
            }
            (None, Some(view)) => {
                let place = format!("{place}/bufferView");
                let view = self.whole(Some(view), &place)?;
                let bytes = self.buffers.view(view, &place, &self.budget)?.bytes;
                (place, bytes)
            }
            _ => return Err(self.source.invalid(place, "has neither or both of uri and bufferView; expected one")),
        };
        self.budget.decode(self.source, &place, bytes.len(), 4)?;
        // A tilt's file stands beside the profile.
        let beside = |name: &str| {
            let tilt = self.buffers.file(&format!("{folder}{name}"), &place, &self.budget);
            tilt.map_err(|e| e.message)
        };
        let profile = ies::parse(bytes, &beside).map_err(|message| self.source.invalid(&place, message))?;
        let profile = Arc::new(profile);
        self.profiles.insert(index, profile.clone());
        Ok(profile)
    }

    /// An index.
    pub(super) fn whole(&self, value: Option<&Value>, place: &str) -> Result<usize, Error> {
        let Some(value) = value else { return Err(self.source.invalid(place, "is missing; expected an index")) };
        let index = value.as_u64().and_then(|x| usize::try_from(x).ok());
        index.ok_or_else(|| self.source.invalid(place, format!("is {}; expected an index", kind(value))))
    }

    /// A finite number.
    pub(super) fn number(&self, value: &Value, place: &str) -> Result<f32, Error> {
        match value.as_f64() {
            Some(x) => self.finite(x as f32, place),
            None => Err(self.source.invalid(place, format!("is {}; expected a number", kind(value)))),
        }
    }
}
