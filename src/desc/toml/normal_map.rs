//! Normal maps.

use super::build::Builder;
use super::keys::keys;
use super::lookup::Lookup;
use super::number::Number;
use super::read::{At, Fault};
use super::short::{NameOr, OfTexture};
use super::writer::Names;
use crate::desc::NormalMap;

keys! {
    /// A tangent-space normal map.
    struct NormalMapTable {
        /// Name of the texture; RGB holds (n + 1)/2, green upwards against v.
        texture: At<String>,
        /// Factor on the x and y of the normal. Default 1.
        scale: Number = Number(1.0),
        ..lookup: Lookup,
    }
}

/// A texture's name, or a table.
pub(super) type NormalMapValue = NameOr<NormalMapTable>;

impl OfTexture for NormalMapTable {
    const KEY: &'static str = "scale";
    fn of_texture(texture: At<String>) -> Self {
        Self { texture, scale: Number(1.0), lookup: Lookup::plain() }
    }
}

impl NormalMapValue {
    /// The map.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<NormalMap, Fault> {
        let Self(map) = self;
        Ok(NormalMap { texture: b.texture(&map.texture, &map.lookup, false)?, scale: map.scale.0 })
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(map: &NormalMap, names: &Names) -> Self {
        let NormalMap { texture, scale } = map;
        let lookup = Lookup::of(texture);
        NameOr(NormalMapTable { texture: names.texture(texture), scale: Number(*scale), lookup })
    }
}
