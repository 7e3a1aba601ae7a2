//! `[profile.NAME]`: measured light without an IES file.

use super::keys::keys;
use super::number::{NonNegative, Number};
use super::read::Fault;
use super::words::words;
use crate::desc::ies::{self, Photometry, Profile, Tilt};
use std::ops::Range;

keys! {
    /// Intensity against direction, as an IES file has it.
    struct ProfileTable {
        /// Which way the angles run: "A", "B" or "C". Default "C".
        photometry: Photometry = Photometry::C,
        /// Vertical angles in degrees, ascending.
        vertical: Vec<Number>,
        /// Horizontal angles in degrees, ascending.
        horizontal: Vec<Number>,
        /// Intensities, for each horizontal angle those of all vertical ones.
        candela: Vec<NonNegative>,
        /// Angles of the aim to straight down in degrees, ascending, at which the output was measured. Default: it is always the same.
        tilt_angles: Option<Vec<Number>>,
        /// Factor on the output at each of these angles.
        tilt_factors: Vec<NonNegative> = Vec::new(),
    }
}

words! { Photometry: "A" => Photometry::A, "B" => Photometry::B, "C" => Photometry::C; }

impl ProfileTable {
    /// The profile. `at` is the place of its table.
    pub(super) fn build(&self, at: &Range<usize>) -> Result<Profile, Fault> {
        let tilt = self.tilt_angles.as_ref().map(|angles| Tilt {
            angles: angles.iter().map(|x| x.0).collect(),
            factors: self.tilt_factors.iter().map(|x| x.0).collect(),
        });
        let profile = Profile {
            kind: self.photometry,
            vertical: self.vertical.iter().map(|x| x.0).collect(),
            horizontal: self.horizontal.iter().map(|x| x.0).collect(),
            candela: self.candela.iter().map(|x| x.0).collect(),
            tilt,
        };
        ies::check(&profile).map_err(|message| Fault::new(at, message))?;
        Ok(profile)
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(profile: &Profile) -> Self {
        let Profile { kind, vertical, horizontal, candela, tilt } = profile;
        let numbers = |tilt: &Tilt| tilt.angles.iter().copied().map(Number).collect();
        let factors = |tilt: &Tilt| tilt.factors.iter().copied().map(NonNegative).collect();
        Self {
            photometry: *kind,
            vertical: vertical.iter().copied().map(Number).collect(),
            horizontal: horizontal.iter().copied().map(Number).collect(),
            candela: candela.iter().copied().map(NonNegative).collect(),
            tilt_angles: tilt.as_ref().map(numbers),
            tilt_factors: tilt.as_ref().map(factors).unwrap_or_default(),
        }
    }
}
