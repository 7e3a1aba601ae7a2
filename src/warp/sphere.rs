//! Square → directions. All build on the concentric disk: with r² uniform on [0, 1), 1 − cos θ = k r² is uniform on
//! the cap (Archimedes), and sin θ = √((1 − cos θ)(1 + cos θ)) loses nothing near the pole.

use super::disk::disk_polar;
use super::{to_unit, uniform_disk, uniform_disk_inverse};
use crate::math::safe_sqrt;
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, PI};

/// Density of [`uniform_hemisphere`] \[1/sr\].
pub const UNIFORM_HEMISPHERE_PDF: f32 = 0.5 * FRAC_1_PI;

/// Density of [`uniform_sphere`] \[1/sr\].
pub const UNIFORM_SPHERE_PDF: f32 = 0.25 * FRAC_1_PI;

/// Direction about +z with density cos θ/π: a uniform point of the disk, lifted to the hemisphere (Malley).
#[inline]
pub fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    let (r, direction) = disk_polar(u);
    (r * direction).extend(safe_sqrt(1.0 - r * r))
}

/// Density of [`cosine_hemisphere`] \[1/sr\]; 0 below the horizon.
#[inline]
pub fn cosine_hemisphere_pdf(cos_theta: f32) -> f32 {
    cos_theta.max(0.0) * FRAC_1_PI
}

/// Inverse of [`cosine_hemisphere`].
pub fn cosine_hemisphere_inverse(w: Vec3) -> [f32; 2] {
    uniform_disk_inverse(w.truncate())
}

/// Uniform direction about +z within the hemisphere.
#[inline]
pub fn uniform_hemisphere(u: [f32; 2]) -> Vec3 {
    uniform_cone(u, 1.0)
}

/// Inverse of [`uniform_hemisphere`].
pub fn uniform_hemisphere_inverse(w: Vec3) -> [f32; 2] {
    uniform_cone_inverse(w, 1.0)
}

/// Uniform direction.
#[inline]
pub fn uniform_sphere(u: [f32; 2]) -> Vec3 {
    uniform_cone(u, 2.0)
}

/// Inverse of [`uniform_sphere`].
pub fn uniform_sphere_inverse(w: Vec3) -> [f32; 2] {
    uniform_cone_inverse(w, 2.0)
}

/// Uniform direction about +z within the cone of half-angle θmax, given as `one_minus_cos` = 1 − cos θmax in (0, 2]:
/// that number keeps its precision where the cone is too narrow for the cosine (see [`one_minus_cos_of_sin2`]).
#[inline]
pub fn uniform_cone(u: [f32; 2], one_minus_cos: f32) -> Vec3 {
    let d = uniform_disk(u);
    let r2 = d.length_squared().min(1.0);
    let height = one_minus_cos * r2;
    // sin θ/r = √(k (2 − k r²)).
    (d * safe_sqrt(one_minus_cos * (2.0 - height))).extend(1.0 - height)
}

/// Density of [`uniform_cone`] inside the cone \[1/sr\].
#[inline]
pub fn uniform_cone_pdf(one_minus_cos: f32) -> f32 {
    1.0 / (2.0 * PI * one_minus_cos)
}

/// Inverse of [`uniform_cone`], for directions in the cone.
pub fn uniform_cone_inverse(w: Vec3, one_minus_cos: f32) -> [f32; 2] {
    let sin2 = w.truncate().length_squared();
    // 1 − cos θ from the sine near +z, where the cosine has lost it, and from the cosine where the sine has.
    let height = if w.z > 0.5 { one_minus_cos_of_sin2(sin2) } else { 1.0 - w.z };
    let r = safe_sqrt(height / one_minus_cos).min(1.0);
    let axis = if sin2 > 0.0 { w.truncate() / sin2.sqrt() } else { Vec2::X };
    uniform_disk_inverse(axis * r).map(to_unit)
}

/// 1 − cos θ = sin²θ/(1 + cos θ) for θ ≤ π/2, without cancellation.
#[inline]
pub fn one_minus_cos_of_sin2(sin2_theta: f32) -> f32 {
    sin2_theta / (1.0 + safe_sqrt(1.0 - sin2_theta))
}
