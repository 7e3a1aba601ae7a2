//! EXT_meshopt_compression: buffer views whose bytes are compressed.
//!
//! The stream counts, never the fallback: a file that has both says the same with both.

use super::Source;
use super::budget::Budget;
use super::buffers::Buffers;
use crate::desc::Error;
use gltf::json::buffer::View;
use meshoptimizer_rs::codec::{BufferView, Filter, Mode};
use meshoptimizer_rs::{Limits, Workspace};
use serde::Deserialize;

/// Name of the extension.
const NAME: &str = "EXT_meshopt_compression";

/// Where the stream is, and what it holds.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Stream {
    buffer: usize,
    #[serde(default)]
    byte_offset: u64,
    byte_length: u64,
    byte_stride: usize,
    count: usize,
    mode: String,
    filter: Option<String>,
}

/// The decompressed bytes of the view at `place`; `None` where it is not compressed.
pub(super) fn decompress(
    buffers: &Buffers,
    source: Source,
    view: &View,
    place: &str,
    budget: &Budget,
) -> Result<Option<Vec<u8>>, Error> {
    let others = view.extensions.as_ref().map(|e| &e.others);
    let Some(stream) = source.extension::<Stream>(others, NAME, place)? else { return Ok(None) };
    let place = format!("{place}/extensions/{NAME}");
    let wrong = |key: &str, message: String| source.invalid(format!("{place}/{key}"), message);

    // Know the layout, and pay for it, before anything is decoded.
    let mode = Mode::parse(&stream.mode).map_err(|_| {
        wrong("mode", format!("is {:?}; expected \"ATTRIBUTES\", \"TRIANGLES\" or \"INDICES\"", stream.mode))
    })?;
    let filter = stream.filter.as_deref().unwrap_or("NONE");
    let filter = Filter::parse(filter).map_err(|_| {
        wrong("filter", format!("is {filter:?}; expected \"NONE\", \"OCTAHEDRAL\", \"QUATERNION\" or \"EXPONENTIAL\""))
    })?;
    let (count, stride) = (stream.count, stream.byte_stride);
    let layout = BufferView::new(mode, filter, count, stride).map_err(|e| {
        let message = format!("{count} elements of {stride} bytes do not fit {mode:?} with the filter {filter:?}: {e}");
        source.invalid(&place, message)
    })?;
    let parent = (view.byte_length.0, view.byte_stride.map(|s| s.0));
    if parent.0 != layout.byte_length() as u64 || parent.1.is_some_and(|s| s != stride) {
        let message = format!(
            "has {count} elements of {stride} bytes; its view has {} bytes, byteStride {:?}",
            parent.0, parent.1
        );
        return Err(source.invalid(&place, message));
    }
    budget.decode(source, &place, layout.byte_length(), 1)?;

    // The budget is the limit; the decoder allocates nothing of its own.
    let encoded = buffers.range(stream.buffer, [stream.byte_offset, stream.byte_length], &place, budget)?;
    let mut bytes = vec![0; layout.byte_length()];
    let mut workspace = Workspace::new(Limits { max_bytes: usize::MAX, max_work: u64::MAX });
    match layout.decode_into(&mut bytes, encoded, &mut workspace) {
        Ok(()) => Ok(Some(bytes)),
        Err(e) => Err(source.invalid(&place, format!("is not a stream of {count} {mode:?} of {stride} bytes: {e}"))),
    }
}
