//! Images with factors, channels and thresholds worked in, because targets look images up and do not calculate with them.

use super::octahedral::octahedral;
use crate::desc::{Pixels, Scene};
use crate::film::Image;
use glam::Mat3;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use std::io;

/// What is made of an image.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Picture {
    /// Linear RGB times a factor.
    Color {
        image: usize,
        srgb: bool,
        factor: [f32; 3],
        /// Not above 1.
        share: bool,
    },
    /// One channel.
    Channel { image: usize, srgb: bool, channel: usize, factor: f32, map: Map },
    /// Linear RGB, or white, times a factor and a coverage.
    Covered {
        image: usize,
        /// RGB of the image, which is sRGB or not.
        color: Option<bool>,
        factor: [f32; 3],
        cover: Cover,
    },
    /// A normal map with its strengths along x and y.
    Normals { image: usize, scale: [f32; 2] },
    /// An environment on a square of equal areas.
    Octahedral { image: usize, factor: [f32; 3], to_world: Mat3 },
}

/// A channel that says how much of a surface is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cover {
    pub(super) srgb: bool,
    pub(super) channel: usize,
    pub(super) factor: f32,
    pub(super) map: Map,
}

/// What a channel means to the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Map {
    Same,
    /// α of a perceptual roughness.
    Square,
    /// α of a glossiness.
    SquaredComplement,
    /// 1 from here on, 0 below.
    AtLeast(f32),
}

impl Map {
    pub(super) fn apply(self, x: f32) -> f32 {
        let x = x.max(0.0).clamp(0.0, 1.0);
        match self {
            Self::Same => x,
            Self::Square => x * x,
            Self::SquaredComplement => (1.0 - x) * (1.0 - x),
            Self::AtLeast(cutoff) => f32::from(x >= cutoff),
        }
    }
}

/// A file's content.
pub(super) enum Format {
    Png(io::Result<Vec<u8>>),
    Exr(Image),
}

impl Picture {
    fn image(&self) -> usize {
        match self {
            Self::Color { image, .. }
            | Self::Channel { image, .. }
            | Self::Covered { image, .. }
            | Self::Normals { image, .. }
            | Self::Octahedral { image, .. } => *image,
        }
    }

    /// Its numbers are not sRGB codes.
    pub(super) fn is_linear(&self, scene: &Scene) -> bool {
        !(self.bytes(scene).is_some() && matches!(self, Self::Color { srgb: true, .. }))
    }

    /// The file.
    pub(super) fn encode(&self, scene: &Scene) -> Format {
        if let Self::Octahedral { image, factor, to_world } = *self {
            return Format::Exr(octahedral(&scene.images[image], factor, to_world));
        }
        let size = scene.images[self.image()].size;
        if let Some((bytes, color)) = self.bytes(scene) {
            let mut out = Vec::new();
            let done = PngEncoder::new(&mut out).write_image(&bytes, size[0], size[1], color);
            return Format::Png(done.map(|()| out).map_err(io::Error::other));
        }
        let mut image = Image { size, window: [0, 0, size[0], size[1]], ..Image::default() };
        image.insert_rgb(Image::BEAUTY, (0..size[0] as usize * size[1] as usize).map(|i| self.pixel(scene, i)));
        Format::Exr(image)
    }

    /// The bytes of a PNG, where they lose nothing.
    fn bytes(&self, scene: &Scene) -> Option<(Vec<u8>, ExtendedColorType)> {
        let image = &scene.images[self.image()];
        let codes = match &image.pixels {
            Pixels::Rgba8(codes) => Some(codes),
            _ => None,
        };
        match *self {
            Self::Color { factor: [1.0, 1.0, 1.0], .. } | Self::Normals { scale: [1.0, 1.0], .. } => {
                Some((codes?.iter().flat_map(|p| [p[0], p[1], p[2]]).collect(), ExtendedColorType::Rgb8))
            }
            Self::Channel { srgb, channel, factor: 1.0, map: Map::Same, .. } if !srgb || channel == 3 => {
                Some((codes?.iter().map(|p| p[channel.min(3)]).collect(), ExtendedColorType::L8))
            }
            Self::Channel { map: Map::AtLeast(_), .. } => {
                let count = image.size[0] as usize * image.size[1] as usize;
                let byte = |i| if self.pixel(scene, i)[0] > 0.5 { 255 } else { 0 };
                Some(((0..count).map(byte).collect(), ExtendedColorType::L8))
            }
            _ => None,
        }
    }

    /// Mean of the first channel over all pixels.
    pub(super) fn mean(&self, scene: &Scene) -> f32 {
        let size = scene.images[self.image()].size;
        let count = size[0] as usize * size[1] as usize;
        ((0..count).map(|i| f64::from(self.pixel(scene, i)[0])).sum::<f64>() / count as f64) as f32
    }

    /// One pixel, linear.
    fn pixel(&self, scene: &Scene, i: usize) -> [f32; 3] {
        let texel = |srgb| texel(&scene.images[self.image()].pixels, i, srgb);
        match *self {
            Self::Color { srgb, factor, share, .. } => {
                let p = texel(srgb);
                let most = if share { 1.0 } else { f32::MAX };
                [0, 1, 2].map(|c| (p[c] * factor[c]).max(0.0).min(most))
            }
            Self::Channel { srgb, channel, factor, map, .. } => [map.apply(texel(srgb)[channel.min(3)] * factor); 3],
            Self::Covered { color, factor, cover, .. } => {
                let share = cover.map.apply(texel(cover.srgb)[cover.channel.min(3)] * cover.factor);
                let [r, g, b, _] = color.map_or([1.0; 4], texel);
                [r * factor[0], g * factor[1], b * factor[2]].map(|x| (x * share).max(0.0))
            }
            Self::Normals { scale, .. } => {
                let p = texel(false);
                let n = glam::Vec3::new(p[0], p[1], p[2]) * 2.0 - 1.0;
                let n = (n * glam::Vec3::new(scale[0], scale[1], 1.0)).normalize_or(glam::Vec3::Z);
                (0.5 * n + 0.5).to_array()
            }
            Self::Octahedral { .. } => [0.0; 3],
        }
    }
}

/// Linear RGBA of a texel; alpha is never sRGB.
pub(super) fn texel(pixels: &Pixels, i: usize, srgb: bool) -> [f32; 4] {
    let decode = |[r, g, b, a]: [f32; 4]| if srgb { [linear(r), linear(g), linear(b), a] } else { [r, g, b, a] };
    match pixels {
        Pixels::Rgba8(p) => decode(p[i].map(|code| f32::from(code) / 255.0)),
        Pixels::Rgba16(p) => decode(p[i].map(|code| f32::from(code) / 65_535.0)),
        Pixels::Rgba32F(p) => p[i],
    }
}

/// The sRGB curve (IEC 61966-2-1).
fn linear(x: f32) -> f32 {
    if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}
