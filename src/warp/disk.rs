//! Square → disk.

use super::to_unit;
use crate::math::{select, sin_cos_of_eighth};
use glam::Vec2;
use std::f32::consts::{FRAC_1_PI, FRAC_PI_4};

/// Density of [`uniform_disk`] over area.
pub const UNIFORM_DISK_PDF: f32 = FRAC_1_PI;

/// Uniform over the unit disk: concentric squares become concentric circles, areas keep their ratios and neighbours
/// stay neighbours (Shirley & Chiu 1997, "A Low Distortion Map Between Disk and Square").
#[inline]
pub fn uniform_disk(u: [f32; 2]) -> Vec2 {
    let (r, direction) = disk_polar(u);
    r * direction
}

/// The same as radius (either sign) and unit vector, of which the first is known long before the second.
#[inline]
pub(super) fn disk_polar(u: [f32; 2]) -> (f32, Vec2) {
    let (a, b) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    // In the wedge about ±x the radius is a and the angle π/4 b/a; the wedge about ±y is its mirror image.
    let about_x = a.abs() > b.abs();
    let (r, other) = (select(about_x, a, b), select(about_x, b, a));
    // In the middle both are 0.
    let (sin, cos) = sin_cos_of_eighth(FRAC_PI_4 * (other / select(r == 0.0, 1.0, r)));
    (r, Vec2::new(select(about_x, cos, sin), select(about_x, sin, cos)))
}

/// Inverse of [`uniform_disk`].
pub fn uniform_disk_inverse(p: Vec2) -> [f32; 2] {
    let r = p.length();
    let (a, b) = if p.x.abs() > p.y.abs() {
        let a = r.copysign(p.x);
        (a, a * (p.y / p.x).atan() / FRAC_PI_4)
    } else if p.y != 0.0 {
        let b = r.copysign(p.y);
        (b * (p.x / p.y).atan() / FRAC_PI_4, b)
    } else {
        (0.0, 0.0)
    };
    [to_unit(0.5 * a + 0.5), to_unit(0.5 * b + 0.5)]
}
