//! The sun as a disk that is far away, because the targets' lights from infinity are points or images.

use super::beside::Beside;
use crate::desc::bounds;
use glam::{Mat4, Quat, Vec3};
use std::f32::consts::PI;

/// How far away it stands, in extents of the scene.
const DISTANCE: f32 = 1000.0;

/// A disk about the z axis, moved, that shines along its normal.
pub(super) struct Disk {
    pub(super) to_world: Mat4,
    pub(super) radius: f32,
    pub(super) radiance: [f32; 3],
}

/// The disk of this irradiance: E = π L sin²(δ/2) on what faces it from the middle of the scene.
pub(super) fn disk(direction: Vec3, irradiance: [f32; 3], diameter: f32, beside: &mut Beside) -> Disk {
    beside.note("the sun is a disk 1000 times as far away as the scene is large");
    let (sin, cos) = (0.5 * diameter).sin_cos();
    let middle = bounds(beside.scene).map_or(Vec3::ZERO, |(low, high)| (0.5 * (low + high)).as_vec3());
    let distance = DISTANCE * reach(beside, middle);
    let turn = Mat4::from_quat(Quat::from_rotation_arc(Vec3::Z, direction));
    Disk {
        to_world: Mat4::from_translation(middle - direction * distance) * turn,
        radius: distance * sin / cos,
        radiance: irradiance.map(|e| e / (PI * sin * sin)),
    }
}

/// Distance \[m\] from a point to the farthest corner of the scene's box.
pub(super) fn reach(beside: &Beside, from: Vec3) -> f32 {
    let Some((low, high)) = bounds(beside.scene) else { return 1.0 };
    let from = from.as_dvec3();
    ((low - from).abs().max((high - from).abs()).length() as f32).clamp(1e-6, 1e12)
}
