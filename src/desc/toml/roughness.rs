//! The roughness of a microsurface: one of several ways to say it.

use super::build::Builder;
use super::color::Scalar;
use super::keys::keys;
use super::number::Fraction;
use super::read::{At, Fault};
use super::short::Each;
use super::writer::Names;
use crate::desc::{Roughness, ScalarParam};

keys! {
    /// The roughness of a microsurface.
    struct RoughnessTable {
        /// Perceptual roughness in [0, 1] (alpha is its square), a number or a texture. Default 0: smooth.
        roughness: Option<Scalar>,
        /// Strength of the anisotropy in [0, 1], a number or a texture, beside the roughness: alpha along the tangent is mix(alpha, 1, strength²).
        anisotropy: Option<At<Scalar>>,
        /// Glossiness in [0, 1], a number or a texture, in place of the roughness: 1 − roughness.
        glossiness: Option<At<Scalar>>,
        /// Alpha, a number or [along the tangent, along the bitangent], in place of the roughness.
        alpha: Option<At<Each<Fraction, 2>>>,
    }
}

impl RoughnessTable {
    /// The roughness; smooth where nothing is given.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<Roughness, Fault> {
        let twice = |at, key: &str| Err(Fault::new(at, format!("`{key}` is given too; expected one of the two")));
        let Self { roughness, anisotropy, glossiness, alpha } = self;
        match (roughness, glossiness, alpha) {
            (Some(_), _, Some(alpha)) => return twice(&alpha.at, "roughness"),
            (Some(_), Some(glossiness), None) => return twice(&glossiness.at, "roughness"),
            (None, Some(_), Some(alpha)) => return twice(&alpha.at, "glossiness"),
            _ => {}
        }
        if let (Some(strength), true) = (anisotropy, glossiness.is_some() || alpha.is_some()) {
            return Err(Fault::new(&strength.at, "`anisotropy` is given without `roughness`"));
        }
        let perceptual = match roughness {
            Some(roughness) => roughness.build(b)?,
            None => ScalarParam::constant(0.0),
        };
        Ok(match (glossiness, alpha, anisotropy) {
            (Some(glossiness), ..) => Roughness::Glossiness(glossiness.value.build(b)?),
            (None, Some(alpha), _) => Roughness::Alpha(alpha.value.0.map(|x| x.0)),
            (None, None, Some(strength)) => {
                Roughness::Stretched { roughness: perceptual, strength: strength.value.build(b)? }
            }
            (None, None, None) => Roughness::Perceptual(perceptual),
        })
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(roughness: &Roughness, names: &Names) -> Self {
        let mut table = Self { roughness: None, anisotropy: None, glossiness: None, alpha: None };
        match roughness {
            Roughness::Perceptual(ScalarParam { factor: 0.0, texture: None }) => {}
            Roughness::Perceptual(r) => table.roughness = Some(Scalar::of(r, names)),
            Roughness::Glossiness(g) => table.glossiness = Some(At::nowhere(Scalar::of(g, names))),
            Roughness::Alpha(alpha) => table.alpha = Some(At::nowhere(Each(alpha.map(Fraction)))),
            Roughness::Stretched { roughness, strength } => {
                table.roughness = Some(Scalar::of(roughness, names));
                table.anisotropy = Some(At::nowhere(Scalar::of(strength, names)));
            }
        }
        table
    }
}
