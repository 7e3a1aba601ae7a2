//! Square → disk.

use super::to_unit;
use crate::math::sin_cos_of_eighth;
use glam::{Vec2, Vec4, Vec4Swizzles};
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

/// The disk point of [`uniform_disk`] as radius (either sign) and unit vector, of which the first is known long before the second.
#[inline]
pub(super) fn disk_polar(u: [f32; 2]) -> (f32, Vec2) {
    let (a, b) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    // In the wedge about ±x the radius is a and the angle π/4 b/a; the wedge about ±y is its mirror image. Choices are made
    // by masks, lane by lane: which wedge it is, no branch could guess.
    let point = Vec4::new(a, b, b, a);
    let size = point.abs();
    let about_x = size.xxww().cmpgt(size.yyzz());
    let [r, other, ..] = Vec4::select(about_x, point, point.zwxy()).to_array();
    // In the middle both are 0.
    let (sin, cos) = sin_cos_of_eighth(FRAC_PI_4 * (other / r.abs().max(f32::MIN_POSITIVE).copysign(r)));
    let direction = Vec4::new(cos, sin, sin, cos);
    (r, Vec4::select(about_x, direction, direction.zwxy()).xy())
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
