//! Frames, rays and the small numerical tools under everything else.

mod frame;
mod ray;
mod transform;

pub use frame::Frame;
pub use ray::{Ray, offset_origin};
pub use transform::Transform;

/// Half the distance between 1 and the next f32: the largest relative error of one rounding.
pub const UNIT_ROUNDOFF: f32 = f32::EPSILON * 0.5;

/// Bound γₙ = nε/(1 − nε) on the relative error of `n` successive f32 operations (Higham 2002, section 3.1).
pub const fn gamma(n: u32) -> f32 {
    let ne = n as f32 * UNIT_ROUNDOFF;
    ne / (1.0 - ne)
}

/// x².
#[inline]
pub fn sqr(x: f32) -> f32 {
    x * x
}

/// √max(x, 0): a square root that forgives rounding below zero.
#[inline]
pub fn safe_sqrt(x: f32) -> f32 {
    x.max(0.0).sqrt()
}

/// Difference of products a·b − c·d with the rounding error of one fused operation where the machine has it
/// (Kahan; Jeannerod et al. 2013), computed here in f64, which holds both products of f32 exactly.
#[inline]
pub fn difference_of_products(a: f32, b: f32, c: f32, d: f32) -> f32 {
    (a as f64 * b as f64 - c as f64 * d as f64) as f32
}
