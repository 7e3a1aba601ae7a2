//! Thin films: light of the two faces of a layer interferes.
//!
//! With r₁, r₂ the amplitudes that the outer and the inner face reflect and φ = 4π n d cos θ_f / λ the phase of one way
//! there and back, Airy's sum over all ways gives what a lossless film lets through (Born & Wolf, section 7.6.1),
//!
//! ```text
//! T = (1 − r₁²)(1 − r₂²) / (1 + r₁² r₂² + 2 r₁ r₂ cos φ),    R = 1 − T
//! ```
//!
//! As a Fourier series with q = −r₁ r₂ that is
//!
//! ```text
//! T = (1 − r₁²)(1 − r₂²) / (1 − q²) · (1 + 2 Σ_{m≥1} q^m cos mφ)
//! ```
//!
//! and so a lane, which weighs the wavelengths by w(λ), has the exact
//!
//! ```text
//! T_lane = (1 − r₁²)(1 − r₂²) / (1 − q²) · (1 + 2 Σ q^m S(mD)),    S(D) = Σ_λ w(λ) cos(2πD/λ),    D = 2 n d cos θ_f
//! ```
//!
//! where amplitudes do not change within a lane. (Belcour & Barla 2017 sum the same series, with Gaussians for w.) S is
//! tabulated from the standard observer's curves under D65. Both polarisations are summed apart and averaged.
//!
//! Colours outside BT.709 are clipped to [0, 1]: there a lane would reflect less than nothing.

use crate::math::{safe_sqrt, sqr};
use crate::spectrum::{Spectrum, observer};
use glam::Vec4;
use std::f64::consts::TAU;
use std::sync::LazyLock;

/// A film on a base that is seen from outside, where the index is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinFilm {
    /// Index of refraction, at least 1.
    pub eta: f32,
    /// Thickness \[nm\].
    pub thickness: f32,
}

/// The faces of a film for one polarisation: energy that passes the outer and the inner one, and q.
#[derive(Clone, Copy, Debug)]
struct Faces {
    outer: f32,
    inner: Vec4,
    q: Vec4,
}

impl Faces {
    /// Of admittances: x before and y behind a face reflect (x − y)/(x + y) of the amplitude.
    #[inline]
    fn new(outer: [f32; 2], inner: [Vec4; 2]) -> Self {
        let ([x, y], [z, w]) = (outer, inner);
        // Where both vanish, at the horizon, nothing passes.
        let (sum, sums) = (1.0 / (x + y).max(1e-30), (z + w).max(Vec4::splat(1e-30)).recip());
        let q = (z - w) * sums * (-(x - y) * sum);
        Self { outer: 4.0 * (x * sum) * (y * sum), inner: 4.0 * (z * sums) * (w * sums), q }
    }

    /// T of incoherent light: the mean over φ.
    #[inline]
    fn mean(&self) -> Vec4 {
        // 1 − q² without the cancellation.
        let lost = self.inner * (1.0 - self.outer) + Vec4::splat(self.outer);
        let t = self.inner * self.outer / lost.max(Vec4::splat(f32::MIN_POSITIVE));
        Vec4::select(lost.cmpgt(Vec4::ZERO), t, Vec4::ZERO)
    }
}

impl ThinFilm {
    /// Faces for perpendicular and parallel polarisation, and the cosine within the film. `root` is √F₀ of the base, seen
    /// without a film: its index is (1 + √F₀)/(1 − √F₀).
    #[inline]
    fn faces(&self, cos: f32, root: Vec4) -> ([Faces; 2], f32) {
        let n = self.eta;
        // Snell, by what the squares of cosines have more than cos²: nothing cancels at grazing angles.
        let film = safe_sqrt((n - 1.0) * (n + 1.0) + cos * cos) / n;
        // Indices times 1 − √F₀, so that white has one.
        let (over, under) = (Vec4::ONE - root, Vec4::ONE + root);
        let base = (4.0 * root + over * over * (cos * cos)).map(f32::sqrt) / under;
        let perpendicular = Faces::new([cos, n * film], [over * (n * film), under * base]);
        let parallel = Faces::new([n * cos, film], [under * film, over * base * n]);
        ([perpendicular, parallel], film)
    }

