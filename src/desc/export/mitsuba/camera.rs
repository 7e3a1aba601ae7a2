//! The sensor.

use super::super::beside::Beside;
use super::super::sun::reach;
use super::super::{ExportError, View, camera};
use super::filter;
use super::xml::Element;
use crate::desc::{Error, Fov, Projection};
use glam::{Mat4, Vec3};
use std::path::Path;

/// The camera with its film and sampler.
pub(super) fn element(view: &View, beside: &mut Beside) -> Result<Element, ExportError> {
    let camera = camera(beside.scene, view);
    let [width, height] = view.size;
    let lens = camera.lens.filter(|lens| lens.radius > 0.0);
    // Half a turn about y: +z ahead, +x to the left.
    let turned = camera.to_world * Mat4::from_scale(Vec3::new(-1.0, 1.0, -1.0));
    let (mut sensor, to_world) = match camera.projection {
        Projection::Perspective { fov } => {
            let sensor = Element::plugin("sensor", if lens.is_some() { "thinlens" } else { "perspective" });
            let (axis, angle) = match fov {
                Fov::Horizontal(angle) => ("x", angle),
                Fov::Vertical(angle) => ("y", angle),
            };
            (sensor.string("fov_axis", axis).float("fov", angle.to_degrees()), turned)
        }
        Projection::Orthographic { half_height } => {
            // The film spans −1 to 1 across.
            let half = half_height * width as f32 / height as f32;
            let scale = Mat4::from_scale(Vec3::new(half, half, 1.0));
            (Element::plugin("sensor", "orthographic"), turned * scale)
        }
        Projection::Equirectangular => {
            let file = beside.scene.source.as_deref().unwrap_or(Path::new("scene"));
            let message = format!("camera `{}` is equirectangular; Mitsuba has no such camera", camera.name);
            return Err(Error::unsupported(file, "", message).into());
        }
    };
    if let Some(lens) = lens {
        sensor = sensor.float("aperture_radius", lens.radius).float("focus_distance", lens.focus_distance);
    }

    // Nothing is clipped here; there, what is out of these.
    let position = camera.to_world.w_axis.truncate();
    let reach = reach(beside, position);
    sensor = sensor.float("near_clip", 1e-5 * reach).float("far_clip", 1e5 * reach).transform("to_world", to_world);
    let film = Element::plugin("film", "hdrfilm")
        .integer("width", width.into())
        .integer("height", height.into())
        .string("pixel_format", "rgb")
        .string("component_format", "float32")
        .child(filter(view, beside));
    let sampler = Element::plugin("sampler", "independent").integer("sample_count", view.spp.into());
    Ok(sensor.child(film).child(sampler))
}
