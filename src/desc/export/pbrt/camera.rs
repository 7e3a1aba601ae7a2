//! Camera, film, filter and sampler.

use super::super::beside::Beside;
use super::super::{ExportError, View, camera};
use super::words::Words;
use crate::desc::{Filter, Fov, Projection};
use glam::{Mat4, Vec3};

/// Standard deviation of the Gaussian that is as wide as the Blackman–Harris window of radius 1.5 px \[px\].
const HARRIS_SIGMA: f32 = 0.415_53;

pub(super) fn write(view: &View, output: &str, beside: &mut Beside, out: &mut Words) -> Result<(), ExportError> {
    let camera = camera(beside.scene, view);
    let [width, height] = view.size;
    let aspect = width as f32 / height as f32;

    // World → camera, whose z is ahead.
    let to_world = camera.to_world * Mat4::from_scale(Vec3::new(1.0, 1.0, -1.0));
    out.matrix("Transform", to_world.as_dmat4().inverse().as_mat4());
    match camera.projection {
        Projection::Perspective { fov } => {
            // Half-sizes of the window at distance 1; the shorter side counts.
            let half = match fov {
                Fov::Vertical(angle) => (0.5 * angle).tan() * glam::Vec2::new(aspect, 1.0),
                Fov::Horizontal(angle) => (0.5 * angle).tan() * glam::Vec2::new(1.0, 1.0 / aspect),
            };
            out.line("Camera \"perspective\"").float("fov", 2.0 * half.min_element().atan().to_degrees());
        }
        Projection::Orthographic { half_height } => {
            let half = half_height * glam::Vec2::new(aspect, 1.0);
            out.line("Camera \"orthographic\"").floats("screenwindow", &[-half.x, half.x, -half.y, half.y]);
        }
        Projection::Equirectangular => {
            // Its poles are ±z, and its middle is −x there.
            beside.note("the equirectangular camera is pbrt's spherical one, turned");
            let turned = to_world * Mat4::from_cols_array_2d(&SPHERICAL);
            *out = Words::default();
            out.matrix("Transform", turned.as_dmat4().inverse().as_mat4());
            out.line("Camera \"spherical\"").string("mapping", "equirectangular");
        }
    }
    if let Some(lens) = camera.lens.filter(|lens| lens.radius > 0.0) {
        out.float("lensradius", lens.radius).float("focaldistance", lens.focus_distance);
    }

    out.line("Film \"rgb\"").string("filename", output).integer("xresolution", width).integer("yresolution", height);
    match view.filter {
        Filter::Box => {
            out.line("PixelFilter \"box\"").float("xradius", 0.5).float("yradius", 0.5);
        }
        Filter::Gaussian => gaussian(0.5, out),
        Filter::BlackmanHarris => {
            beside.note("the Blackman-Harris pixel filter is a Gaussian of the same variance; box is the same in both");
            gaussian(HARRIS_SIGMA, out);
        }
    }
    out.line("Sampler \"independent\"").integer("pixelsamples", view.spp);
    Ok(())
}

/// Axes of the spherical camera in the space whose x is right, y up and z ahead. There the direction of the film point
/// (u, v) is (sin θ cos φ, cos θ, sin θ sin φ) after y and z have changed places, θ = π v from the top, φ = 2π u.
const SPHERICAL: [[f32; 4]; 4] =
    [[0.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

fn gaussian(sigma: f32, out: &mut Words) {
    let filter = out.line("PixelFilter \"gaussian\"").float("xradius", 1.5).float("yradius", 1.5);
    filter.float("sigma", sigma);
}
