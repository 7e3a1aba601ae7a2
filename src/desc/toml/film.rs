//! A thin film over a material: `film = { … }`.

use super::build::Builder;
use super::color::Scalar;
use super::keys::keys;
use super::number::{NonNegative, Number};
use super::read::{At, Fault};
use super::short::Each;
use super::writer::Names;
use crate::desc::{Iridescence, ScalarParam};

keys! {
    /// A thin film.
    struct FilmTable {
        /// Index of refraction, in [1, 1000]. Default 1.3.
        ior: At<Number> = At::nowhere(Number(1.3)),
        /// Thickness in nanometres; or [where the texture is 0, where it is 1].
        thickness: Each<NonNegative, 2>,
        /// What the thickness goes by between the two: the name of a texture (its red channel), or { texture = "name", channel = "g" }. Default: the second everywhere.
        thickness_texture: Option<At<Scalar>>,
        /// Share of the surface that it covers in [0, 1], a number or a texture. Default 1.
        share: Scalar = Scalar::Constant(1.0),
    }
}

impl FilmTable {
    /// The film.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<Iridescence, Fault> {
        let ior = self.ior.value.0;
        if !(1.0..=1e3).contains(&ior) {
            return Err(Fault::new(&self.ior.at, format!("`ior` is {ior}, expected a number in [1, 1000]")));
        }
        let thickness = self.thickness.0.map(|x| x.0);
        let thickness_texture = match &self.thickness_texture {
            None => None,
            Some(At { at, value }) => match value.build(b)? {
                ScalarParam { factor: 1.0, texture: Some(texture) } => Some(texture),
                _ => return Err(Fault::new(at, "`thickness_texture`: expected a texture without a factor")),
            },
        };
        Ok(Iridescence { factor: self.share.build(b)?, ior, thickness, thickness_texture })
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(film: &Iridescence, names: &Names) -> Self {
        let Iridescence { factor, ior, thickness, thickness_texture } = film;
        let by = |texture| At::nowhere(Scalar::of(&ScalarParam { factor: 1.0, texture: Some(texture) }, names));
        Self {
            ior: At::nowhere(Number(*ior)),
            thickness: Each(thickness.map(NonNegative)),
            thickness_texture: thickness_texture.map(by),
            share: Scalar::of(factor, names),
        }
    }
}
