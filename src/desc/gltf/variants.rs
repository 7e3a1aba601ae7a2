//! KHR_materials_variants: which material a primitive has.

use super::{Reader, Source};
use crate::desc::Error;
use gltf::json::mesh::Primitive;
use serde::Deserialize;
use serde_json::Value;

/// Name of the extension.
const NAME: &str = "KHR_materials_variants";

/// What a primitive says of variants.
#[derive(Deserialize)]
struct Mappings {
    mappings: Vec<Mapping>,
}

#[derive(Deserialize)]
struct Mapping {
    material: usize,
    variants: Vec<usize>,
}

/// The names of all variants.
pub(super) fn names<'a>(source: Source<'a>) -> Result<Vec<&'a str>, Error> {
    let place = format!("/extensions/{NAME}/variants");
    let Some(list) = source.json.pointer(&place) else { return Ok(Vec::new()) };
    let Some(list) = list.as_array() else { return Err(source.invalid(place, "is no list of variants")) };
    let name = |(i, variant): (usize, &'a Value)| {
        let missing = || source.invalid(format!("{place}/{i}/name"), "is missing; expected the name of a variant");
        variant.get("name").and_then(Value::as_str).ok_or_else(missing)
    };
    list.iter().enumerate().map(name).collect()
}

impl Reader<'_> {
    /// The material of the primitive at `place` under the chosen variant, and what refers to it.
    pub(super) fn chosen_material(&self, primitive: &Primitive, place: &str) -> Result<(Option<usize>, String), Error> {
        let own = || (primitive.material.map(|m| m.value()), format!("{place}/material"));
        let Some(variant) = self.variant else { return Ok(own()) };
        let others = primitive.extensions.as_ref().map(|e| &e.others);
        let Some(Mappings { mappings }) = self.source.extension(others, NAME, place)? else { return Ok(own()) };
        let mapping = mappings.iter().enumerate().find(|(_, m)| m.variants.contains(&variant));
        let at = |i: usize| format!("{place}/extensions/{NAME}/mappings/{i}/material");
        Ok(mapping.map_or_else(own, |(i, m)| (Some(m.material), at(i))))
    }
}
