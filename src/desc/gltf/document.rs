//! From the bytes of a file to the typed document of the `gltf` crate: the GLB container (glTF 2.0, section 4.4), the JSON,
//! and what the file says of itself (KHR_xmp_json_ld).
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

/// Type of the chunk that holds the document: `JSON`.
const JSON: u32 = 0x4E4F_534A;
/// Type of the chunk that holds the first buffer: `BIN\0`.
const BIN: u32 = 0x004E_4942;
/// Bytes of the header: magic, version, length.
const HEADER: usize = 12;
/// Bytes before a chunk's data: length, type.
const CHUNK_HEADER: usize = 8;

/// What a `.gltf` or `.glb` file holds.
pub(super) struct Container<'a> {
    /// The document.
    pub json: &'a [u8],
    /// The first buffer of a `.glb`.
    pub bin: Option<&'a [u8]>,
}

/// Takes the file apart; anything that does not begin with `glTF` is taken for the JSON of a `.gltf`.
pub(super) fn split<'a>(bytes: &'a [u8], file: &Path) -> Result<Container<'a>, Error> {
    if !bytes.starts_with(b"glTF") {
        return Ok(Container { json: bytes, bin: None });
    }
    let bad = |message: String| Error::invalid(file, "", message);

    // Check the header, and cut what the file holds beyond the length that it states.
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        return Err(bad(format!("the GLB file ends after {} bytes; its header alone has {HEADER}", bytes.len())));
    };
    if version != 2 {
        return Err(Error::unsupported(file, "", format!("is GLB version {version}; expected 2")));
    }
    let length = length as usize;
    let Some(body) = bytes.get(..length).filter(|b| b.len() >= HEADER) else {
        return Err(bad(format!("the GLB header states a length of {length} bytes; the file has {}", bytes.len())));
    };

    // Walk the chunks: JSON first, BIN second; others may follow and mean nothing here.
    let (mut json, mut bin, mut at, mut number) = (None, None, HEADER, 0);
    while at < length {
        let (Some(size), Some(kind)) = (word(body, at), word(body, at + 4)) else {
            return Err(bad(format!("GLB chunk {number} is cut off at byte {at} of {length}")));
        };
        let start = at + CHUNK_HEADER;
        let Some(data) = start.checked_add(size as usize).and_then(|end| body.get(start..end)) else {
            let left = length - start;
            return Err(bad(format!("GLB chunk {number} states {size} bytes; {left} are left in the file")));
        };
        match (number, kind) {
            (0, JSON) => json = Some(data),
            (0, other) => return Err(bad(format!("the first GLB chunk is of type {other:#010x}; expected JSON"))),
            (1, BIN) => bin = Some(data),
            _ => {}
        }
        at = start + data.len();
        number += 1;
    }
    let json = json.ok_or_else(|| bad("the GLB file has no chunk; expected one of JSON".into()))?;
    Ok(Container { json, bin })
}

/// The little-endian word at byte `at`.
fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let b = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
}

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

/// Longest packet that is carried, as JSON text \[bytes\]: it goes into the header of every image.
const MOST: usize = 64 << 10;

/// The packets that the asset refers to: those about the whole file. Those of single nodes or images stay in the file.
pub(super) fn packets(document: &Value, file: &Path) -> Result<Vec<Value>, Error> {
    let packets = ["KHR_xmp_json_ld", "KHR_xmp"].map(|name| packet(document, name, file));
    packets.into_iter().filter_map(Result::transpose).collect()
}

/// The packet of the extension `name` that the asset refers to, if it does.
fn packet(document: &Value, name: &str, file: &Path) -> Result<Option<Value>, Error> {
    let Some(reference) = document.pointer(&format!("/asset/extensions/{name}")) else { return Ok(None) };
    let place = format!("/asset/extensions/{name}/packet");
    let index = reference.get("packet").and_then(Value::as_u64).and_then(|i| usize::try_from(i).ok());
    let index = index.ok_or_else(|| Error::invalid(file, &*place, "is no index; expected that of a packet"))?;
    let list = document.pointer(&format!("/extensions/{name}/packets"));
    let list = list.and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    let packet = list.get(index).ok_or_else(|| {
        Error::invalid(file, &*place, format!("refers to packet {index}; the file has {}", list.len()))
    })?;
    let at = format!("/extensions/{name}/packets/{index}");
    if !packet.is_object() {
        return Err(Error::invalid(file, at, format!("is {}; expected an object", kind(packet))));
    }
    let bytes = packet.to_string().len();
    if bytes > MOST {
        return Err(Error::invalid(file, at, format!("is {bytes} bytes long; at most {MOST} are carried")));
    }
    Ok(Some(packet.clone()))
}
