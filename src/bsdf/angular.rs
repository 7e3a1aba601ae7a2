//! Reflectance over the angle as a short series, so that energies of rough surfaces are sums.
//!
//! Energy that microfacets reflect is linear in their F(c), c the cosine at the facet. With Chebyshev's polynomials in √c,
//! in which the steep rise at grazing angles is drawn out,
//!
//! ```text
//! F(c) = Σ_j a_j T_j(2√c − 1)    ⇒    E(o) = Σ_j a_j M_j(o),    M_j(o) the energy of a facet that reflects T_j
//! ```
//!
//! The M_j are tabulated ([`super::EnergyAt::reflected`]). Twelve terms follow a metal to rounding and two fringes of a film
//! to 10⁻³ of their height.

use crate::spectrum::Spectrum;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Terms.
pub(super) const TERMS: usize = 12;

/// a_j of R, G and B.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angular([[f32; TERMS]; 3]);

/// c at which a function is looked at, and what takes its values there to a_j.
static NODES: LazyLock<[(f32, [f32; TERMS]); TERMS]> = LazyLock::new(|| {
    let n = TERMS as f64;
    std::array::from_fn(|i| {
        let angle = PI * (i as f64 + 0.5) / n;
        let root = 0.5 * (1.0 + angle.cos());
        let to = |j: usize| (if j == 0 { 1.0 } else { 2.0 }) / n * (j as f64 * angle).cos();
        ((root * root) as f32, std::array::from_fn(|j| to(j) as f32))
    })
});

/// 2 ∫ T_j(2√μ − 1) μ dμ.
static MEANS: LazyLock<[f32; TERMS]> = LazyLock::new(|| {
    // In s = √μ the integrand is a polynomial times 4s³, which midpoints have to 10⁻⁷.
    const N: usize = 8192;
    let mut sum = [0.0; TERMS];
    for i in 0..N {
        let s = (i as f64 + 0.5) / N as f64;
        let t = polynomials(s * s);
        sum = std::array::from_fn(|j| sum[j] + 4.0 * s.powi(3) / N as f64 * t[j]);
    }
    sum.map(|x| x as f32)
});

/// T_j(2√c − 1).
pub(super) fn polynomials(c: f64) -> [f64; TERMS] {
    let x = 2.0 * c.max(0.0).sqrt() - 1.0;
    let mut t = [1.0; TERMS];
    t[1] = x;
    for j in 2..TERMS {
        t[j] = 2.0 * x * t[j - 1] - t[j - 2];
    }
    t
}

impl Angular {
    /// Of a reflectance over the cosine.
    pub fn new(reflectance: impl Fn(f32) -> Spectrum) -> Self {
        let mut a = [[0.0; TERMS]; 3];
        for (c, to) in NODES.iter() {
            for (a, f) in a.iter_mut().zip(reflectance(*c).to_rgb()) {
                a.iter_mut().zip(to).for_each(|(a, to)| *a += to * f);
            }
        }
        Self(a)
    }

    /// Raised by the size of its last terms, so that what a series so short misses of its function does not lie above it.
    pub fn covering(mut self) -> Self {
        for a in &mut self.0 {
            a[0] += a[TERMS - 2..].iter().map(|x| x.abs()).sum::<f32>();
        }
        self
    }

    /// Σ a_j m_j.
    #[inline]
    pub(super) fn dot(&self, m: &[f32; TERMS]) -> Spectrum {
        Spectrum::from_rgb(self.0.map(|a| a.iter().zip(m).map(|(a, m)| a * m).sum()))
    }

    /// Cosine-weighted mean over the hemisphere, 2 ∫ F(μ) μ dμ.
    pub fn average(&self) -> Spectrum {
        self.dot(&MEANS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::{Fresnel, ThinFilm};
    use glam::Vec4;

    fn worst(f: impl Fn(f32) -> Spectrum) -> f32 {
        let series = Angular::new(&f);
        let off = |i| {
            let c = (i as f32 / 200.0).powi(2);
            (series.dot(&polynomials(c.into()).map(|x| x as f32)).0 - f(c).0).abs().max_element()
        };
        (0..=200).map(off).fold(0.0, f32::max)
    }

    #[test]
    fn metals_and_films_are_followed() {
        let gold = Fresnel::complex(Vec4::new(0.18, 0.54, 1.33, 0.54), Vec4::new(3.42, 2.23, 1.87, 2.23));
        assert!(worst(|c| gold.eval(c)) < 2e-5, "{}", worst(|c| gold.eval(c)));
        let average = Angular::new(|c| gold.eval(c)).average();
        assert!((average.0 - gold.average().0).abs().max_element() < 2e-5);
        for (thickness, bound) in [(0.0, 2e-4), (200.0, 2e-4), (400.0, 3e-3), (800.0, 5e-3), (1200.0, 1e-2)] {
            let film = ThinFilm { eta: 1.3, thickness };
            let off = worst(|c| film.reflectance(c, Vec4::splat(0.2)));
            println!("{thickness}: {off:e}");
            assert!(off < bound, "{thickness}: {off:e}");
        }
    }
}
