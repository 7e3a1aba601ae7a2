//! What fills the inside of closed surfaces: homogeneous media, their index of refraction, and which of them a path is in.
//!
//! | file | what is there |
//! | --- | --- |
//! | this | [`Medium`]: transmittance along a distance |
//! | `interior` | [`Interior`]: medium, index of refraction over the lanes, priority |
//! | `stack` | [`MediumStack`]: the interiors about a point, by priority; true and false surfaces |

mod interior;
mod stack;

pub use interior::{Cauchy, Interior};
pub use stack::{Crossing, MOST_NESTED, MediumStack};

use crate::spectrum::Spectrum;

/// A homogeneous medium that absorbs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// σ_a \[1/m\] per lane, finite, ≥ 0.
    pub absorption: Spectrum,
}

impl Medium {
    /// Nothing: light passes unchanged.
    pub const CLEAR: Self = Self { absorption: Spectrum::ZERO };

    /// Light passes unchanged.
    #[inline]
    pub fn is_clear(&self) -> bool {
        self.absorption.is_black()
    }

    /// Share of radiance that is left after `t` \[m\], which may be infinite:
    ///
    /// ```text
    /// T(t) = exp(−σ_a t)
    /// ```
    ///
    /// (Bouguer 1729; Lambert 1760; Beer 1852). A lane that nothing absorbs keeps all of it even from infinity.
    #[inline]
    pub fn transmittance(&self, t: f32) -> Spectrum {
        self.absorption.map(|sigma| if sigma > 0.0 { (-sigma * t).exp() } else { 1.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_is_left_after_the_half_length() {
        let medium = Medium { absorption: Spectrum::from_rgb([2f32.ln(), 0.0, f32::MAX]) };
        let [r, g, b] = medium.transmittance(2.0).to_rgb();
        assert!((r - 0.25).abs() < 1e-7);
        assert_eq!([g, b], [1.0, 0.0]);
        assert_eq!(medium.transmittance(f32::INFINITY).to_rgb(), [0.0, 1.0, 0.0]);
        assert_eq!(medium.transmittance(0.0), Spectrum::ONE);
    }
}
