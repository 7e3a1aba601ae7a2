//! The Beckmann microsurface: Gaussian slopes, Smith masking and shadowing, visible normals.

use super::Ggx;
use super::rough_reflection::Microsurface;
use crate::math::sqr;
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

const FRAC_1_SQRT_PI: f32 = 0.564_189_6;

/// Beckmann microsurface of roughness α along x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beckmann {
    /// αx.
    pub ax: f32,
    /// αy.
    pub ay: f32,
}

impl Beckmann {
    /// Distribution of normals D(m) = e^(−tan²θ/α²)/(π α² cos⁴θ) \[1/sr\] (Beckmann & Spizzichino 1963; Walter et al. 2007,
    /// eq. 25).
    #[inline]
    pub fn d(&self, m: Vec3) -> f32 {
        let z2 = sqr(m.z);
        let e = -(sqr(m.x / self.ax) + sqr(m.y / self.ay)) / z2;
        // Too steep for a number.
        if e.is_nan() || e < -80.0 { 0.0 } else { e.exp() / (PI * self.ax * self.ay * z2 * z2) }
    }

    /// Λ(w) = (erf a − 1 + e^(−a²)/(a√π))/2, a = 1/(α tan θ) (Heitz 2014, eq. 72).
    #[inline]
    pub fn lambda(&self, w: Vec3) -> f32 {
        let slope = Vec2::new(self.ax * w.x, self.ay * w.y).length();
        if slope == 0.0 {
            return 0.0;
        }
        lambda(w.z.abs() / slope)
    }

    /// Smith masking G₁ = 1/(1 + Λ).
    #[inline]
    pub fn g1(&self, w: Vec3) -> f32 {
        1.0 / (1.0 + self.lambda(w))
    }

    /// Height-correlated masking and shadowing over the cosines, G₂/(|cos o||cos i|), G₂ = 1/(1 + Λo + Λi)
    /// (Heitz 2014, eq. 99).
    #[inline]
    pub fn g2_over_cosines(&self, o: Vec3, i: Vec3) -> f32 {
        // |cos|Λ stays finite at the horizon.
        let (zo, zi) = (o.z.abs(), i.z.abs());
        1.0 / (zo * zi + self.scaled(o) * zi + self.scaled(i) * zo)
    }

    /// |cos θ| Λ.
    #[inline]
    fn scaled(&self, w: Vec3) -> f32 {
        let slope = Vec2::new(self.ax * w.x, self.ay * w.y).length();
        if slope == 0.0 { 0.0 } else { slope * scaled_lambda(w.z.abs() / slope) }
    }

    /// Density \[1/sr\] of visible normals over the cosine ⟨o·m⟩: G₁(o) D(m)/cos o.
    #[inline]
    pub fn visible_over_cosine(&self, o: Vec3, m: Vec3) -> f32 {
        self.d(m) / (o.z.abs() + self.scaled(o))
    }

    /// Density of visible normals D_o(m) \[1/sr\] = G₁(o)⟨o·m⟩D(m)/cos o.
    #[inline]
    pub fn visible_pdf(&self, o: Vec3, m: Vec3) -> f32 {
        self.visible_over_cosine(o, m) * o.dot(m).max(0.0)
    }

    /// Normal visible from `o` (o.z > 0). Stretched to unit roughness, slopes are Gaussian, and those across the plane
    /// of `o` do not change what is seen; along it, slopes up to x, rising towards o, are seen with (Heitz & d'Eon 2014)
    ///
    /// ```text
    /// C(x) = ∫ (cos θ − x sin θ) e^(−x²)/√π dx = (1 + erf x) cos θ/2 + sin θ e^(−x²)/(2√π),    x ≤ cot θ
    /// ```
    ///
    /// which Newton's method inverts, kept between bounds.
    #[inline]
    pub fn sample_visible(&self, o: Vec3, u: [f32; 2]) -> Vec3 {
        let s = Vec3::new(self.ax * o.x, self.ay * o.y, o.z).normalize();
        let sin = s.truncate().length();
        let toward = if sin > 0.0 { s.truncate() / sin } else { Vec2::X };
        let x = visible_slope(s.z, sin, u[0]);
        let y = inverse_erf(2.0 * u[1] - 1.0);
        // Where the surface rises by x towards o, the normal leans away from it.
        let slope = toward.perp() * y - toward * x;
        Vec3::new(self.ax * slope.x, self.ay * slope.y, 1.0).normalize()
    }
}

impl Microsurface for Beckmann {
    #[inline]
    fn of(ggx: Ggx) -> Self {
        Self { ax: ggx.ax, ay: ggx.ay }
    }
    #[inline]
    fn d(&self, m: Vec3) -> f32 {
        Self::d(self, m)
    }
    #[inline]
    fn g2_over_cosines(&self, o: Vec3, i: Vec3) -> f32 {
        Self::g2_over_cosines(self, o, i)
    }
    #[inline]
    fn visible_over_cosine(&self, o: Vec3, m: Vec3) -> f32 {
        Self::visible_over_cosine(self, o, m)
    }
    #[inline]
    fn sample_visible(&self, o: Vec3, u: [f32; 2]) -> Vec3 {
        Self::sample_visible(self, o, u)
    }
}

