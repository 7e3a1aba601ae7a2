//! KTX2 with a Basis Universal payload, as KHR_texture_basisu allows it (its README, "KTX v2 Images with Basis Universal
//! Supercompression"): ETC1S with BasisLZ, or UASTC with or without Zstandard; one 2D image.
//!
//! The container is checked by one library and decoded by another: whatever the second allocates is known before.

use super::{Decoded, Pixels, check_size};
use ::ktx2::dfd::DataFormatFlags;
use ::ktx2::{ColorModel, Reader, SupercompressionScheme, TransferFunction};
use basisu::{DecodeFlags, TargetFormat, Transcoder};

/// Bytes of a UASTC block of 4 × 4 pixels.
const BLOCK: u64 = 16;

/// Basis Universal to 8-bit RGBA: the largest level.
pub(super) fn decode(bytes: &[u8]) -> Decoded {
    let container = container(bytes)?;
    let size = check(&container)?;
    let transcoder = Transcoder::new(bytes).map_err(|_| "its payload is damaged")?;
    let rgba = transcoder.transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE);
    let rgba = rgba.map_err(|_| "the payload of its largest level is damaged")?;
    match rgba.len() as u64 == 4 * u64::from(size[0]) * u64::from(size[1]) {
        true => Ok((size, Pixels::Rgba8(rgba.as_chunks().0.to_vec()))),
        false => Err(format!("{} bytes were decoded; expected {} × {} × 4", rgba.len(), size[0], size[1])),
    }
}

/// Whether a KTX2 file says that it holds sRGB (and not numbers); `None` where it says neither, or is none.
pub(in crate::desc) fn is_srgb(bytes: &[u8]) -> Option<bool> {
    match container(bytes).ok()?.transfer_function()? {
        TransferFunction::SRGB => Some(true),
        TransferFunction::Linear => Some(false),
        _ => None,
    }
}

/// The container, all of whose parts lie in the file.
fn container(bytes: &[u8]) -> Result<Reader<&[u8]>, String> {
    // The library takes it for granted that a block of pixels has less than 256 on a side, which stands 16 bytes into
    // the descriptor.
    let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    let sides = word(48).and_then(|descriptor| word((descriptor as usize).checked_add(16)?));
    if sides.is_none_or(|sides| sides.to_le_bytes().contains(&255)) {
        return Err("its data format descriptor is damaged".into());
    }
    Reader::new(bytes).map_err(|e| e.to_string())
}

/// Its size, if it is what the extension allows.
fn check(container: &Reader<&[u8]>) -> Result<[u32; 2], String> {
    let header = container.header();

    // One image, and not too large.
    for (found, expected, what) in [
        (header.pixel_depth, 0, "a depth"),
        (header.layer_count.saturating_sub(1), 0, "array layers beside the first"),
        (header.face_count.saturating_sub(1), 0, "faces beside the first"),
    ] {
        if found != expected {
            return Err(format!("it has {what} ({found}); expected one 2D image"));
        }
    }
    // What the library decodes to, beside what is kept.
    let size = check_size(header.pixel_width.into(), header.pixel_height.into(), 8)?;

    // A payload of Basis Universal, as long as it must be.
    let blocks = u64::from(size[0].div_ceil(4)) * u64::from(size[1].div_ceil(4));
    let level = container.levels().next().ok_or("it has no level")?;
    let (model, scheme) = (container.color_model(), header.supercompression_scheme);
    let expected = "expected Basis Universal: ETC1S with BasisLZ, or UASTC, plain or with Zstandard";
    if let Some(format) = header.format {
        return Err(format!("it holds {format:?}; {expected}"));
    }
    let stored = match (model, scheme) {
        (Some(ColorModel::ETC1S), Some(SupercompressionScheme::BasisLZ)) => None,
        (Some(ColorModel::UASTC), Some(SupercompressionScheme::Zstandard)) => Some(level.uncompressed_byte_length),
        (Some(ColorModel::UASTC), None) => Some(level.data.len() as u64),
        _ => {
            let name = |x: Option<String>| x.unwrap_or_else(|| "nothing".into());
            let (model, scheme) = (name(model.map(|m| format!("{m:?}"))), name(scheme.map(|s| format!("{s:?}"))));
            return Err(format!("it holds {model} with {scheme}; {expected}"));
        }
    };
    if let Some(bytes) = stored.filter(|bytes| *bytes != blocks * BLOCK) {
        let [width, height] = size;
        return Err(format!("{bytes} bytes are stored for {width} × {height} pixels; expected {}", blocks * BLOCK));
    }

    // As it stands: neither turned nor with its channels exchanged nor multiplied by alpha.
    let value = |wanted: &str| container.key_value_data().find(|(key, _)| *key == wanted).map(|(_, value)| value);
    for (key, expected) in [("KTXorientation", "rd"), ("KTXswizzle", "rgba")] {
        let found = value(key).map(|v| String::from_utf8_lossy(v).trim_end_matches('\0').to_owned());
        if let Some(found) = found.filter(|found| found != expected) {
            return Err(format!("its {key} is {found:?}; expected {expected:?}"));
        }
    }
    let flags = container.basic_dfd().map(|d| d.flags);
    if flags.is_some_and(|f| f.contains(DataFormatFlags::ALPHA_PREMULTIPLIED)) {
        return Err("its colours are multiplied by alpha; expected straight alpha".into());
    }
    Ok(size)
}
