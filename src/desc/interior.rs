//! What a refracting material encloses.

/// The inside of the closed surfaces that a material covers. The index of refraction is that of the material's model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interior {
    /// σ_a \[1/m\], linear RGB, finite, at least 0: exp(−σ_a t) of the light is left after t metres.
    pub absorption: [f32; 3],
    /// Where interiors overlap, that of the highest priority is there; among equals the one entered last.
    pub priority: i32,
    /// How the index changes over the wavelengths.
    pub dispersion: Dispersion,
}

/// The index of refraction over the wavelengths.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Dispersion {
    /// None: one index for all wavelengths.
    #[default]
    None,
    /// 1/V, V the Abbe number; the model's index is n_d. At least 0.
    InverseAbbe(f32),
    /// n = A + B/λ², B in µm².
    Cauchy([f32; 2]),
}

impl Dispersion {
    /// The index at Fraunhofer's d line, 587.56 nm, where it does not depend on the model's own: readers give the model this one.
    pub fn index(self) -> Option<f32> {
        const D: f32 = 0.587_56;
        match self {
            Self::None | Self::InverseAbbe(_) => None,
            Self::Cauchy([a, b]) => Some(a + b / (D * D)),
        }
    }
}

/// σ_a = −ln(colour)/distance \[1/m\]: what is left of white light after `distance` \[m\] is `color`.
pub fn absorption(color: [f32; 3], distance: f32) -> [f32; 3] {
    // Black takes more than a number can say.
    color.map(|c| (-c.clamp(0.0, 1.0).ln() / distance).clamp(0.0, f32::MAX))
}

#[cfg(test)]
mod tests {
    use super::absorption;

    #[test]
    fn white_is_clear_and_black_is_finite() {
        let [half, white, black] = absorption([0.5, 1.0, 0.0], 2.0);
        assert!((half - 0.5 * 2f32.ln()).abs() < 1e-7);
        assert_eq!([white, black], [0.0, f32::MAX]);
        assert_eq!(absorption([0.5; 3], f32::INFINITY), [0.0; 3]);
    }
}
