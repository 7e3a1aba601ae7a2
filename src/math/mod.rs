//! Frames, rays and the small numerical tools under everything else.

mod frame;
mod ray;
mod transform;

pub use frame::Frame;
pub use ray::{Ray, offset_origin};
pub use transform::Transform;

use glam::Vec3A;

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

/// Sine and cosine within an eighth of a turn, |x| ≤ π/4, to 10⁻⁷: Cephes' polynomials (Moshier 1989), which take no call
/// and no branch.
#[inline]
pub fn sin_cos_of_eighth(x: f32) -> (f32, f32) {
    let z = x * x;
    let sin = x + x * z * (z * (z * -1.951_529_6e-4 + 8.332_161e-3) - 1.666_665_5e-1);
    let cos = 1.0 - 0.5 * z + z * z * (z * (z * 2.443_315_7e-5 - 1.388_731_6e-3) + 4.166_664_6e-2);
    (sin, cos)
}

/// `v` of length 1 but for rounding, made so: one step of Newton's for 1/√|v|².
#[inline]
pub fn renormalize(v: Vec3A) -> Vec3A {
    v * (1.5 - 0.5 * v.length_squared())
}

/// Difference of products a·b − c·d with the rounding error of one fused operation where the machine has it
/// (Kahan; Jeannerod et al. 2013), computed here in f64, which holds both products of f32 exactly.
#[inline]
pub fn difference_of_products(a: f32, b: f32, c: f32, d: f32) -> f32 {
    (a as f64 * b as f64 - c as f64 * d as f64) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_of_an_eighth_are_right() {
        for i in -1000..=1000 {
            let x = i as f32 / 1000.0 * std::f32::consts::FRAC_PI_4;
            let (sin, cos) = sin_cos_of_eighth(x);
            let (exact_sin, exact_cos) = f64::from(x).sin_cos();
            assert!((f64::from(sin) - exact_sin).abs() < 1e-7 && (f64::from(cos) - exact_cos).abs() < 1e-7, "{x}");
        }
    }

    #[test]
    fn what_is_nearly_of_unit_length_becomes_so() {
        let v = Vec3A::new(0.48, -0.6, 0.64);
        for scale in [0.9999, 1.0, 1.0001] {
            assert!((renormalize(v * scale).length() - 1.0).abs() < 2e-7);
        }
    }
}
