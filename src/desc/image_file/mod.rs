//! Decoding image files: PNG, JPEG, Radiance HDR, OpenEXR. The format is told by the first bytes, never by the name.
//!
//! Files are hostile: sizes are checked before anything is allocated, and a decoder that fails, in whatever way, becomes
//! an error.

mod exr;
mod raster;

use super::{Image, Pixels};

/// Longest side that is decoded \[pixels\].
pub const MAX_SIDE: u32 = 65_536;

/// Most memory that one decoded image may take \[bytes\]: 16,384 × 8,192 pixels of four floats.
const MAX_BYTES: u64 = 2 << 30;

/// An image file to pixels, or what is wrong with it.
///
/// * PNG of any bit depth (16 bits are rounded to 8), grey or colour, with or without alpha or palette, and JPEG become
///   [`Pixels::Rgba8`] as stored: the texture says whether they carry the sRGB curve.
/// * Radiance HDR (RGBE) and OpenEXR (half, float or integer channels; scan lines or tiles; every compression)
///   become [`Pixels::Rgba32F`]. Of an EXR, the first layer with R, G, B (or Y, or `name.R`, …) is taken, placed in its
///   display window; colour is divided by alpha, because EXR stores it premultiplied and everything here does not.
///
/// Every float is finite; it may be negative (see [`clear_negatives`]).
pub fn decode(name: &str, bytes: &[u8]) -> Result<Image, String> {
    let kind = Kind::of(bytes)?;
    // The decoders are other people's code; should one panic on a file, that file is wrong, not the program.
    let decoded = std::panic::catch_unwind(|| match kind {
        Kind::Png => raster::ldr(image::ImageFormat::Png, bytes),
        Kind::Jpeg => raster::ldr(image::ImageFormat::Jpeg, bytes),
        Kind::Hdr => raster::hdr(bytes),
        Kind::Exr => exr::decode(bytes),
    });
    let (size, pixels) = decoded
        .unwrap_or_else(|_| Err("the decoder gave up".into()))
        .map_err(|e| format!("is not a valid {}: {e}", kind.name()))?;
    Ok(Image { name: name.into(), size, pixels })
}

/// Sets the negative values of a float image to 0, and says how many pixels that changed. Radiance and reflectance
/// are never negative, but lossy EXR compression rings about 0.
pub fn clear_negatives(image: &mut Image) -> usize {
    let Pixels::Rgba32F(pixels) = &mut image.pixels else { return 0 };
    let mut changed = 0;
    for pixel in pixels.iter_mut().filter(|p| p.iter().any(|x| *x < 0.0)) {
        *pixel = pixel.map(|x| x.max(0.0));
        changed += 1;
    }
    changed
}

/// 8-bit sRGB with straight alpha to linear floats (IEC 61966-2-1).
pub(crate) fn srgb_to_linear([r, g, b, a]: [u8; 4]) -> [f32; 4] {
    let linear = |byte: u8| {
        let x = f64::from(byte) / 255.0;
        (if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }) as f32
    };
    [linear(r), linear(g), linear(b), f32::from(a) / 255.0]
}

/// Formats that are decoded.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Png,
    Jpeg,
    Hdr,
    Exr,
}

impl Kind {
    /// The format that the first bytes announce.
    fn of(bytes: &[u8]) -> Result<Self, String> {
        match bytes {
            [0x89, b'P', b'N', b'G', ..] => Ok(Self::Png),
            [0xff, 0xd8, 0xff, ..] => Ok(Self::Jpeg),
            [b'#', b'?', ..] => Ok(Self::Hdr),
            [0x76, 0x2f, 0x31, 0x01, ..] => Ok(Self::Exr),
            [] => Err("is empty; expected PNG, JPEG, Radiance HDR or OpenEXR".into()),
            _ => {
                let other = match bytes {
                    [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => "WebP",
                    [0xab, b'K', b'T', b'X', ..] => "KTX",
                    [b'G', b'I', b'F', ..] => "GIF",
                    [b'B', b'M', ..] => "BMP",
                    [b'I', b'I', 42, 0, ..] | [b'M', b'M', 0, 42, ..] => "TIFF",
                    _ => "an unknown format",
                };
                Err(format!("is {other}; expected PNG, JPEG, Radiance HDR or OpenEXR"))
            }
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::Hdr => "Radiance HDR",
            Self::Exr => "OpenEXR",
        }
    }
}

/// What the decoders return: width and height, pixels.
type Decoded = Result<([u32; 2], Pixels), String>;

/// Refuses an image that is empty or would take too much memory, before it is decoded.
fn check_size(width: u64, height: u64, bytes_per_pixel: u64) -> Result<[u32; 2], String> {
    if width == 0 || height == 0 {
        return Err(format!("{width} × {height} pixels; expected at least one"));
    }
    if width.max(height) > u64::from(MAX_SIDE) {
        return Err(format!("{width} × {height} pixels; expected at most {MAX_SIDE} a side"));
    }
    if width * height * bytes_per_pixel > MAX_BYTES {
        return Err(format!("{width} × {height} pixels would take more than {} MiB", MAX_BYTES >> 20));
    }
    Ok([width as u32, height as u32])
}

/// Refuses NaN and infinities, naming the first pixel that has one.
fn check_finite(size: [u32; 2], pixels: &[[f32; 4]]) -> Result<(), String> {
    match pixels.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        None => Ok(()),
        Some(i) => {
            let (x, y) = (i % size[0] as usize, i / size[0] as usize);
            Err(format!("pixel ({x}, {y}) is {:?}; expected finite numbers", pixels[i]))
        }
    }
}
