//! Lights without a surface.

use super::super::beside::Beside;
use super::super::picture::Picture;
use super::super::{ExportError, sun};
use super::words::Words;
use crate::desc::Light;
use glam::Vec3;

pub(super) fn write(beside: &mut Beside, out: &mut Words) -> Result<(), ExportError> {
    let scene = beside.scene;
    scene.lights.iter().for_each(|light| one(light, beside, out));
    let Some(environment) = &scene.environment else { return Ok(()) };
    out.line("LightSource \"infinite\"");
    match environment.image {
        None => {
            out.rgb("L", environment.radiance);
        }
        Some(image) => {
            beside.note("the environment is resampled to pbrt's square of equal areas");
            let (factor, to_world) = (environment.radiance, environment.to_world);
            let (file, _) = beside.picture(Picture::Octahedral { image, factor, to_world })?;
            out.string("filename", &file);
        }
    }
    Ok(())
}

fn one(light: &Light, beside: &mut Beside, out: &mut Words) {
    match light {
        Light::Point { position, intensity, range } => {
            endless(*range, beside);
            out.line("LightSource \"point\"").rgb("I", *intensity).point("from", *position);
        }
        Light::Spot { position, direction, intensity, inner, outer, range } => {
            endless(*range, beside);
            if outer - inner > 1e-3 {
                beside.note("spots fall off by a cubic in the cosine between their cones, not by glTF's square");
            }
            let (from, to) = (*position, *position + *direction);
            let spot = out.line("LightSource \"spot\"").rgb("I", *intensity).point("from", from).point("to", to);
            spot.float("coneangle", outer.to_degrees()).float("conedeltaangle", (outer - inner).to_degrees());
        }
        Light::Profile { position, to_world, intensity, profile } => {
            beside.note("measured lights (IES) shine the same in all directions, with the mean of their candelas");
            let mean = profile.candela.iter().sum::<f32>() / profile.candela.len().max(1) as f32;
            let mean = mean * profile.tilt_factor(*to_world);
            out.line("LightSource \"point\"").rgb("I", intensity.map(|x| x * mean)).point("from", *position);
        }
        Light::Directional { direction, irradiance } => {
            let distant = out.line("LightSource \"distant\"").rgb("L", *irradiance);
            distant.point("from", Vec3::ZERO).point("to", *direction);
        }
        Light::Sun { direction, irradiance, diameter } => {
            let disk = sun::disk(*direction, *irradiance, *diameter, beside);
            out.line("AttributeBegin");
            out.matrix("ConcatTransform", disk.to_world);
            out.line("AreaLightSource \"diffuse\"").rgb("L", disk.radiance);
            out.line("Shape \"disk\"").float("radius", disk.radius);
            out.line("AttributeEnd");
        }
    }
}

fn endless(range: f32, beside: &mut Beside) {
    if range.is_finite() {
        beside.note("lights of a limited range shine on beyond it");
    }
}
