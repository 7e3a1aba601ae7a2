//! Normal maps: a texture's name, or a table.

use super::build::Builder;
use super::keys::keys;
use super::read::{At, Fault, Node, Number, Read, mismatch};
use super::schema::Defs;
use crate::desc::NormalMap;
use ::toml::de::DeValue;
use serde_json::{Value as Json, json};

keys! {
    /// A tangent-space normal map.
    struct NormalMapTable {
        /// Name of the texture; RGB holds (n + 1)/2, green upwards against v.
        texture: At<String>,
        /// Factor on the x and y of the normal. Default 1.
        scale: Number = Number(1.0),
        /// Which of the mesh's UV sets: 0 or 1. Default 0.
        uv_set: u32 = 0,
    }
}

/// A texture's name, or a table.
#[derive(Clone, Debug)]
pub(super) struct NormalMapValue(pub(super) NormalMapTable);

impl Read for NormalMapValue {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::String(_) => Ok(Self(NormalMapTable { texture: At::read(node)?, scale: Number(1.0), uv_set: 0 })),
            DeValue::Table(_) => NormalMapTable::read(node).map(Self),
            _ => Err(mismatch::<Self>(node)),
        }
    }
    fn one() -> String {
        "a texture's name or { texture = …, scale = … }".into()
    }
    fn many() -> String {
        "normal maps".into()
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "anyOf": [{ "type": "string" }, defs.reference::<NormalMapTable>()] })
    }
}

impl NormalMapValue {
    /// The map.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<NormalMap, Fault> {
        let Self(map) = self;
        Ok(NormalMap { texture: b.texture(&map.texture, map.uv_set, false)?, scale: map.scale.0 })
    }
}
