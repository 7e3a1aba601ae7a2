//! `[texture.NAME]`.

use super::build::Builder;
use super::color::Grey;
use super::keys::{keys, one_of};
use super::read::{At, Fault, Fraction, Node, Number, Positive, Read, mismatch, words};
use super::schema::Defs;
use crate::desc::{Texture, Wrap};
use ::toml::de::DeValue;
use glam::{Affine2, Mat2, Vec2};
use serde_json::{Value as Json, json};

keys! {
    /// A function of the texture coordinates (u, v).
    struct TextureTable {
        /// Factor on (u, v) before the look-up, a number or two: 2 shows the image twice each way. Default 1.
        uv_scale: UvScale = UvScale(Vec2::ONE),
        /// Rotation of (u, v) in degrees, after the scale. Default 0.
        uv_rotate: Number = Number(0.0),
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
        file: At<String>,
        /// Outside the unit square: "repeat", "mirror" or "clamp", for both axes or one each. Default "repeat".
        wrap: Wraps = Wraps([Wrap::Repeat; 2]),
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
        even: Grey<Fraction> = Grey([Fraction(0.8); 3]),
        /// Linear colour elsewhere, a number or [r, g, b]. Default 0.2.
        odd: Grey<Fraction> = Grey([Fraction(0.2); 3]),
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

/// Wrap along u and v.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wraps([Wrap; 2]);

impl Read for Wraps {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::Array(_) => <[Wrap; 2]>::read(node).map(Self),
            DeValue::String(_) => Wrap::read(node).map(|w| Self([w; 2])),
            _ => Err(mismatch::<Self>(node)),
        }
    }
    fn one() -> String {
        format!("{}, or two of them", Wrap::one())
    }
    fn many() -> String {
        Wrap::many()
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "anyOf": [Wrap::schema(defs), <[Wrap; 2]>::schema(defs)] })
    }
}

/// Scale of u and v.
#[derive(Clone, Copy, Debug)]
pub(super) struct UvScale(Vec2);

impl Read for UvScale {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::Array(_) => Vec2::read(node).map(Self),
            _ => Number::read(node).map(|x| Self(Vec2::splat(x.0))).map_err(|_| mismatch::<Self>(node)),
        }
    }
    fn one() -> String {
        "a number or an array of 2 numbers".into()
    }
    fn many() -> String {
        "scales".into()
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "anyOf": [Number::schema(defs), Vec2::schema(defs)] })
    }
}

impl TextureTable {
    /// UV → UV before the look-up.
    pub(super) fn uv_transform(&self) -> Affine2 {
        let linear = Mat2::from_angle(self.uv_rotate.0.to_radians()) * Mat2::from_diagonal(self.uv_scale.0);
        Affine2::from_mat2_translation(linear, self.uv_offset)
    }

    /// The texture, used as a colour or as numbers; its image decoded at the first use.
    pub(super) fn build(&self, as_color: bool, b: &mut Builder<'_>) -> Result<Texture, Fault> {
        match &self.kind {
            TextureKind::ImageTexture(t) => {
                let image = b.image(&t.file)?;
                let codes = b.scene.images[image].pixels.are_codes();
                let srgb = codes && t.srgb.unwrap_or(as_color);
                if t.srgb == Some(true) && !codes {
                    return Err(Fault::new(&t.file.at, "a float image is linear; leave `srgb` out"));
                }
                Ok(Texture::Image { image, srgb, wrap: t.wrap.0, nearest: t.filter == Lookup::Nearest })
            }
            TextureKind::Checker(c) => {
                let [even, odd] = [&c.even, &c.odd].map(|color| color.0.map(|x| x.0));
                Ok(Texture::Checker { even, odd, scale: c.scale.map(|s| s.0) })
            }
        }
    }
}
