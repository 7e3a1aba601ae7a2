//! Sums per pixel, their errors, and images.
//!
//! | file | what |
//! | --- | --- |
//! | `accumulator.rs` | sums of one pixel over one replicate |
//! | `sums.rs` | [`Film`]: sums of all pixels over all replicates; mean and standard error |
//! | `filter.rs` | pixel filters by importance sampling |
//! | `image.rs` | [`Image`]: named layers of f32 channels |
//! | `develop.rs` | film → image |
//! | `header.rs` | what an image says about itself |
//! | `exr.rs` | OpenEXR in and out |
//! | `tonemap.rs`, `agx.rs`, `png.rs` | radiance → display |
//! | `compare.rs` | two images: errors and z |
//! | `file.rs` | whole files or none |

mod accumulator;
mod agx;
mod compare;
mod develop;
pub mod exr;
pub mod file;
mod filter;
mod header;
mod image;
pub mod png;
mod sums;
mod tonemap;

pub use accumulator::{Accumulator, CLASSES, Invalid};
pub use compare::{CompareError, Comparison, Evidence, compare, difference_colors};
pub use develop::{LayerKind, develop};
pub use filter::{filter_density, filter_offset, filter_radius};
pub use header::{Header, Origin};
pub use image::{Image, Layer};
pub use sums::{Film, MergeError};
pub use tonemap::Display;

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
}
