//! `[texture.NAME]`.

use super::build::Builder;
use super::color::Rgb;
use super::keys::{keys, one_of};
use super::number::{Angle, Fraction, Number, Positive};
use super::read::{At, Fault};
use super::short::Each;
use super::words::words;
use super::writer::Names;
use crate::desc::{Texture, Wrap};
use glam::{Affine2, Mat2, Vec2};
use std::ops::Range;

keys! {
    /// A function of the texture coordinates (u, v).
    struct TextureTable {
        /// Factor on (u, v) before the look-up, a number or two: 2 shows the image twice each way. Default 1.
        uv_scale: Each<Number, 2> = Each([Number(1.0); 2]),
        /// Rotation of (u, v) in degrees, after the scale. Default 0.
        uv_rotate: Angle = Angle(0.0),
        /// Shift of (u, v), after the rotation. Default [0, 0].
        uv_offset: Vec2 = Vec2::ZERO,
        ..kind: TextureKind,
    }
}

one_of! {
    /// A function of the texture coordinates (u, v).
    enum TextureKind {
        "image" => ImageTexture,
        "checker" => Checker,
    } default Some("image")
}

keys! {
    /// Look-up in an image. (0, 0) is the corner of the first pixel of the upper row; v grows downwards.
    struct ImageTexture {
        /// The image: PNG, JPEG, WebP, KTX2 with Basis Universal, Radiance HDR or OpenEXR, below the scene's folder.
        file: Option<At<String>>,
        /// Name of an image of this file, in place of a file of its own.
        image: Option<At<String>>,
        /// Outside the unit square: "repeat", "mirror" or "clamp", for both axes or one each. Default "repeat".
        wrap: Each<Wrap, 2> = Each([Wrap::Repeat; 2]),
        /// Between pixels: "bilinear" or "nearest". Default "bilinear".
        filter: Lookup = Lookup::Bilinear,
        /// Whether RGB is stored with the sRGB curve. Default: of images of 8 or 16 bits, where they are used as a colour.
        srgb: Option<bool>,
    }
}

keys! {
    /// Squares of two colours.
    struct Checker {
        /// Linear colour where ⌊scale u⌋ + ⌊scale v⌋ is even, a number or [r, g, b]. Default 0.8.
        even: Rgb<Fraction> = Each([Fraction(0.8); 3]),
        /// Linear colour elsewhere, a number or [r, g, b]. Default 0.2.
        odd: Rgb<Fraction> = Each([Fraction(0.2); 3]),
        /// Squares per unit of u and v. Default [8, 8].
        scale: [Positive; 2] = [Positive(8.0); 2],
    }
}

/// How an image is looked up between its pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lookup {
    /// Weighted by distance.
    Bilinear,
    /// The nearest pixel.
    Nearest,
}

words! {
    Lookup: "bilinear" => Lookup::Bilinear, "nearest" => Lookup::Nearest;
    Wrap: "repeat" => Wrap::Repeat, "mirror" => Wrap::Mirror, "clamp" => Wrap::Clamp;
}

impl TextureTable {
    /// UV → UV before the look-up.
    pub(super) fn uv_transform(&self) -> Affine2 {
        let linear = Mat2::from_angle(self.uv_rotate.0) * Mat2::from_diagonal(self.uv_scale.0.map(|x| x.0).into());
        Affine2::from_mat2_translation(linear, self.uv_offset)
    }

    /// Whether it is the same as a colour and as numbers, without looking at its image.
    pub(super) fn is_settled(&self) -> bool {
        !matches!(&self.kind, TextureKind::ImageTexture(ImageTexture { srgb: None, .. }))
    }

    /// The texture, used as a colour or as numbers; its image decoded at the first use. `at` is the place of its table.
    pub(super) fn build(&self, as_color: bool, at: &Range<usize>, b: &mut Builder<'_>) -> Result<Texture, Fault> {
        match &self.kind {
            TextureKind::ImageTexture(t) => {
                let (image, at) = match (&t.file, &t.image) {
                    (Some(file), None) => (b.image(file)?, &file.at),
                    (None, Some(name)) => (b.named_image(name)?, &name.at),
                    (None, None) => return Err(Fault::new(at, "missing key `file`; expected a string")),
                    (Some(_), Some(name)) => {
                        return Err(Fault::new(&name.at, "`file` is given too; expected one of the two"));
                    }
                };
                let codes = b.scene.images[image].pixels.are_codes();
                let srgb = codes && t.srgb.unwrap_or(as_color);
                if t.srgb == Some(true) && !codes {
                    return Err(Fault::new(at, "a float image is linear; leave `srgb` out"));
                }
                Ok(Texture::Image { image, srgb, wrap: t.wrap.0, nearest: t.filter == Lookup::Nearest })
            }
            TextureKind::Checker(c) => {
                let [even, odd] = [&c.even, &c.odd].map(|color| color.0.map(|x| x.0));
                Ok(Texture::Checker { even, odd, scale: c.scale.map(|s| s.0) })
            }
        }
    }

    /// The inverse of [`Self::build`], for any use.
    pub(super) fn of(texture: &Texture, names: &Names) -> Self {
        let kind = match *texture {
            Texture::Image { image, srgb, wrap, nearest } => TextureKind::ImageTexture(ImageTexture {
                file: None,
                image: Some(names.image(image)),
                wrap: Each(wrap),
                filter: if nearest { Lookup::Nearest } else { Lookup::Bilinear },
                srgb: Some(srgb && names.has_codes(image)),
            }),
            Texture::Checker { even, odd, scale } => TextureKind::Checker(Checker {
                even: Each(even.map(Fraction)),
                odd: Each(odd.map(Fraction)),
                scale: scale.map(Positive),
            }),
        };
        Self { uv_scale: Each([Number(1.0); 2]), uv_rotate: Angle(0.0), uv_offset: Vec2::ZERO, kind }
    }
}
