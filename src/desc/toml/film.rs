//! A thin film over a material: `film = { … }`.

use super::build::Builder;
use super::color::Scalar;
use super::keys::keys;
use super::read::{At, Fault, NonNegative, Number};
use crate::desc::Iridescence;

keys! {
    /// A thin film.
    struct FilmTable {
        /// Index of refraction, in [1, 1000]. Default 1.3.
        ior: At<Number> = At { at: 0..0, value: Number(1.3) },
        /// Thickness in nanometres.
        thickness: NonNegative,
        /// Share of the surface that it covers in [0, 1], a number or a texture. Default 1.
        share: Scalar = Scalar::Constant(1.0),
    }
}

impl FilmTable {
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<Iridescence, Fault> {
        let ior = self.ior.value.0;
        if !(1.0..=1e3).contains(&ior) {
            return Err(Fault::new(&self.ior.at, format!("`ior` is {ior}, expected a number in [1, 1000]")));
        }
        let thickness = [self.thickness.0; 2];
        Ok(Iridescence { factor: self.share.build(b)?, ior, thickness, thickness_texture: None })
    }
}
