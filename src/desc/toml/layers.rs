//! Keys of a `metallic-roughness` material for what lies over its base.

use super::build::Builder;
use super::color::{Reflectance, Scalar};
use super::keys::keys;
use super::normal_map::NormalMapValue;
use super::read::{At, Fault, Number};
use crate::desc::{Anisotropy, Clearcoat, Layers, Sheen};

keys! {
    /// Anisotropy of the base, sheen and clear coat over it (glTF's KHR_materials_anisotropy, _sheen, _clearcoat).
    struct LayersTable {
        /// Strength of the anisotropy in [0, 1], a number or a texture: GGX alpha along the direction is mix(alpha, 1, strength²). Default 0.
        anisotropy: Option<Scalar>,
        /// Angle from the tangent to that direction in degrees. Default 0.
        anisotropy_rotation: Number = Number(0.0),
        /// Name of a texture of directions: 2 rg − 1 along the tangent and the bitangent.
        anisotropy_direction: Option<At<String>>,
        /// Colour of the sheen, each channel in [0, 1]. Default: none.
        sheen_color: Option<Reflectance>,
        /// Perceptual roughness of the sheen in [0, 1], a number or a texture. Default 0.5.
        sheen_roughness: Scalar = Scalar::Constant(0.5),
        /// Share of the surface under a clear coat of index 1.5 in [0, 1], a number or a texture. Default 0.
        clearcoat: Option<Scalar>,
        /// Perceptual roughness of the coat in [0, 1], a number or a texture. Default 0: smooth.
        clearcoat_roughness: Scalar = Scalar::Constant(0.0),
        /// Normal map of the coat, as `normal_map`. Default: the coat follows the shape.
        clearcoat_normal_map: Option<NormalMapValue>,
    }
}

impl LayersTable {
    /// The layers.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<Layers, Fault> {
        let mut layers = Layers::default();
        if let Some(strength) = &self.anisotropy {
            let direction = self.anisotropy_direction.as_ref().map(|name| b.texture(name, 0, false)).transpose()?;
            let rotation = self.anisotropy_rotation.0.to_radians();
            layers.anisotropy = Some(Anisotropy { strength: strength.build(b)?, rotation, direction });
        }
        if let Some(color) = &self.sheen_color {
            layers.sheen = Some(Sheen { color: color.build(b)?, roughness: self.sheen_roughness.build(b)? });
        }
        if let Some(factor) = &self.clearcoat {
            let normal_map = match &self.clearcoat_normal_map {
                None => None,
                Some(map) => Some(map.build(b)?),
            };
            let (factor, roughness) = (factor.build(b)?, self.clearcoat_roughness.build(b)?);
            layers.clearcoat = Some(Clearcoat { factor, roughness, normal_map });
        }
        Ok(layers)
    }
}
