//! What glTF lays over the base of a material, and what stretches it: KHR_materials_anisotropy, _sheen, _clearcoat.

use super::{ColorParam, NormalMap, ScalarParam, TextureRef};

/// Anisotropy of the base's microsurface, sheen over the base, a clear coat over both.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layers {
    /// KHR_materials_anisotropy.
    pub anisotropy: Option<Anisotropy>,
    /// KHR_materials_sheen.
    pub sheen: Option<Sheen>,
    /// KHR_materials_clearcoat.
    pub clearcoat: Option<Clearcoat>,
}

/// α along the direction is mix(α, 1, strength²), across it α = r².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anisotropy {
    /// Strength in [0, 1].
    pub strength: ScalarParam,
    /// Angle \[rad\] by which the direction is turned, from the tangent towards the bitangent.
    pub rotation: f32,
    /// Texture of directions: 2 rg − 1 along tangent and bitangent. Without it the direction is the tangent.
    pub direction: Option<TextureRef>,
}

/// Fibres over the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheen {
    /// Factor on what white sheen reflects, each channel in [0, 1].
    pub color: ColorParam,
    /// Perceptual roughness.
    pub roughness: ScalarParam,
}

/// A clear dielectric coat of index 1.5.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearcoat {
    /// Share of the surface that is coated.
    pub factor: ScalarParam,
    /// Perceptual roughness; α = r².
    pub roughness: ScalarParam,
    /// Bump of the coat's normal, whatever that of the base; without it the coat follows the shape.
    pub normal_map: Option<NormalMap>,
}

impl Layers {
    /// There is neither sheen nor a coat, nor a direction.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// What wants tangents, if anything: the map of the coat's normals, or anisotropy with the UV of its texture.
    pub fn tangent_map(&self) -> Option<TextureRef> {
        let coat = self.clearcoat.and_then(|c| c.normal_map).map(|map| map.texture);
        let first = TextureRef { texture: 0, uv_set: 0, transform: glam::Affine2::IDENTITY };
        coat.or_else(|| self.anisotropy.map(|a| a.direction.or(a.strength.texture.map(|t| t.0)).unwrap_or(first)))
    }
}
