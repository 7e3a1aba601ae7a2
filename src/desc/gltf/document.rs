//! The JSON of a glTF file as the typed document of the `gltf` crate.
//!
//! The text is parsed to plain JSON first, so that version and extensions are judged before anything else, and so that
//! what the typed model refuses can be traced to an element. The crate's own validation stays out: it refuses required
//! extensions that are honoured here and indexes out of range; every index is checked where it is used.

use super::extensions::{self, kind};
use super::notes::Notes;
use crate::desc::Error;
use gltf::json;
use serde::Deserialize;
use serde_json::Value;
use std::path::Path;

/// Parses and checks the document's frame: version, extensions.
pub(super) fn parse(bytes: &[u8], file: &Path, notes: &mut Notes) -> Result<Value, Error> {
    let document: Value = serde_json::from_slice(bytes).map_err(|e| {
        let place = if e.line() > 0 { format!("{}:{}", e.line(), e.column()) } else { String::new() };
        Error::invalid(file, place, format!("is not JSON: {e}"))
    })?;
    if !document.is_object() {
        return Err(Error::invalid(file, "", format!("the document is {}; expected an object", kind(&document))));
    }
    version(&document, file)?;
    extensions::check(&document, file, notes)?;
    Ok(document)
}

/// The typed document, all fields checked.
pub(super) fn typed(document: &Value, file: &Path) -> Result<json::Root, Error> {
    json::Root::deserialize(document).map_err(|e| {
        let (place, message) = culprit(document).unwrap_or_else(|| (String::new(), e.to_string()));
        Error::invalid(file, place, message)
    })
}

/// `asset.version` must be 2.something, and `asset.minVersion` 2.0.
fn version(document: &Value, file: &Path) -> Result<(), Error> {
    let version = document.pointer("/asset/version").and_then(Value::as_str);
    let Some(version) = version else {
        return Err(Error::invalid(file, "/asset/version", "is missing; expected \"2.0\""));
    };
    if version.split('.').next() != Some("2") {
        return Err(Error::unsupported(file, "/asset/version", format!("is {version:?}; expected \"2.0\"")));
    }
    match document.pointer("/asset/minVersion").and_then(Value::as_str) {
        None | Some("2.0") => Ok(()),
        Some(min) => Err(Error::unsupported(file, "/asset/minVersion", format!("is {min:?}; expected \"2.0\""))),
    }
}

/// The smallest part of the document that does not fit its type: JSON pointer and reason.
fn culprit(document: &Value) -> Option<(String, String)> {
    use json::{buffer, mesh, scene, texture};
    list::<json::Accessor>(document, "", "accessors")
        .or_else(|| list::<buffer::Buffer>(document, "", "buffers"))
        .or_else(|| list::<buffer::View>(document, "", "bufferViews"))
        .or_else(|| list::<json::Camera>(document, "", "cameras"))
        .or_else(|| list::<json::Image>(document, "", "images"))
        .or_else(|| {
            let materials = document.get("materials")?.as_array()?.iter().enumerate();
            let pbr = "pbrMetallicRoughness";
            let inner = |(i, m): (usize, &Value)| {
                one::<json::material::PbrMetallicRoughness>(m.get(pbr)?, format!("/materials/{i}/{pbr}"))
            };
            materials.into_iter().find_map(inner)
        })
        .or_else(|| list::<json::Material>(document, "", "materials"))
        .or_else(|| {
            let meshes = document.get("meshes")?.as_array()?.iter().enumerate();
            meshes.into_iter().find_map(|(i, m)| list::<mesh::Primitive>(m, &format!("/meshes/{i}"), "primitives"))
        })
        .or_else(|| list::<json::Mesh>(document, "", "meshes"))
        .or_else(|| list::<scene::Node>(document, "", "nodes"))
        .or_else(|| list::<texture::Sampler>(document, "", "samplers"))
        .or_else(|| list::<scene::Scene>(document, "", "scenes"))
        .or_else(|| list::<json::Skin>(document, "", "skins"))
        .or_else(|| list::<json::Texture>(document, "", "textures"))
        .or_else(|| one::<json::Asset>(document.get("asset")?, "/asset".into()))
        .or_else(|| one::<json::extensions::root::Root>(document.get("extensions")?, "/extensions".into()))
}

/// The first element of the list `key` that is not a `T`.
fn list<'a, T: Deserialize<'a>>(parent: &'a Value, place: &str, key: &str) -> Option<(String, String)> {
    let place = format!("{place}/{key}");
    let value = parent.get(key)?;
    let Some(list) = value.as_array() else { return Some((place, format!("is {}; expected a list", kind(value)))) };
    list.iter().enumerate().find_map(|(i, element)| one::<T>(element, format!("{place}/{i}")))
}

/// Why `value` is not a `T`, if it is not.
fn one<'a, T: Deserialize<'a>>(value: &'a Value, place: String) -> Option<(String, String)> {
    T::deserialize(value).err().map(|e| (place, e.to_string()))
}