    /// Unpolarised reflectance of light of one wavelength \[nm\] on a base of reflectance `f0` at normal incidence.
    pub fn monochromatic(&self, cos: f32, f0: f32, wavelength: f32) -> f32 {
        let (faces, film) = self.faces(cos, Vec4::splat(safe_sqrt(f0)));
        let phase = TAU * f64::from(2.0 * self.eta * self.thickness * film / wavelength);
        let transmitted = faces.map(|f| {
            let (q, t) = (f64::from(f.q.x), f64::from(f.outer * f.inner.x));
            t / (1.0 + q * q - 2.0 * q * phase.cos())
        });
        1.0 - 0.5 * (transmitted[0] + transmitted[1]) as f32
    }

    /// Unpolarised reflectance by lanes, in [0, 1], at the angle of cosine `cos` ≥ 0 outside, on a base that alone reflects
    /// `f0` at normal incidence; `root` is √F₀.
    #[inline]
    pub fn reflectance(&self, cos: f32, root: Vec4) -> Spectrum {
        let ([s, p], film) = self.faces(cos, root);
        let (mean_s, mean_p) = (s.mean(), p.mean());
        let path = 2.0 * self.eta * self.thickness * film;
        // Orders, until all that follow are less than this together, or none is coherent.
        const TOLERANCE: f32 = 1e-5;
        let mut transmitted = 0.5 * (mean_s + mean_p);
        let (mut order_s, mut order_p) = (mean_s * s.q, mean_p * p.q);
        let largest = s.q.abs().max(p.q.abs()).max_element();
        let mut rest = mean_s.abs().max(mean_p.abs()).max_element() * largest / (1.0 - largest).max(1e-6);
        let mut d = path;
        while rest > TOLERANCE && d < COHERENT {
            transmitted += (order_s + order_p) * coherence(d);
            (order_s, order_p) = (order_s * s.q, order_p * p.q);
            (rest, d) = (rest * largest, d + path);
        }
        Spectrum((Vec4::ONE - transmitted).clamp(Vec4::ZERO, Vec4::ONE))
    }
}

/// Path difference \[nm\] beyond which no lane sees interference.
const COHERENT: f32 = 16_000.0;
/// From here on the little that is left is faded out.
const FADING: f32 = 12_000.0;
/// Step of the table \[nm\]: 48 to a wave of the shortest light.
const STEP: f32 = 8.0;

/// S(D), by lanes, for 0 ≤ D < [`COHERENT`]: the cubic through four nodes.
#[inline]
fn coherence(d: f32) -> Vec4 {
    static TABLE: LazyLock<Vec<Vec4>> = LazyLock::new(|| {
        // One node before 0, where S is even, and two behind the end.
        (-1..=(COHERENT / STEP) as i32 + 2).map(|i| coherence_at(i as f32 * STEP)).collect()
    });
    let t = d / STEP;
    let i = (t as usize).min(TABLE.len() - 4);
    let x = t - i as f32;
    let (a, b, c, e) = (x + 1.0, x, x - 1.0, x - 2.0);
    let nodes = &TABLE[i..i + 4];
    nodes[0] * (b * c * e / -6.0)
        + nodes[1] * (a * c * e * 0.5)
        + nodes[2] * (a * b * e * -0.5)
        + nodes[3] * (a * b * c / 6.0)
}

