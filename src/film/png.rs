//! Radiance → an opaque 8-bit sRGB PNG.

use super::file::write_atomic;
use super::{Display, Image};
use image::ImageEncoder;
use image::codecs::png::PngEncoder;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Writes the beauty of `image`, as `display` shows it, whole or not at all.
pub fn write_png(path: &Path, image: &Image, display: &Display) -> io::Result<()> {
    let [r, g, b] = image
        .rgb(Image::BEAUTY)
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "an image without colours"))?;
    let pixels: Vec<u8> = (0..r.len()).flat_map(|i| display.code([r[i], g[i], b[i]])).collect();
    write_rgb8(path, image.window_size(), &pixels)
}

/// Writes RGB bytes, row by row.
pub fn write_rgb8(path: &Path, size: [usize; 2], pixels: &[u8]) -> io::Result<()> {
    write_atomic(path, |file| {
        let mut buffer = BufWriter::new(file);
        let encoder = PngEncoder::new(&mut buffer);
        encoder
            .write_image(pixels, size[0] as u32, size[1] as u32, image::ExtendedColorType::Rgb8)
            .map_err(io::Error::other)?;
        buffer.flush()
    })
}
