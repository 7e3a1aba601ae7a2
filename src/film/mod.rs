//! Sums per pixel, their errors, and images.

use crate::spectrum::Spectrum;
use glam::Vec3;

/// What one path tells about one pixel.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelSample {
    /// Radiance along the camera ray.
    pub radiance: Spectrum,
    /// 1 where the camera ray met a surface.
    pub alpha: f32,
    /// Directional-hemispherical reflectance at the first surface.
    pub albedo: Spectrum,
    /// Shading normal at the first surface, world space.
    pub normal: Vec3,
    /// Distance from the camera to the first surface \[m\]; 0 where there is none.
    pub depth: f32,
    /// `radiance` split by the classes of the last two reflections before the eye: emission, D, S, DD, SD, DS, SS
    /// (SD: specular, then diffuse, then the eye: a caustic).
    pub transport: [Spectrum; 7],
}
