//! A point light with a measured distribution of intensity.

use super::LightSample;
use super::point::sample_position;
use super::tree::LightBounds;
use crate::desc::ies::{Photometry, Profile};
use crate::spectrum::Spectrum;
use glam::{Mat3, Vec3, Vec3A};
use std::f32::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

/// Radiates from a point as an IES file says.
///
/// In the light's own frame the aim is −z. Type C: the vertical angle is the angle from the aim, the horizontal one runs
/// from +x to +y. Types A and B: the vertical plane is that of x and z, and horizontal angles run clockwise as seen from +x,
/// to −y; with the polar axis x (A) the vertical angle is the elevation above the plane of y and z, with the polar axis y (B)
/// the horizontal one is that above the plane of x and z. This is the frame of EXT_lights_ies.
#[derive(Clone, Debug)]
pub struct ProfileLight {
    position: Vec3A,
    to_local: Mat3,
    /// Factor on the candelas, the tilt's included.
    intensity: Spectrum,
    profile: Arc<Profile>,
    /// Mean over the sphere \[cd\].
    mean: f32,
}

impl ProfileLight {
    /// At `position`, turned by the rotation `to_world`, its candelas times linear RGB.
    pub fn new(position: Vec3, to_world: Mat3, intensity: [f32; 3], profile: Arc<Profile>) -> Self {
        let mean = mean(&profile);
        Self {
            position: position.into(),
            to_local: to_world.transpose(),
            intensity: Spectrum::from_rgb(intensity) * profile.tilt_factor(to_world),
            profile,
            mean,
        }
    }

    /// E⊥ = I(ω)/r².
    #[inline]
    pub fn sample(&self, p: Vec3A) -> Option<LightSample> {
        sample_position(self.position, p, f32::INFINITY, |w| self.intensity * candela(&self.profile, self.to_local * w))
    }

    /// Φ = ∫ I dω.
    pub fn power(&self) -> Spectrum {
        self.intensity * (4.0 * PI * self.mean)
    }

    /// A point; it may shine to wherever it likes.
    pub(super) fn bounds(&self, flux: f64) -> LightBounds {
        LightBounds::round(self.position, self.position, flux / (4.0 * f64::from(PI)))
    }
}

/// ∫ I dω/4π by midpoints: half a degree and less is far finer than measurements are.
fn mean(profile: &Profile) -> f32 {
    const ROWS: u32 = 720;
    const COLUMNS: u32 = 720;
    let mut sum = 0.0;
    for row in 0..ROWS {
        // Equal steps of the angle from the pole, each weighted by its share of the sphere.
        let theta = |row: f64| std::f64::consts::PI * row / f64::from(ROWS);
        let (top, bottom) = (theta(f64::from(row)), theta(f64::from(row) + 1.0));
        let share = 0.5 * (top.cos() - bottom.cos()) * f64::from(ROWS);
        let (sin, cos) = theta(f64::from(row) + 0.5).sin_cos();
        for column in 0..COLUMNS {
            let phi = std::f64::consts::TAU * (f64::from(column) + 0.5) / f64::from(COLUMNS);
            let w = Vec3A::new((sin * phi.cos()) as f32, (sin * phi.sin()) as f32, -cos as f32);
            sum += share * f64::from(candela(profile, w));
        }
    }
    (sum / f64::from(ROWS * COLUMNS)) as f32
}

/// Intensity \[cd\] towards the unit vector `w` of the light's frame: bilinear between the angles measured, 0 where none
/// was.
#[inline]
fn candela(profile: &Profile, w: Vec3A) -> f32 {
    let (vertical, horizontal) = match profile.kind {
        Photometry::C => (w.x.hypot(w.y).atan2(-w.z), folded(profile, w.y.atan2(w.x))),
        Photometry::A => (w.x.atan2(w.y.hypot(w.z)), (-w.y).atan2(-w.z)),
        Photometry::B => (w.x.atan2(-w.z), (-w.y).atan2(w.x.hypot(w.z))),
    };
    let plane = |angles: &[f32], angle: f32| match profile.kind {
        // Measured on one side: the other is its mirror image.
        Photometry::A | Photometry::B if angles[0] == 0.0 => angle.abs(),
        _ => angle,
    };
    let (v, h) = (plane(&profile.vertical, vertical), plane(&profile.horizontal, horizontal));
    let rows = profile.vertical.len();
    match (bracket(&profile.vertical, v.to_degrees()), bracket(&profile.horizontal, h.to_degrees())) {
        (Some((i, s)), Some((j, t))) => {
            let at = |i: usize, j: usize| profile.candela[j.min(profile.horizontal.len() - 1) * rows + i.min(rows - 1)];
            let along = |j: usize| at(i, j) + s * (at(i + 1, j) - at(i, j));
            along(j) + t * (along(j + 1) - along(j))
        }
        _ => 0.0,
    }
}

/// The horizontal angle of type C, in (−π, π], within the range that was measured, by the symmetry that this implies.
#[inline]
fn folded(profile: &Profile, angle: f32) -> f32 {
    let last = profile.horizontal[profile.horizontal.len() - 1];
    let turned = if angle < 0.0 { angle + TAU } else { angle };
    match last {
        // About the axis, each quarter alike, each half alike, all round; and halves about the plane of y and z.
        0.0 => 0.0,
        90.0 => FRAC_PI_2 - (angle.abs() - FRAC_PI_2).abs(),
        180.0 => angle.abs(),
        270.0 if turned < FRAC_PI_2 => PI - turned,
        270.0 if turned > 3.0 * FRAC_PI_2 => 3.0 * PI - turned,
        _ => turned,
    }
}

/// The interval of the angles that holds `x`, and how far in it; `None` outside all of them, but for rounding.
#[inline]
fn bracket(angles: &[f32], x: f32) -> Option<(usize, f32)> {
    const ROUNDING: f32 = 1e-3;
    let last = angles.len() - 1;
    if x < angles[0] - ROUNDING || x > angles[last] + ROUNDING {
        return None;
    }
    let i = angles.partition_point(|&angle| angle <= x).clamp(1, last.max(1)) - 1;
    let width = angles[(i + 1).min(last)] - angles[i];
    Some((i, if width > 0.0 { ((x - angles[i]) / width).clamp(0.0, 1.0) } else { 0.0 }))
}
