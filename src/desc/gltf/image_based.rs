//! EXT_lights_image_based.
//!
//! The first level of the specular cube map is what surrounds the scene; blurred levels and irradiance coefficients are
//! integrals of it that a path tracer makes itself. Faces are seen from inside; PNGs with alpha are RGBD: linear RGB of the
//! sRGB codes over alpha.

use super::Reader;
use super::extensions::kind;
use crate::desc::{Environment, Error, Image, cube_map};
use glam::{Mat3, Quat, Vec4};
use serde_json::Value;

/// The extension's name.
const NAME: &str = "EXT_lights_image_based";

impl Reader<'_> {
    /// What surrounds the scene that is read, if it says so.
    pub(super) fn image_based(&mut self) -> Result<(), Error> {
        let root = self.source.root;
        let index = root.scene.map_or(0, |s| s.value());
        let scene = root.scenes.get(index).and_then(|s| s.extensions.as_ref());
        let Some(chosen) = scene.and_then(|e| e.others.get(NAME)) else { return Ok(()) };
        let from = format!("/scenes/{index}/extensions/{NAME}/light");
        let chosen = self.whole(chosen.get("light"), &from)?;
        let extension = root.extensions.as_ref().and_then(|e| e.others.get(NAME));
        let lights = extension.and_then(|e| e.get("lights")).and_then(Value::as_array);
        let light = self.source.get(lights.map_or(&[][..], Vec::as_slice), chosen, "image-based light", &from)?;
        let at = |key: &str| format!("/extensions/{NAME}/lights/{chosen}/{key}");

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
