//! Emitters without a surface.

use super::super::beside::Beside;
use super::super::picture::Picture;
use super::super::{ExportError, sun};
use super::xml::Element;
use crate::desc::{Environment, Light};
use glam::{Mat4, Quat, Vec3};
use std::f32::consts::PI;

/// All lights, the environment last.
pub(super) fn elements(beside: &mut Beside) -> Result<Vec<Element>, ExportError> {
    let scene = beside.scene;
    let mut elements: Vec<Element> = scene.lights.iter().map(|light| element(light, beside)).collect();
    if let Some(environment) = &scene.environment {
        elements.push(surrounding(environment, beside)?);
    }
    Ok(elements)
}

fn element(light: &Light, beside: &mut Beside) -> Element {
    match light {
        Light::Point { position, intensity, range } => {
            endless(*range, beside);
            let point = Element::plugin("emitter", "point").rgb("intensity", *intensity);
            point.child(point_of("position", *position))
        }
        Light::Spot { position, direction, intensity, inner, outer, range } => {
            endless(*range, beside);
            if outer - inner > 1e-3 {
                beside.note(
                    "spots fall off linearly in the angle between their cones, not by the squared cosine of glTF",
                );
            }
            // Along +z there.
            let turn = Mat4::from_quat(Quat::from_rotation_arc(Vec3::Z, *direction));
            let spot = Element::plugin("emitter", "spot").rgb("intensity", *intensity);
            let spot = spot.float("cutoff_angle", outer.to_degrees()).float("beam_width", inner.to_degrees());
            spot.transform("to_world", Mat4::from_translation(*position) * turn)
        }
        Light::Profile { position, to_world, intensity, profile } => {
            beside.note("measured lights (IES) shine the same in all directions, with the mean of their candelas");
            let mean = profile.candela.iter().sum::<f32>() / profile.candela.len().max(1) as f32;
            let mean = mean * profile.tilt_factor(*to_world);
            let point = Element::plugin("emitter", "point").rgb("intensity", intensity.map(|x| x * mean));
            point.child(point_of("position", *position))
        }
        Light::Directional { direction, irradiance } => {
            let [x, y, z] = direction.to_array();
            let vector = Element::new("vector").with("name", "direction").with("x", x).with("y", y).with("z", z);
            Element::plugin("emitter", "directional").child(vector).rgb("irradiance", *irradiance)
        }
        Light::Sun { direction, irradiance, diameter } => {
            let disk = sun::disk(*direction, *irradiance, *diameter, beside);
            let emitter = Element::plugin("emitter", "area").rgb("radiance", disk.radiance);
            let black = Element::bsdf("diffuse").rgb("reflectance", [0.0; 3]);
            Element::plugin("shape", "disk")
                .transform("to_world", disk.to_world * Mat4::from_scale(Vec3::splat(disk.radius)))
                .child(black)
                .child(emitter)
        }
    }
}

fn endless(range: f32, beside: &mut Beside) {
    if range.is_finite() {
        beside.note("lights of a limited range shine on beyond it");
    }
}

fn point_of(name: &str, p: Vec3) -> Element {
    Element::new("point").with("name", name).with("x", p.x).with("y", p.y).with("z", p.z)
}

/// The environment. Its image is interpolated there; here every texel is constant.
fn surrounding(environment: &Environment, beside: &mut Beside) -> Result<Element, ExportError> {
    let Some(image) = environment.image else {
        return Ok(Element::plugin("emitter", "constant").rgb("radiance", environment.radiance));
    };
    beside.note("between the texels of the environment Mitsuba interpolates");
    let srgb = beside.scene.images[image].pixels.are_codes();
    let (file, _) = beside.picture(Picture::Color { image, srgb, factor: environment.radiance, share: false })?;
    // The left edge is −z there, and the middle here: half a turn about y.
    let to_world = Mat4::from_mat3(environment.to_world) * Mat4::from_rotation_y(PI);
    Ok(Element::plugin("emitter", "envmap").string("filename", &file).transform("to_world", to_world))
}
