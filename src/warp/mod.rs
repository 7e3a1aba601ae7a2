//! Maps of the unit square, each with its density and its inverse.
//!
//! All take `u` in [0, 1)² and keep strata together where they can, so that low-discrepancy points stay so. The
//! inverses return numbers in [0, 1), up to rounding the ones that the map was given.

mod disk;
mod filter;
mod specimens;
mod sphere;
mod table;
mod triangle;

pub use disk::{UNIFORM_DISK_PDF, uniform_disk, uniform_disk_inverse};
pub use filter::{blackman_harris, gaussian};
pub use specimens::{Specimen, Warp, specimens};
pub use sphere::{
    UNIFORM_HEMISPHERE_PDF, UNIFORM_SPHERE_PDF, cosine_hemisphere, cosine_hemisphere_inverse, cosine_hemisphere_pdf,
    one_minus_cos_of_sin2, uniform_cone, uniform_cone_inverse, uniform_cone_pdf, uniform_hemisphere,
    uniform_hemisphere_inverse, uniform_sphere, uniform_sphere_inverse,
};
pub use table::{Draw1, Draw2, Table1, Table2};
pub use triangle::{uniform_triangle, uniform_triangle_inverse};

/// Largest f32 below 1.
pub const ONE_MINUS_EPSILON: f32 = 1.0 - f32::EPSILON / 2.0;

/// Into [0, 1): what rounding carries out of the unit interval is brought back.
#[inline]
pub(crate) fn to_unit(x: f32) -> f32 {
    x.clamp(0.0, ONE_MINUS_EPSILON)
}
