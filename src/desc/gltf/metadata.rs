//! KHR_xmp_json_ld, and KHR_xmp before it: what the file says of itself, carried and not interpreted.

use super::extensions::kind;
use crate::desc::Error;
use serde_json::Value;
use std::path::Path;

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
