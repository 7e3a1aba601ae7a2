//! Roughness as α of microfacets, which is what both targets have.

use super::ExportError;
use super::beside::Beside;
use super::picture::Map;
use super::value::Scalar;
use crate::bsdf::MIN_ALPHA;
use crate::desc::Roughness;

/// α from where on lost light is noted: a tenth loses a percent at most.
const LOSSY_ALPHA: f32 = 0.1;

/// α of the microfacets.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Micro {
    Smooth,
    /// Along the tangent and the bitangent.
    Constant([f32; 2]),
    Varying(Scalar),
}

impl Micro {
    fn constant(alpha: [f32; 2]) -> Self {
        let rough = alpha[0].max(alpha[1]) >= MIN_ALPHA;
        if rough { Self::Constant(alpha.map(|a| a.max(MIN_ALPHA))) } else { Self::Smooth }
    }

    /// Light that microfacets scatter more than once is a share of all that one sees.
    pub(super) fn loses(&self) -> bool {
        !matches!(self, Self::Smooth | Self::Constant([..=LOSSY_ALPHA, ..=LOSSY_ALPHA]))
    }
}

impl Beside<'_> {
    /// The microfacets of the material `name`.
    pub(super) fn micro(&mut self, roughness: &Roughness, name: &str) -> Result<Micro, ExportError> {
        let alpha = match roughness {
            Roughness::Perceptual(r) => self.scalar(r, Map::Square)?,
            Roughness::Glossiness(g) => self.scalar(g, Map::SquaredComplement)?,
            Roughness::Alpha(alpha) => return Ok(Micro::constant(*alpha)),
            Roughness::Stretched { roughness, strength } if roughness.texture.or(strength.texture).is_some() => {
                self.note(format!("material `{name}`: its textured anisotropy is left out"));
                self.scalar(roughness, Map::Square)?
            }
            Roughness::Stretched { roughness, strength } => {
                let (a, s) = (Map::Square.apply(roughness.factor), Map::Same.apply(strength.factor));
                return Ok(Micro::constant([a + (1.0 - a) * s * s, a]));
            }
        };
        Ok(alpha.constant().map_or(Micro::Varying(alpha), |a| Micro::constant([a; 2])))
    }
}
