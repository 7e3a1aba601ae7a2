//! The GLB container: a header and chunks (glTF 2.0, section 4.4).

use crate::desc::Error;
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
