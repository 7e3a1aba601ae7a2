//! L5 and L6: environments.
//!
//! Uniform radiance L₀ gives E = π L₀, as a constant and as an image of equal texels. One bright texel of radiance L over a
//! rest of L_b gives E = (L − L_b) n·∫ω dω + π L_b with ∫ω dω over the texel in closed form.

use super::environment_light;
use super::irradiance::{Lit, ROUNDING};
use crate::desc;
use crate::texture::Textures;
use crate::verify::{Task, Topic};
use glam::{DVec3, Mat3, Quat, Vec3};
use std::f64::consts::{PI, TAU};

pub(super) const L5: Topic =
    Topic { id: "L5", title: "uniform environment: E = π L₀", source: "∫ cosθ dω = π over the hemisphere" };

pub(super) const L6: Topic = Topic {
    id: "L6",
    title: "environment map with one bright texel: E = (L − L_b) n·∫ω dω + π L_b",
    source: "∫ω dω over Δφ × Δθ in closed form",
};

pub(super) fn tasks() -> Vec<Task> {
    let images =
        [("constant", None), ("8×4 image", Some([8, 4])), ("3×1 image", Some([3, 1])), ("1×64 image", Some([1, 64]))];
    let uniform = images.map(|(name, size)| {
        let white = |size: [u32; 2]| image(size, |_| 1.0);
        let light = environment_light(1.5, size.map(white), Mat3::from_quat(Quat::from_rotation_x(0.8)));
        Task::new(L5, format!("{name} by light sampling and hemisphere"), move |trial, found| {
            let n = Vec3::new(0.48, 0.6, -0.64);
            let lit = Lit { light: &light, p: Vec3::ZERO, n, textures: &Textures::default() };
            lit.check(trial, found, "E", 1.5 * PI);
        })
    });
    let texels = [(8, 3, 0.0), (3, 0, 0.0), (15, 7, 0.0), (0, 5, 0.1), (11, 0, 0.3), (7, 7, 0.01)];
    uniform.into_iter().chain(texels.map(|(column, row, rest)| bright_texel(column, row, rest))).collect()
}

/// A grey image.
fn image(size: [u32; 2], value: impl Fn(u32) -> f32) -> desc::Image {
    let pixels = (0..size[0] * size[1]).map(|i| [value(i), value(i), value(i), 1.0]).collect();
    desc::Image { name: "image".into(), size, pixels: desc::Pixels::Rgba32F(pixels) }
}

/// One bright texel over a dim rest, at the poles and elsewhere, turned.
fn bright_texel(column: u32, row: u32, rest: f32) -> Task {
    let size = [16u32, 8];
    let rotation = Mat3::from_quat(Quat::from_axis_angle(Vec3::new(1.0, -2.0, 0.5).normalize(), 2.0));
    let light =
        environment_light(1.0, Some(image(size, |i| if i == row * size[0] + column { 200.0 } else { rest })), rotation);

    // The receiver faces the texel obliquely: all of it is above the horizon.
    let theta = std::f32::consts::PI * (row as f32 + 0.5) / size[1] as f32;
    let phi = std::f32::consts::TAU * ((column as f32 + 0.5) / size[0] as f32 - 0.5);
    let towards = Vec3::new(theta.sin() * phi.sin(), theta.cos(), -theta.sin() * phi.cos());
    let n = (rotation * (towards + 0.5 * towards.any_orthonormal_vector())).normalize();
    let local = (rotation.transpose() * n).as_dvec3();
    let rest = f64::from(rest);
    let exact = (200.0 - rest) * texel_irradiance(size, column, row, local) + PI * rest;
    let name = format!("texel ({column}, {row}) over {rest:.2} by light sampling and hemisphere");
    Task::new(L6, name, move |trial, found| {
        let lit = Lit { light: &light, p: Vec3::ZERO, n, textures: &Textures::default() };
        found.checks.replicated("E: light", exact, &lit.by_light(trial, exact), ROUNDING);
        // Directions about the normal hardly ever meet a lone texel: those about the texel do.
        let met = if rest > 0.0 { lit.by_hemisphere(trial, exact) } else { lit.by_chart(trial, exact) };
        found.checks.replicated("E: meeting it", exact, &met, ROUNDING);
    })
}

/// n·∫ω dω over a texel: irradiance on a receiver with normal `n` (local) from texel (column, row) of radiance 1, wholly
/// above its horizon.
fn texel_irradiance([width, height]: [u32; 2], column: u32, row: u32, n: DVec3) -> f64 {
    let phi = |c: u32| TAU * (f64::from(c) / f64::from(width) - 0.5);
    let theta = |r: u32| PI * f64::from(r) / f64::from(height);
    let (p0, p1, t0, t1) = (phi(column), phi(column + 1), theta(row), theta(row + 1));
    // ∫ sin² θ dθ and ∫ sin θ cos θ dθ.
    let sin2 = 0.5 * (t1 - t0) - 0.25 * ((2.0 * t1).sin() - (2.0 * t0).sin());
    let sin_cos = 0.5 * (t1.sin().powi(2) - t0.sin().powi(2));
    n.dot(DVec3::new(sin2 * (p0.cos() - p1.cos()), sin_cos * (p1 - p0), -sin2 * (p1.sin() - p0.sin())))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ω dω over the sphere is 0, over the upper half π along +y.
    #[test]
    fn texels_add_up() {
        let sum = |rows: std::ops::Range<u32>, n: DVec3| {
            rows.flat_map(|row| (0..16).map(move |c| texel_irradiance([16, 8], c, row, n))).sum::<f64>()
        };
        for n in [DVec3::X, DVec3::Y, DVec3::Z] {
            assert!(sum(0..8, n).abs() < 1e-13);
        }
        assert!((sum(0..4, DVec3::Y) - PI).abs() < 1e-13);
    }
}
