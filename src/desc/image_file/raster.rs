//! PNG, JPEG and Radiance HDR.

use super::{Decoded, MAX_BYTES, MAX_SIDE, Pixels, check_finite, check_size};
use image::codecs::hdr::HdrDecoder;
use image::{ImageDecoder, ImageFormat, ImageReader, Limits};
use std::io::Cursor;

/// PNG or JPEG to 8-bit RGBA.
pub(super) fn ldr(format: ImageFormat, bytes: &[u8]) -> Decoded {
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(2 * MAX_BYTES);

    let reader = ImageReader::with_format(Cursor::new(bytes), format);
    let (width, height) = reader.into_dimensions().map_err(|e| e.to_string())?;
    // 12 bytes: 16-bit RGBA as decoded, beside 8-bit RGBA as kept.
    let size = check_size(width.into(), height.into(), 12)?;

    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let decoded = reader.decode().map_err(|e| e.to_string())?;
    let pixels = decoded.into_rgba8().into_raw().chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]).collect();
    Ok((size, Pixels::Rgba8(pixels)))
}

/// Radiance HDR (Ward 1991) to linear floats: (mantissa, exponent) / exposure.
pub(super) fn hdr(bytes: &[u8]) -> Decoded {
    let decoder = HdrDecoder::new_nonstrict(Cursor::new(bytes)).map_err(|e| e.to_string())?;
    let (width, height) = decoder.dimensions();
    let size = check_size(width.into(), height.into(), 16 + 12)?;
    let exposure = decoder.metadata().exposure.unwrap_or(1.0);
    if !(exposure > 0.0 && exposure.is_finite()) {
        return Err(format!("EXPOSURE is {exposure}; expected a positive number"));
    }

    let mut raw = vec![0u8; decoder.total_bytes() as usize];
    decoder.read_image(&mut raw).map_err(|e| e.to_string())?;
    let float = |b: &[u8]| f32::from_ne_bytes([b[0], b[1], b[2], b[3]]) / exposure;
    let pixels: Vec<_> = raw.chunks_exact(12).map(|p| [float(p), float(&p[4..]), float(&p[8..]), 1.0]).collect();
    check_finite(size, &pixels)?;
    Ok((size, Pixels::Rgba32F(pixels)))
}
