//! PNG, JPEG, WebP and Radiance HDR.

use super::{Decoded, MAX_BYTES, MAX_SIDE, Pixels, check_finite, check_size};
use image::codecs::hdr::HdrDecoder;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::io::Cursor;

/// PNG, JPEG or WebP to RGBA of 8 bits, or of 16 where the file has 16.
pub(super) fn ldr(format: ImageFormat, bytes: &[u8]) -> Decoded {
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(2 * MAX_BYTES);

    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(|e| e.to_string())?;
    let ((width, height), color) = (decoder.dimensions(), decoder.color_type());
    // RGBA as decoded, beside RGBA as kept.
    let deep = color.bytes_per_pixel() > color.channel_count();
    let size = check_size(width.into(), height.into(), if deep { 16 } else { 8 })?;

    let decoded = DynamicImage::from_decoder(decoder).map_err(|e| e.to_string())?;
    let pixels = match deep {
        true => Pixels::Rgba16(decoded.into_rgba16().into_raw().as_chunks().0.to_vec()),
        false => Pixels::Rgba8(decoded.into_rgba8().into_raw().as_chunks().0.to_vec()),
    };
    Ok((size, pixels))
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
