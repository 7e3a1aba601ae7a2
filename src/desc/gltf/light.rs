//! Lights: KHR_lights_punctual, EXT_lights_ies, EXT_lights_image_based.

use super::Reader;
use super::extensions::kind;
use crate::desc::{Environment, Error, Image, Light, cube_map, ies};
use glam::{DMat4, DVec3, Mat3, Quat, Vec4};
use gltf::json;
use json::extensions::scene::khr_lights_punctual as khr;
use json::validation::Checked;
use serde_json::Value;
use std::sync::Arc;

impl Reader<'_> {
    /// KHR_lights_punctual: the light `index`, which the node at `place` puts at `world`; its scale does not matter.
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

/// The extension of measured lights.
const PROFILES: &str = "EXT_lights_ies";

impl Reader<'_> {
    /// EXT_lights_ies: the light that `extension` of the node at `place` puts at `world`; its scale does not matter.
    pub(super) fn profile_light(&mut self, extension: &Value, world: &DMat4, place: &str) -> Result<(), Error> {
        let at = |key: &str| format!("{place}/extensions/{PROFILES}/{key}");
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
            extensions.and_then(|e| e.others.get(PROFILES)).and_then(|e| e.get("lights")).and_then(Value::as_array);
        let light = self.source.get(lights.map_or(&[][..], Vec::as_slice), index, "light profile", from)?;
        let place = format!("/extensions/{PROFILES}/lights/{index}");
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
        let profile = ies::parse_beside(bytes, &beside).map_err(|message| self.source.invalid(&place, message))?;
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

/// The extension of surroundings.
const IMAGE_BASED: &str = "EXT_lights_image_based";

impl Reader<'_> {
    /// EXT_lights_image_based: what surrounds the scene that is read, if it says so.
    ///
    /// The first level of the specular cube map is that; blurred levels and irradiance coefficients are integrals of it
    /// that a path tracer makes itself. Faces are seen from inside; PNGs with alpha are RGBD: linear RGB of the sRGB codes
    /// over alpha.
    pub(super) fn image_based(&mut self) -> Result<(), Error> {
        let root = self.source.root;
        let index = root.scene.map_or(0, |s| s.value());
        let scene = root.scenes.get(index).and_then(|s| s.extensions.as_ref());
        let Some(chosen) = scene.and_then(|e| e.others.get(IMAGE_BASED)) else { return Ok(()) };
        let from = format!("/scenes/{index}/extensions/{IMAGE_BASED}/light");
        let chosen = self.whole(chosen.get("light"), &from)?;
        let extension = root.extensions.as_ref().and_then(|e| e.others.get(IMAGE_BASED));
        let lights = extension.and_then(|e| e.get("lights")).and_then(Value::as_array);
        let light = self.source.get(lights.map_or(&[][..], Vec::as_slice), chosen, "image-based light", &from)?;
        let at = |key: &str| format!("/extensions/{IMAGE_BASED}/lights/{chosen}/{key}");

        let intensity = match light.get("intensity") {
            None => 1.0,
            Some(value) => {
                let x = self.number(value, &at("intensity"))?;
                self.clamped(x, 0.0, f32::INFINITY, &at("intensity"))?
            }
        };
        let rotation = match light.get("rotation").map(|r| (r, r.as_array().map(Vec::as_slice))) {
            None => Quat::IDENTITY,
            Some((_, Some([x, y, z, w]))) => {
                let mut q = [0.0; 4];
                for (q, value) in q.iter_mut().zip([x, y, z, w]) {
                    *q = self.number(value, &at("rotation"))?;
                }
                let q = Vec4::from(q).try_normalize().map(Quat::from_vec4);
                q.ok_or_else(|| self.source.invalid(at("rotation"), "is 0; expected a unit quaternion"))?
            }
            Some((other, _)) => {
                let message = format!("is {}; expected the four numbers of a quaternion", kind(other));
                return Err(self.source.invalid(at("rotation"), message));
            }
        };

        // The six faces of the first level.
        let place = at("specularImages/0");
        let level = light.get("specularImages").and_then(|levels| levels.get(0)).and_then(Value::as_array);
        let Some([a, b, c, d, e, f]) = level.map(Vec::as_slice) else {
            return Err(self.source.invalid(place, "is no list of six images; expected the faces of a cube"));
        };
        let mut faces = Vec::new();
        for (i, face) in [a, b, c, d, e, f].into_iter().enumerate() {
            let place = format!("{place}/{i}");
            let image = self.whole(Some(face), &place)?;
            faces.push(self.image(image, None, &place)?.image);
        }
        let faces: Vec<&Image> = faces.into_iter().map(|i| &*self.scene.images[i]).collect();
        let [width, height] = cube_map::panorama_size(faces[0].size[0]);
        self.budget.pixels(self.source, &place, 16 * width as usize * height as usize)?;
        let image = cube_map::panorama(&faces).map_err(|message| self.source.invalid(&place, message))?;
        self.scene.images.push(image.into());
        self.scene.environment = Some(Environment {
            radiance: [intensity; 3],
            image: Some(self.scene.images.len() - 1),
            to_world: Mat3::from_quat(rotation),
        });
        Ok(())
    }
}