/// x of C(x) = u.
#[inline]
fn visible_slope(cos: f32, sin: f32, u: f32) -> f32 {
    let c = |x: f32| {
        let (erf, gauss) = erf(x);
        (0.5 * (1.0 + erf) * cos + 0.5 * FRAC_1_SQRT_PI * sin * gauss, gauss)
    };
    // Beyond four deviations nothing is left that f32 could tell from the ends.
    let (mut low, mut high) = (-4.2f32, (cos / sin.max(1e-6)).min(4.2));
    let (all, _) = c(high);
    let target = u * all;
    let mut x = inverse_erf((2.0 * u - 1.0).clamp(-0.999, 0.999)).min(high);
    for _ in 0..24 {
        let (value, gauss) = c(x);
        let off = value - target;
        if off.abs() < 1e-7 {
            break;
        }
        if off > 0.0 {
            high = x
        } else {
            low = x
        }
        // dC/dx = (cos θ − x sin θ) e^(−x²)/√π.
        let next = x - off / ((cos - x * sin) * gauss * FRAC_1_SQRT_PI);
        x = if next > low && next < high { next } else { 0.5 * (low + high) };
    }
    x
}

/// Λ over a.
#[inline]
fn lambda(a: f32) -> f32 {
    scaled_lambda(a) / a
}

/// a Λ(a), which is 1/(2√π) at the horizon.
#[inline]
fn scaled_lambda(a: f32) -> f32 {
    if a > 4.0 {
        // Less than 10⁻⁸.
        return 0.0;
    }
    let (erf, gauss) = erf(a);
    (0.5 * (gauss * FRAC_1_SQRT_PI - a * (1.0 - erf))).max(0.0)
}

/// erf x, within 1.5·10⁻⁷ (Abramowitz & Stegun 7.1.26), and the e^(−x²) in it.
#[inline]
pub(super) fn erf(x: f32) -> (f32, f32) {
    let a = x.abs();
    let t = 1.0 / (1.0 + 0.327_591_1 * a);
    let series = t * (0.254_829_59 + t * (-0.284_496_74 + t * (1.421_413_7 + t * (-1.453_152 + t * 1.061_405_4))));
    let gauss = (-a * a).exp();
    ((1.0 - series * gauss).copysign(x), gauss)
}

/// erf⁻¹ of `x` in [−1, 1], within 10⁻⁶ of itself (Giles 2012, "Approximating the erfinv function", single precision); at
/// the ends, what the last number before them has.
#[inline]
fn inverse_erf(x: f32) -> f32 {
    const CENTRE: [f32; 9] = [
        2.810_226_4e-8,
        3.432_739_4e-7,
        -3.523_387_7e-6,
        -4.391_506_5e-6,
        2.185_808_7e-4,
        -1.253_725e-3,
        -4.177_681_6e-3,
        0.246_640_73,
        1.501_409_4,
    ];
    const TAILS: [f32; 9] = [
        -2.002_142_6e-4,
        1.009_505_6e-4,
        1.349_343_2e-3,
        -3.673_428_4e-3,
        5.739_507_7e-3,
        -7.622_461_3e-3,
        9.438_870_5e-3,
        1.001_674_1,
        2.832_976_8,
    ];
    let x = x.clamp(-0.999_999_94, 0.999_999_94);
    let w = -((1.0 - x) * (1.0 + x)).ln();
    let (terms, t) = if w < 5.0 { (CENTRE, w - 2.5) } else { (TAILS, w.sqrt() - 3.0) };
    terms.into_iter().fold(0.0, |sum, c| sum * t + c) * x
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::function::erf as exact;

    #[test]
    fn error_functions_are_those_of_f64() {
        for i in -400..=400 {
            let x = i as f32 / 100.0;
            assert!((f64::from(erf(x).0) - exact::erf(x.into())).abs() < 4e-7, "{x}");
            let y = i as f32 / 400.5;
            let inverse = exact::erf_inv(f64::from(y));
            assert!((f64::from(inverse_erf(y)) - inverse).abs() < 3e-6 * inverse.abs().max(1.0), "{y}");
        }
        assert!(inverse_erf(1.0).is_finite() && inverse_erf(-1.0).is_finite());
    }

    #[test]
    fn masking_is_exact() {
        let root = std::f64::consts::PI.sqrt();
        for i in 1..400 {
            let a = f64::from(i) / 100.0;
            let lambda_exact = 0.5 * (exact::erf(a) - 1.0 + (-a * a).exp() / (a * root));
            assert!((f64::from(lambda(a as f32)) - lambda_exact).abs() < 1e-6 * (1.0 + lambda_exact), "{a}");
        }
    }

    #[test]
    fn slopes_invert_their_distribution() {
        let root = std::f64::consts::PI.sqrt();
        for (cos, sin) in [(1.0f64, 0.0f64), (0.8, 0.6), (0.1, 0.995), (1e-3, 1.0)] {
            let c = |x: f64| 0.5 * (1.0 + exact::erf(x)) * cos + sin * (-x * x).exp() / (2.0 * root);
            let end = if sin > 0.0 { (cos / sin).min(4.2) } else { 4.2 };
            for i in 0..200 {
                let u = (f64::from(i) + 0.5) / 200.0;
                let x = f64::from(visible_slope(cos as f32, sin as f32, u as f32));
                assert!((c(x) / c(end) - u).abs() < 2e-5, "{cos} {u}: {x}");
            }
        }
    }
}
