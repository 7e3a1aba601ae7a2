//! `[image.NAME]`: pixels that textures and the environment look into.

use super::build::Builder;
use super::keys::{keys, one_of};
use super::number::{Number, PixelCount};
use super::read::{At, Fault};
use super::words::words;
use crate::desc::{Image, Pixels};
use std::sync::Arc;

keys! {
    /// An image.
    struct ImageTable {
        /// Name for messages. Default: that of the file, or of the table.
        name: Option<String>,
        ..kind: ImageKind,
    }
}

one_of! {
    /// An image: of a file, or its pixels.
    enum ImageKind {
        "file" => ImageFile,
        "pixels" => ImagePixels,
    } default Some("file")
}

keys! {
    /// An image file.
    struct ImageFile {
        /// The image: PNG, JPEG, WebP, KTX2 with Basis Universal, Radiance HDR or OpenEXR, below the scene's folder.
        file: At<String>,
    }
}

keys! {
    /// A few pixels, row by row from the top.
    struct ImagePixels {
        /// Width and height in pixels.
        size: [PixelCount; 2],
        /// What the numbers are: "rgba8" or "rgba16", codes of 8 or 16 bits, or "rgba32f", linear. Default "rgba8".
        format: Format = Format::Rgba8,
        /// The pixels, [[r, g, b, a], …].
        pixels: At<Vec<[Number; 4]>>,
    }
}

/// What the numbers of pixels are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Format {
    /// Codes from 0 to 255.
    Rgba8,
    /// Codes from 0 to 65535.
    Rgba16,
    /// Linear numbers.
    Rgba32F,
}

words! { Format: "rgba8" => Format::Rgba8, "rgba16" => Format::Rgba16, "rgba32f" => Format::Rgba32F; }

impl ImageTable {
    /// The image; `name` is that of the table.
    pub(super) fn build(&self, name: &str, b: &mut Builder<'_>) -> Result<Arc<Image>, Fault> {
        match &self.kind {
            ImageKind::ImageFile(file) => b.image_of(&file.file, self.name.as_deref()),
            ImageKind::ImagePixels(pixels) => {
                let name = self.name.as_deref().unwrap_or(name).into();
                Ok(Image { name, ..pixels.build()? }.into())
            }
        }
    }

    /// The inverse of [`Self::build`], the image being in this file or else among the keys.
    pub(super) fn of(image: &Image, name: &str, file: Option<String>) -> Self {
        let read_as = file.as_deref().unwrap_or(name);
        let name = (image.name != read_as).then(|| image.name.clone());
        let kind = match file {
            Some(file) => ImageKind::ImageFile(ImageFile { file: At::nowhere(file) }),
            None => ImageKind::ImagePixels(ImagePixels::of(image)),
        };
        Self { name, kind }
    }
}

impl ImagePixels {
    fn build(&self) -> Result<Image, Fault> {
        let size = self.size.map(|side| side.0);
        let expected = size[0] as usize * size[1] as usize;
        let found = self.pixels.value.len();
        if found != expected {
            return Err(Fault::new(&self.pixels.at, format!("{found} pixels, expected {expected}")));
        }
        let pixels = match self.format {
            Format::Rgba8 => Pixels::Rgba8(self.codes(u8::MAX.into())?.map(|p| p.map(|x| x as u8)).collect()),
            Format::Rgba16 => Pixels::Rgba16(self.codes(u16::MAX.into())?.map(|p| p.map(|x| x as u16)).collect()),
            Format::Rgba32F => Pixels::Rgba32F(self.pixels.value.iter().map(|p| p.map(|x| x.0)).collect()),
        };
        Ok(Image { name: String::new(), size, pixels })
    }

    /// The pixels as whole numbers up to `most`.
    fn codes(&self, most: f32) -> Result<impl Iterator<Item = [f32; 4]>, Fault> {
        let At { at, value } = &self.pixels;
        let is_code = |x: &Number| (0.0..=most).contains(&x.0) && x.0.fract() == 0.0;
        if let Some(wrong) = value.iter().flatten().find(|x| !is_code(x)) {
            return Err(Fault::new(at, format!("found {}, expected whole numbers from 0 to {most}", wrong.0)));
        }
        Ok(value.iter().map(|p| p.map(|x| x.0)))
    }

    fn of(image: &Image) -> Self {
        let (format, pixels) = match &image.pixels {
            Pixels::Rgba8(pixels) => (Format::Rgba8, pixels.iter().map(|p| p.map(|x| Number(x.into()))).collect()),
            Pixels::Rgba16(pixels) => (Format::Rgba16, pixels.iter().map(|p| p.map(|x| Number(x.into()))).collect()),
            Pixels::Rgba32F(pixels) => (Format::Rgba32F, pixels.iter().map(|p| p.map(Number)).collect()),
        };
        Self { size: image.size.map(PixelCount), format, pixels: At::nowhere(pixels) }
    }
}
