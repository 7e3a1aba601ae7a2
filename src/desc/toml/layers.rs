//! Keys of a `metallic-roughness` material for what lies over its base.

use super::build::Builder;
use super::color::{Reflectance, Scalar};
use super::keys::keys;
use super::lookup::TextureValue;
use super::normal_map::NormalMapValue;
use super::number::Angle;
use super::read::Fault;
use super::writer::Names;
use crate::desc::{Anisotropy, Clearcoat, Layers, Sheen};

keys! {
    /// Anisotropy of the base, sheen and clear coat over it (glTF's KHR_materials_anisotropy, _sheen, _clearcoat).
    struct LayersTable {
        /// Strength of the anisotropy in [0, 1], a number or a texture: GGX alpha along the direction is mix(alpha, 1, strength²). Default 0.
        anisotropy: Option<Scalar>,
        /// Angle from the tangent to that direction in degrees. Default 0.
        anisotropy_rotation: Angle = Angle(0.0),
        /// Texture of directions, its name or { texture = "name", uv_set = 1 }: 2 rg − 1 along the tangent and the bitangent.
        anisotropy_direction: Option<TextureValue>,
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
            let direction = self.anisotropy_direction.as_ref().map(|texture| texture.build(b)).transpose()?;
            let rotation = self.anisotropy_rotation.0;
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

    /// The inverse of [`Self::build`].
    pub(super) fn of(layers: &Layers, names: &Names) -> Self {
        let Layers { anisotropy, sheen, clearcoat } = layers;
        let coat_map = clearcoat.and_then(|coat| coat.normal_map);
        Self {
            anisotropy: anisotropy.map(|a| Scalar::of(&a.strength, names)),
            anisotropy_rotation: Angle(anisotropy.map_or(0.0, |a| a.rotation)),
            anisotropy_direction: anisotropy.and_then(|a| a.direction).map(|t| TextureValue::of(&t, names)),
            sheen_color: sheen.map(|s| Reflectance::of(&s.color, names)),
            sheen_roughness: sheen.map_or(Scalar::Constant(0.5), |s| Scalar::of(&s.roughness, names)),
            clearcoat: clearcoat.map(|coat| Scalar::of(&coat.factor, names)),
            clearcoat_roughness: clearcoat.map_or(Scalar::Constant(0.0), |c| Scalar::of(&c.roughness, names)),
            clearcoat_normal_map: coat_map.map(|map| NormalMapValue::of(&map, names)),
        }
    }
}
