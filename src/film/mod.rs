//! Sums per pixel, their errors, and images.
//!
//! | file | what |
//! | --- | --- |
//! | `layer.rs` | [`GROUPS`]: the list of all layers |
//! | `layers.rs` | [`Layers`]: the layers of a film, their places, and which values they take |
//! | `replicate.rs` | [`Replicate`]: sums of the pixels of an area over one replicate |
//! | `sample.rs` | sums over samples, before layers select from them |
//! | `splats.rs`, `exact.rs` | [`Splats`]: what paths bring to other pixels than their own, in exact sums |
//! | `sums.rs` | [`Film`]: sums of all pixels over all replicates; mean and standard error |
//! | `state.rs` | a film as bytes |
//! | `filter.rs` | pixel filters by importance sampling |
//! | `image.rs` | [`Image`]: named layers of f32 channels |
//! | `develop.rs` | film → image |
//! | `header.rs` | what an image says about itself |
//! | `exr.rs` | OpenEXR in and out |
//! | `tonemap.rs`, `agx.rs`, `png.rs` | radiance → display |
//! | `compare.rs` | two images: errors and z |
//! | `file.rs` | whole files or none |

mod agx;
mod compare;
mod develop;
mod exact;
pub mod exr;
pub mod file;
mod filter;
mod header;
mod image;
mod layer;
mod layers;
pub mod png;
mod replicate;
mod sample;
mod splats;
mod state;
mod sums;
mod tonemap;

pub use compare::{CompareError, Comparison, Evidence, compare, difference_colors};
pub use develop::develop;
pub use filter::{filter_density, filter_offset, filter_radius};
pub use header::{Header, Origin};
pub use image::{Channels, Image};
pub use layer::{ByClass, CLASSES, GROUPS, Group, Kind, Layer, TRANSPORT};
pub use layers::{Invalid, Layers};
pub use replicate::Replicate;
pub use splats::Splats;
pub use state::StateError;
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
