//! Decoding image files: PNG, JPEG, WebP, KTX2 with Basis Universal, Radiance HDR, OpenEXR. The format is told by the first bytes, never by the name.
//!
//! Files are hostile: sizes are checked before anything is allocated, and a decoder that fails, in whatever way, becomes
//! an error.

mod exr;
mod grant;
mod ktx2;
mod raster;

pub(super) use grant::Grant;
pub(super) use ktx2::is_srgb as ktx2_is_srgb;

use super::{Image, Pixels};

/// Longest side that is decoded \[pixels\].
pub const MAX_SIDE: u32 = 65_536;

/// Most memory that one decoded image may take \[bytes\]: 16,384 × 8,192 pixels of four floats.
const MAX_BYTES: u64 = 2 << 30;

/// An image file to pixels, or what is wrong with it.
///
/// * PNG of any bit depth, grey or colour, with or without alpha or palette, JPEG and WebP (of an animation, the first
///   frame) become [`Pixels::Rgba8`] as stored, or [`Pixels::Rgba16`] where they have 16 bits: the texture says whether
///   they carry the sRGB curve.
/// * KTX2 with Basis Universal (ETC1S with BasisLZ; UASTC, plain or with Zstandard; one 2D image) becomes
///   [`Pixels::Rgba8`]: its largest level, which is all that is needed (see [`crate::texture`]).
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
        Kind::WebP => raster::ldr(image::ImageFormat::WebP, bytes),
        Kind::Ktx2 => ktx2::decode(bytes),
        Kind::Hdr => raster::hdr(bytes),
        Kind::Exr => exr::decode(bytes),
    });
    let (size, pixels) = decoded
        .unwrap_or_else(|_| Err("the decoder gave up".into()))
        .map_err(|e| format!("is not a valid {}: {e}", kind.name()))?;
    Ok(Image { name: name.into(), size, pixels })
}

/// Name of the format that the first bytes announce, for messages; an error where it is none of those decoded.
pub(super) fn format(bytes: &[u8]) -> Result<&'static str, String> {
    Kind::of(bytes).map(Kind::name)
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

/// 8-bit sRGB with straight alpha to linear floats.
pub(crate) fn srgb8_to_linear(rgba: [u8; 4]) -> [f32; 4] {
    decoded(rgba.map(|code| f64::from(code) / 255.0))
}

/// Codes as sRGB with straight alpha to linear floats; floats are linear.
pub(super) fn srgb_to_linear(pixels: Pixels) -> Pixels {
    Pixels::Rgba32F(match pixels {
        Pixels::Rgba8(pixels) => pixels.into_iter().map(srgb8_to_linear).collect(),
        Pixels::Rgba16(pixels) => {
            pixels.into_iter().map(|p| decoded(p.map(|code| f64::from(code) / 65_535.0))).collect()
        }
        Pixels::Rgba32F(pixels) => pixels,
    })
}

/// RGB by the sRGB curve (IEC 61966-2-1), A as it is.
fn decoded([r, g, b, a]: [f64; 4]) -> [f32; 4] {
    let linear = |x: f64| (if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }) as f32;
    [linear(r), linear(g), linear(b), a as f32]
}

/// Names of the formats, for messages.
const EXPECTED: &str = "PNG, JPEG, WebP, KTX2, Radiance HDR or OpenEXR";

/// Formats that are decoded.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Png,
    Jpeg,
    WebP,
    Ktx2,
    Hdr,
    Exr,
}

impl Kind {
    /// The format that the first bytes announce.
    fn of(bytes: &[u8]) -> Result<Self, String> {
        match bytes {
            [0x89, b'P', b'N', b'G', ..] => Ok(Self::Png),
            [0xff, 0xd8, 0xff, ..] => Ok(Self::Jpeg),
            [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => Ok(Self::WebP),
            [0xab, b'K', b'T', b'X', b' ', b'2', b'0', ..] => Ok(Self::Ktx2),
            [b'#', b'?', ..] => Ok(Self::Hdr),
            [0x76, 0x2f, 0x31, 0x01, ..] => Ok(Self::Exr),
            [] => Err(format!("is empty; expected {EXPECTED}")),
            _ => {
                let other = match bytes {
                    [0xab, b'K', b'T', b'X', ..] => "KTX of the first version",
                    [b'G', b'I', b'F', ..] => "GIF",
                    [b'B', b'M', ..] => "BMP",
                    [b'I', b'I', 42, 0, ..] | [b'M', b'M', 0, 42, ..] => "TIFF",
                    _ => "an unknown format",
                };
                Err(format!("is {other}; expected {EXPECTED}"))
            }
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::WebP => "WebP",
            Self::Ktx2 => "KTX2",
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
