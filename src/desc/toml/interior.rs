//! The keys of what a refracting material encloses.

use super::color::Rgb;
use super::keys::keys;
use super::number::{Fraction, NonNegative, Number, Positive};
use super::read::{At, Fault};
use super::short::Each;
use crate::desc::{Dispersion, Interior, absorption};

keys! {
    /// What the closed surfaces of a refracting material enclose.
    struct InteriorTable {
        /// Absorption coefficient inside in 1/m: a number or [r, g, b]; exp(-absorption t) is left after t metres. Default 0: clear.
        absorption: Option<At<Rgb<NonNegative>>>,
        /// In place of it: what is left of white light after the attenuation distance, each channel in [0, 1].
        attenuation_color: Option<At<Rgb<Fraction>>>,
        /// Distance in m after which white light has the attenuation colour.
        attenuation_distance: Option<At<Positive>>,
        /// Where closed surfaces overlap, the inside of the highest priority is there; among equals the one entered last. Default 0.
        priority: i32 = 0,
        /// Abbe number V of the inside: its index changes over the wavelengths as Cauchy's formula through `ior` at 587.6 nm. Default: it does not.
        abbe: Option<At<Positive>>,
        /// In place of it: 1/V, at least 0.
        inverse_abbe: Option<At<NonNegative>>,
        /// In place of the index and its change: [A, B] of Cauchy's formula n = A + B/wavelength², B in µm².
        cauchy: Option<At<[Number; 2]>>,
    }
}

impl InteriorTable {
    /// As the scene has it.
    pub(super) fn build(&self) -> Result<Interior, Fault> {
        Ok(Interior { absorption: self.absorption()?, priority: self.priority, dispersion: self.dispersion()? })
    }

    fn dispersion(&self) -> Result<Dispersion, Fault> {
        match (&self.abbe, &self.inverse_abbe, &self.cauchy) {
            (None, None, None) => Ok(Dispersion::None),
            (Some(v), None, None) => Ok(Dispersion::InverseAbbe(1.0 / v.value.0)),
            (None, Some(x), None) => Ok(Dispersion::InverseAbbe(x.value.0)),
            (None, None, Some(cauchy)) => Ok(Dispersion::Cauchy(cauchy.value.map(|x| x.0))),
            (None, Some(second), Some(_)) | (Some(_), Some(second), _) => {
                Err(Fault::new(&second.at, "`abbe` or `cauchy` is given too; expected one way"))
            }
            (Some(_), None, Some(cauchy)) => {
                Err(Fault::new(&cauchy.at, "`ior` or `abbe` is given too; expected one way"))
            }
        }
    }

    /// The index of refraction: of `ior`, or of Cauchy's formula.
    pub(super) fn index(&self, ior: Option<&At<Positive>>) -> Result<f32, Fault> {
        let Some(At { at, value }) = &self.cauchy else { return Ok(ior.map_or(1.5, |ior| ior.value.0)) };
        if ior.is_some() {
            return Err(Fault::new(at, "`ior` or `abbe` is given too; expected one way"));
        }
        let index = Dispersion::Cauchy(value.map(|x| x.0)).index().unwrap_or(f32::NAN);
        if !(1.0..f32::INFINITY).contains(&index) {
            return Err(Fault::new(at, format!("the index A + B/0.58756² is {index}, expected at least 1")));
        }
        Ok(index)
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(interior: &Interior) -> Self {
        let Interior { absorption, priority, dispersion } = interior;
        let absorption = (*absorption != [0.0; 3]).then(|| At::nowhere(Each(absorption.map(NonNegative))));
        let (inverse_abbe, cauchy) = match dispersion {
            Dispersion::None => (None, None),
            Dispersion::InverseAbbe(x) => (Some(At::nowhere(NonNegative(*x))), None),
            Dispersion::Cauchy(ab) => (None, Some(At::nowhere(ab.map(Number)))),
        };
        Self {
            absorption,
            attenuation_color: None,
            attenuation_distance: None,
            priority: *priority,
            abbe: None,
            inverse_abbe,
            cauchy,
        }
    }

    /// The key `ior` of the index `n`: left out where Cauchy's formula says it.
    pub(super) fn ior_of(&self, n: f32) -> Option<f32> {
        self.cauchy.is_none().then_some(n)
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