/// S(D) from its definition, faded.
fn coherence_at(d: f32) -> Vec4 {
    let mut sum = [0.0; 3];
    for (wavelength, weights) in observer::LANES.iter() {
        let cos = (TAU * f64::from(d) / wavelength).cos();
        sum = std::array::from_fn(|k| sum[k] + weights[k] * cos);
    }
    let t = ((d - FADING) / (COHERENT - FADING)).clamp(0.0, 1.0);
    let fade = sqr(1.0 - t) * (1.0 + 2.0 * t);
    Spectrum::from_rgb(sum.map(|x| x as f32 * fade)).0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::fresnel::dielectric;

    const BASES: [f32; 6] = [0.0, 0.02, 0.04, 0.3, 0.9, 1.0];
    const COSINES: [f32; 7] = [1.0, 0.9, 0.6, 0.3, 0.1, 0.01, 1e-4];

    fn film(eta: f32, thickness: f32) -> ThinFilm {
        ThinFilm { eta, thickness }
    }

    fn index(f0: f32) -> f32 {
        (1.0 + f0.sqrt()) / (1.0 - f0.sqrt())
    }

    /// Mean over wavelengths of the closed form.
    fn exact(film: ThinFilm, cos: f32, f0: f32) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (wavelength, weights) in observer::LANES.iter() {
            let r = f64::from(film.monochromatic(cos, f0, *wavelength as f32));
            sum = std::array::from_fn(|k| sum[k] + weights[k] * r);
        }
        sum.map(|r| r.clamp(0.0, 1.0))
    }

    /// The integral has a nanometre's step, and what is resonant at grazing angles between clear faces is narrower.
    #[test]
    fn lanes_are_the_integral_over_the_spectrum() {
        for f0 in BASES {
            for (eta, thickness) in
                [(1.3, 80.0), (1.33, 400.0), (1.8, 300.0), (2.4, 700.0), (1.5, 1200.0), (1.3, 3000.0)]
            {
                for (cos, bound) in [(1.0, 1e-4), (0.6, 1e-4), (0.3, 2e-4), (0.1, 4e-4)] {
                    let film = film(eta, thickness);
                    let (lanes, exact) = (film.reflectance(cos, Vec4::splat(f0.sqrt())).to_rgb(), exact(film, cos, f0));
                    let off = (0..3).map(|k| (f64::from(lanes[k]) - exact[k]).abs()).fold(0.0, f64::max);
                    assert!(off < bound, "{film:?} F0 {f0} cos {cos}: {lanes:?} {exact:?}");
                }
            }
        }
    }

    #[test]
    fn without_thickness_or_contrast_there_is_the_bare_interface() {
        for f0 in [0.02, 0.04, 0.3, 0.9] {
            for cos in COSINES {
                let bare = dielectric(cos, index(f0)).0;
                let root = Vec4::splat(f0.sqrt());
                for film in [film(1.7, 0.0), film(index(f0), 350.0), film(1.0, 350.0)] {
                    let r = film.reflectance(cos, root).0;
                    assert!(
                        (r - Vec4::splat(bare)).abs().max_element() < 1e-4,
                        "{film:?} F0 {f0} cos {cos}: {r} {bare}"
                    );
                    let one = film.monochromatic(cos, f0, 500.0);
                    assert!((one - bare).abs() < 1e-5, "{film:?} F0 {f0} cos {cos}: {one} {bare}");
                }
            }
        }
    }

    /// λ/4: R = ((n₀ n_s − n₁²)/(n₀ n_s + n₁²))²; λ/2: as if there were no film (Born & Wolf, section 1.6.4).
    #[test]
    fn quarter_and_half_waves_are_known() {
        for (eta, f0) in [(1.38, 0.0426), (2.3, 0.04), (1.22, 0.04), (1.3, 0.5)] {
            let n = index(f0);
            let quarter = ((n - eta * eta) / (n + eta * eta)).powi(2);
            let r = film(eta, 550.0 / (4.0 * eta)).monochromatic(1.0, f0, 550.0);
            assert!((r - quarter).abs() < 1e-5, "{eta} {f0}: {r} {quarter}");
            let r = film(eta, 550.0 / (2.0 * eta)).monochromatic(1.0, f0, 550.0);
            assert!((r - f0).abs() < 1e-5, "{eta} {f0}: {r}");
        }
    }

    #[test]
    fn corners_give_numbers() {
        for (eta, thickness) in [(1.0, 0.0), (1.0, 300.0), (1.3, 1e-30), (1.3, f32::MAX), (1e3, 1e5)] {
            for f0 in BASES {
                for cos in [0.0, 1e-38, 1e-20, 1e-7, 1e-3, 1.0] {
                    let r = film(eta, thickness).reflectance(cos, Vec4::splat(f0.sqrt())).0;
                    let bounded = r.cmpge(Vec4::ZERO).all() && r.cmple(Vec4::ONE).all();
                    assert!(bounded && (cos > 0.0 || r == Vec4::ONE), "n {eta} d {thickness} F0 {f0} cos {cos}: {r}");
                }
            }
        }
    }

    #[test]
    fn nothing_is_left_where_coherence_ends() {
        for i in 0..1000 {
            let d = FADING + 20.0 * i as f32;
            let mut sum = [0.0; 3];
            for (wavelength, weights) in observer::LANES.iter() {
                let cos = (TAU * f64::from(d) / wavelength).cos();
                sum = std::array::from_fn(|k| sum[k] + weights[k] * cos);
            }
            assert!(sum.iter().all(|s| s.abs() < 8e-3), "{d}: {sum:?}");
        }
    }
}
