//! The GGX microsurface: distribution of normals, Smith masking and shadowing, visible normals.
//!
//! Written with the stretched length s(w) = √(αx² x² + αy² y² + z²), for which Λ(w) = (s/|z| − 1)/2; that keeps every
//! quotient of masking terms and cosines finite at grazing angles.

use super::rough_reflection::Microsurface;
use crate::math::safe_sqrt;
use glam::Vec3;
use std::f32::consts::{PI, TAU};

/// Below this roughness α an interface is smooth: a delta.
pub const MIN_ALPHA: f32 = 1e-4;

/// GGX (Trowbridge–Reitz) microsurface of roughness α along x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    /// αx.
    pub ax: f32,
    /// αy.
    pub ay: f32,
}

impl Ggx {
    /// Distribution of normals D(m) \[1/sr\], ∫ D(m)(n·m) dm = 1 over the upper hemisphere (Walter et al. 2007, eq. 33;
    /// Heitz 2014, eq. 85).
    #[inline]
    pub fn d(&self, m: Vec3) -> f32 {
        let (x, y) = (m.x / self.ax, m.y / self.ay);
        let e = x * x + y * y + m.z * m.z;
        1.0 / (PI * self.ax * self.ay * e * e)
    }

    /// s(w), the length of `w` where the microsurface has unit roughness.
    #[inline]
    pub fn stretch(&self, w: Vec3) -> f32 {
        Vec3::new(self.ax * w.x, self.ay * w.y, w.z).length()
    }

    /// Smith masking G₁ = 1/(1 + Λ) = 2|z|/(|z| + s).
    #[inline]
    pub fn g1(&self, w: Vec3) -> f32 {
        2.0 * w.z.abs() / (w.z.abs() + self.stretch(w))
    }

    /// Height-correlated masking and shadowing over the cosines, G₂/(|cos o||cos i|), G₂ = 1/(1 + Λo + Λi)
    /// (Heitz 2014, eq. 99); used for both sides.
    #[inline]
    pub fn g2_over_cosines(&self, o: Vec3, i: Vec3) -> f32 {
        2.0 / (self.stretch(o) * i.z.abs() + self.stretch(i) * o.z.abs())
    }

    /// Density \[1/sr\] of visible normals over the cosine ⟨o·m⟩: D_o(m)/⟨o·m⟩ = G₁(o) D(m)/cos o.
    #[inline]
    pub fn visible_over_cosine(&self, o: Vec3, m: Vec3) -> f32 {
        2.0 * self.d(m) / (o.z.abs() + self.stretch(o))
    }

    /// Density of visible normals D_o(m) \[1/sr\] = G₁(o)⟨o·m⟩D(m)/cos o.
    #[inline]
    pub fn visible_pdf(&self, o: Vec3, m: Vec3) -> f32 {
        self.visible_over_cosine(o, m) * o.dot(m).max(0.0)
    }

    /// Normal visible from `o` (o.z > 0): the half-vector of the stretched `o` and a uniform point of the spherical
    /// cap above −o.z (Dupuy & Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps").
    #[inline]
    pub fn sample_visible(&self, o: Vec3, u: [f32; 2]) -> Vec3 {
        let o = Vec3::new(self.ax * o.x, self.ay * o.y, o.z).normalize();
        let hz = (1.0 - u[1]) * (1.0 + o.z);
        let z = hz - o.z;
        let r = safe_sqrt(u[1] * (1.0 + o.z) * (1.0 + z));
        let (sin, cos) = (TAU * u[0]).sin_cos();
        Vec3::new(self.ax * (r * cos + o.x), self.ay * (r * sin + o.y), hz).normalize_or(Vec3::Z)
    }
}

impl Microsurface for Ggx {
    #[inline]
    fn of(ggx: Self) -> Self {
        ggx
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

/// Mirrors `w` about the unit vector `m`.
#[inline]
pub fn reflect(w: Vec3, m: Vec3) -> Vec3 {
    m * (2.0 * w.dot(m)) - w
}

/// The normal that mirrors `o` to `i`, and the cosine of either to it.
#[inline]
pub fn half_vector(o: Vec3, i: Vec3) -> (Vec3, f32) {
    let sum = o + i;
    let length = sum.length();
    if length > 0.0 { (sum / length, (0.5 * length).min(1.0)) } else { (Vec3::Z, 0.0) }
}
