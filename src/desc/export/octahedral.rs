//! Environments on the square of equal areas that pbrt looks up (Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere
//! using SIMD"; Pharr, Jakob & Humphreys, 4th edition, section 3.8.3).

use super::picture::texel;
use crate::desc;
use crate::film::Image;
use glam::{Mat3, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_4, PI, TAU};

/// Points per axis that a pixel is averaged over.
const FINE: usize = 4;

/// Largest side \[pixels\].
const MAX_SIDE: u32 = 4096;

/// The unit vector at a point of the unit square, z up.
fn direction(p: Vec2) -> Vec3 {
    let (u, v) = (2.0 * p.x - 1.0, 2.0 * p.y - 1.0);
    let outside = 1.0 - (u.abs() + v.abs());
    let r = 1.0 - outside.abs();
    let phi = FRAC_PI_4 * if r > 0.0 { (v.abs() - u.abs()) / r + 1.0 } else { 1.0 };
    let rho = r * (2.0 - r * r).max(0.0).sqrt();
    let (sin, cos) = phi.sin_cos();
    Vec3::new(cos.copysign(u) * rho, sin.copysign(v) * rho, (1.0 - r * r).copysign(outside))
}

/// The image of as many pixels, directions in the world.
pub(super) fn octahedral(image: &desc::Image, factor: [f32; 3], to_world: Mat3) -> Image {
    let [width, height] = image.size.map(|n| n as usize);
    let side = ((width as f32 * height as f32).sqrt().ceil() as u32).clamp(2, MAX_SIDE);
    let srgb = image.pixels.are_codes();
    let look = |w: Vec3| {
        let w = to_world.transpose() * w;
        let x = (w.x.atan2(-w.z) / TAU + 0.5) * width as f32;
        let y = w.y.clamp(-1.0, 1.0).acos() / PI * height as f32;
        let [r, g, b, _] =
            texel(&image.pixels, (y as usize).min(height - 1) * width + (x as usize).min(width - 1), srgb);
        Vec3::new(r, g, b).max(Vec3::ZERO)
    };
    let pixel = |i: u32| {
        let corner = Vec2::new((i % side) as f32, (i / side) as f32);
        let inside = (0..FINE * FINE).map(|k| (Vec2::new((k % FINE) as f32, (k / FINE) as f32) + 0.5) / FINE as f32);
        let sum: Vec3 = inside.map(|offset| look(direction((corner + offset) / side as f32))).sum();
        (sum / (FINE * FINE) as f32 * Vec3::from(factor)).to_array()
    };
    let mut out = Image { size: [side; 2], window: [0, 0, side, side], ..Image::default() };
    out.insert_rgb(Image::BEAUTY, (0..side * side).map(pixel));
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::desc::Pixels;

    /// Directions are unit, fill the sphere evenly, and the middle is +z.
    #[test]
    fn areas_are_equal() {
        const N: usize = 64;
        let points = (0..N * N).map(|i| (Vec2::new((i % N) as f32, (i / N) as f32) + 0.5) / N as f32);
        let (mut first, mut second) = (Vec3::ZERO, Mat3::ZERO);
        for w in points.map(direction) {
            assert!((w.length() - 1.0).abs() < 1e-5);
            first += w / (N * N) as f32;
            second += Mat3::from_cols(w * w.x, w * w.y, w * w.z) * (1.0 / (N * N) as f32);
        }
        assert!(first.length() < 1e-4, "{first}");
        assert!(second.abs_diff_eq(Mat3::IDENTITY * (1.0 / 3.0), 1e-3), "{second}");
        assert!((direction(Vec2::splat(0.5)) - Vec3::Z).length() < 1e-6);
        assert!(direction(Vec2::new(0.75, 0.5)).x > 0.5 && direction(Vec2::new(0.5, 0.75)).y > 0.5);
    }

    #[test]
    fn the_flux_is_that_of_the_image() {
        let (width, height) = (64u32, 32u32);
        let value = |i: u32| [1.0 + (i % width) as f32, (i / width) as f32, 1.0, 1.0];
        let pixels = Pixels::Rgba32F((0..width * height).map(value).collect());
        let image = desc::Image { name: String::new(), size: [width, height], pixels };
        let out = octahedral(&image, [1.0, 1.0, 2.0], Mat3::from_rotation_y(1.0));
        let [r, g, b] = out.rgb(Image::BEAUTY).unwrap().map(|c| c.iter().sum::<f32>() / c.len() as f32);
        // Means over the sphere: 32.5, 15.5, and the factor.
        assert!((r - 32.5).abs() < 0.1 && (g - 15.5).abs() < 0.1 && (b - 2.0).abs() < 1e-5, "{r} {g} {b}");
    }
}
