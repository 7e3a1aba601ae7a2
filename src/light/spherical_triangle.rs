//! Spherical triangles: solid angle and uniform sampling.

use glam::{DVec3, Vec3A};
use std::f64::consts::PI;

/// Least solid angle \[sr\] that is sampled: below it a triangle is tiny or seen edge-on, where its angles on the
/// sphere are differences of nearly equal numbers.
const LEAST: f64 = 1e-6;

/// Greatest solid angle \[sr\]: just under that of a reference point in the triangle, 2π.
const GREATEST: f64 = 2.0 * PI - LEAST;

/// A triangle projected onto the unit sphere about a reference point. In f64: the cost of it is small beside the three
/// square roots and two angles needed, and the sampling is sound for every triangle that it accepts.
#[derive(Clone, Copy, Debug)]
pub struct SphericalTriangle {
    a: DVec3,
    b: DVec3,
    c: DVec3,
    /// |a·(b × c)|.
    triple: f64,
    solid_angle: f64,
}

impl SphericalTriangle {
    /// Triangle `p` as seen from `reference`; `None` where its solid angle is too small or too large to be sampled.
    /// The decision is a function of these arguments alone, so density and sampling always agree on it.
    ///
    /// tan(Ω/2) = |a·(b × c)| / (1 + a·b + b·c + c·a) (Van Oosterom & Strackee 1983).
    #[inline]
    pub fn new(p: &[Vec3A; 3], reference: Vec3A) -> Option<Self> {
        let o = reference.as_dvec3();
        // A corner at the reference point makes NaN, which fails the comparison below.
        let [a, b, c] = p.map(|p| (p.as_dvec3() - o).normalize());
        let triple = a.dot(b.cross(c)).abs();
        let solid_angle = 2.0 * triple.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a));
        (LEAST..GREATEST).contains(&solid_angle).then_some(Self { a, b, c, triple, solid_angle })
    }

    /// Solid angle \[sr\].
    #[inline]
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// Direction drawn uniformly over the solid angle (Arvo 1995, "Stratified Sampling of Spherical Triangles").
    ///
    /// `u[0]` picks the area u₀Ω of the sub-triangle (a, b, c') with c' on the edge ac; `u[1]` places the direction on
    /// the arc from b to c'. Sine and cosine of the angle α at a come from cross products, the rest from addition
    /// theorems, so that the only angle evaluated is u₀Ω.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> DVec3 {
        let Self { a, b, c, triple, solid_angle } = *self;
        let [u0, u1] = u.map(f64::from);

        // α, the dihedral angle at a, and φ = u₀Ω − α.
        let (ab, ac) = (a.cross(b), a.cross(c));
        let norm = (ab.length_squared() * ac.length_squared()).sqrt();
        let (sin_alpha, cos_alpha) = (triple / norm, ab.dot(ac) / norm);
        let (sin_area, cos_area) = (u0 * solid_angle).sin_cos();
        let s = sin_area * cos_alpha - cos_area * sin_alpha;
        let t = cos_area * cos_alpha + sin_area * sin_alpha;

        // q = cos of the arc from a to c', with cos of the arc from a to b = a·b.
        let (v, w) = (t - cos_alpha, s + sin_alpha * a.dot(b));
        let denominator = (w * s + v * t) * sin_alpha;
        let q = if denominator == 0.0 { 1.0 } else { ((w * t - v * s) * cos_alpha - w) / denominator };
        let c_hat = towards(a, c, q.clamp(-1.0, 1.0));

        let z = 1.0 - u1 * (1.0 - c_hat.dot(b));
        towards(b, c_hat, z)
    }
}

/// Unit vector, to rounding, on the arc from `x` towards `y`, at the angle from `x` whose cosine is `cos`.
#[inline]
fn towards(x: DVec3, y: DVec3, cos: f64) -> DVec3 {
    let side = (y - x * y.dot(x)).normalize_or_zero();
    x * cos + side * (1.0 - cos * cos).max(0.0).sqrt()
}
