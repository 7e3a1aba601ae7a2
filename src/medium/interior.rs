//! The inside of a closed surface, as an interface needs to know it.

use super::Medium;
use crate::spectrum::WAVELENGTHS;
use glam::Vec4;

/// What a material's surface encloses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interior {
    /// Index of refraction over vacuum, per lane.
    pub index: Vec4,
    /// What the light passes.
    pub medium: Medium,
    /// Where interiors overlap, the highest is there and the others are not.
    pub priority: i32,
}

impl Interior {
    /// The index changes over the lanes: what passes its surface must choose one.
    #[inline]
    pub fn disperses(&self) -> bool {
        self.index != Vec4::splat(self.index.x)
    }
}

/// Cauchy's formula of two terms, n(λ) = max(1, A + B/λ²) (Cauchy 1836), as KHR_materials_dispersion uses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cauchy {
    /// A.
    pub a: f64,
    /// B \[nm²\].
    pub b: f64,
}

/// Fraunhofer's lines d (helium), F and C (hydrogen) \[nm\].
const D: f64 = 587.56;
const F: f64 = 486.13;
const C: f64 = 656.27;

impl Cauchy {
    /// Through the index `n` at the line d, with the Abbe number V = (n_d − 1)/(n_F − n_C), given as `inverse` = 1/V:
    ///
    /// ```text
    /// B = (n_d − 1)/V / (1/λ_F² − 1/λ_C²),   A = n_d − B/λ_d²
    /// ```
    pub fn of_abbe(n: f64, inverse: f64) -> Self {
        let b = (n - 1.0) * inverse / (F.powi(-2) - C.powi(-2));
        Self { a: n - b / (D * D), b }
    }

    /// Index at `lambda` \[nm\].
    pub fn at(&self, lambda: f64) -> f64 {
        (self.a + self.b / (lambda * lambda)).max(1.0)
    }

    /// Indices of the lanes, at [`WAVELENGTHS`].
    pub fn lanes(&self) -> Vec4 {
        Vec4::from_array(WAVELENGTHS.map(|lambda| self.at(lambda) as f32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// BK7: n_d = 1.5168, V = 64.17; Schott's catalogue gives n_F = 1.52238, n_C = 1.51432.
    #[test]
    fn the_abbe_number_is_that_of_the_curve() {
        let glass = Cauchy::of_abbe(1.5168, 1.0 / 64.17);
        assert!((glass.at(D) - 1.5168).abs() < 1e-12);
        let v = (glass.at(D) - 1.0) / (glass.at(F) - glass.at(C));
        assert!((v - 64.17).abs() < 1e-9, "{v}");
        assert!((glass.at(F) - 1.52238).abs() < 2e-4 && (glass.at(C) - 1.51432).abs() < 2e-4);
        let [r, g, b, g2] = glass.lanes().to_array();
        assert!(r < g && g < b && g == g2);
        assert_eq!(Cauchy::of_abbe(1.5, 0.0).lanes(), Vec4::splat(1.5));
        assert_eq!(Cauchy::of_abbe(1.0, 1.0).at(400.0), 1.0);
    }
}
