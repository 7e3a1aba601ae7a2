//! The keys of what a refracting material encloses.

use super::color::Grey;
use super::keys::keys;
use super::read::{At, Fault, Fraction, NonNegative, Number, Positive};
use crate::desc::{Dispersion, Interior, absorption};

keys! {
    /// What the closed surfaces of a refracting material enclose.
    struct InteriorTable {
        /// Absorption coefficient inside in 1/m: a number or [r, g, b]; exp(-absorption t) is left after t metres. Default 0: clear.
        absorption: Option<At<Grey<NonNegative>>>,
        /// In place of it: what is left of white light after the attenuation distance, each channel in [0, 1].
        attenuation_color: Option<At<Grey<Fraction>>>,
        /// Distance in m after which white light has the attenuation colour.
        attenuation_distance: Option<At<Positive>>,
        /// Where closed surfaces overlap, the inside of the highest priority is there; among equals the one entered last. Default 0.
        priority: i32 = 0,
        /// Abbe number V of the inside: its index changes over the wavelengths as Cauchy's formula through `ior` at 587.6 nm. Default: it does not.
        abbe: Option<At<Positive>>,
    }
}

impl InteriorTable {
    /// As the scene has it.
    pub(super) fn build(&self) -> Result<Interior, Fault> {
        Ok(Interior {
            absorption: self.absorption()?,
            priority: self.priority,
            dispersion: self.abbe.as_ref().map_or(Dispersion::None, |v| Dispersion::InverseAbbe(1.0 / v.value.0)),
        })
    }

    fn absorption(&self) -> Result<[f32; 3], Fault> {
        match (&self.absorption, &self.attenuation_color, &self.attenuation_distance) {
            (None, None, None) => Ok([0.0; 3]),
            (Some(sigma), None, None) => Ok(sigma.value.0.map(|x| x.0)),
            (None, Some(color), Some(distance)) => Ok(absorption(color.value.0.map(|x| x.0), distance.value.0)),
            (Some(sigma), ..) => Err(Fault::new(
                &sigma.at,
                "`attenuation_color` or `attenuation_distance` is given too; expected one way",
            )),
            (None, Some(color), None) => {
                Err(Fault::new(&color.at, "`attenuation_color` is given without `attenuation_distance`"))
            }
            (None, None, Some(distance)) => {
                Err(Fault::new(&distance.at, "`attenuation_distance` is given without `attenuation_color`"))
            }
        }
    }
}

/// The index of a dielectric: of `ior`, or of `cauchy`, which says the dispersion too.
pub(super) fn index(
    ior: Option<&At<Positive>>,
    cauchy: Option<&At<[Number; 2]>>,
    interior: &mut Interior,
) -> Result<f32, Fault> {
    /// Fraunhofer's d line \[µm\], where an index is meant that stands alone.
    const D: f32 = 0.587_56;
    let Some(At { at, value: [a, b] }) = cauchy else { return Ok(ior.map_or(1.5, |ior| ior.value.0)) };
    if ior.is_some() || interior.dispersion != Dispersion::None {
        return Err(Fault::new(at, "`ior` or `abbe` is given too; expected one way"));
    }
    let index = a.0 + b.0 / (D * D);
    if !(1.0..f32::INFINITY).contains(&index) {
        return Err(Fault::new(at, format!("the index A + B/0.58756² is {index}, expected at least 1")));
    }
    interior.dispersion = Dispersion::Cauchy([a.0, b.0]);
    Ok(index)
}
