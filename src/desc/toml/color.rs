//! Colours and numbers that may come from a texture.

use super::build::Builder;
use super::keys::keys;
use super::read::{At, Fault, Fraction, Node, NonNegative, Read, mismatch, words};
use super::schema::Defs;
use crate::desc::image_file::srgb8_to_linear;
use crate::desc::{ColorParam, ScalarParam};
use ::toml::de::DeValue;
use serde_json::{Value as Json, json};

/// A linear RGB colour: one number for all three, `[r, g, b]`, `"#rrggbb"` (sRGB), the name of a texture, or a table
/// `{ texture = "name", factor = … }`. `Reflectance` and `Radiance` are its two ranges.
#[derive(Clone, Debug)]
pub(super) enum Color<R> {
    /// The same everywhere.
    Constant([R; 3]),
    /// From a texture, with a factor.
    Textured(Textured<R>),
}

/// Each channel in [0, 1].
pub(super) type Reflectance = Color<Fraction>;
/// Each channel at least 0.
pub(super) type Radiance = Color<NonNegative>;

/// A texture with a factor.
#[derive(Clone, Debug)]
pub(super) struct Textured<R> {
    texture: At<String>,
    factor: [R; 3],
    uv_set: u32,
}

/// A number that a colour may have in a channel.
pub(super) trait Channel: Read + Copy {
    /// Its value.
    fn get(self) -> f32;
    /// The same from a value in [0, 1].
    fn from_fraction(x: f32) -> Self;
}

impl Channel for Fraction {
    fn get(self) -> f32 {
        self.0
    }
    fn from_fraction(x: f32) -> Self {
        Self(x)
    }
}

impl Channel for NonNegative {
    fn get(self) -> f32 {
        self.0
    }
    fn from_fraction(x: f32) -> Self {
        Self(x)
    }
}

keys! {
    /// A texture with a factor.
    struct TexturedColor {
        /// Name of the texture.
        texture: At<String>,
        /// Factor on its RGB: a number or [r, g, b]. Default 1.
        factor: Option<Grey<NonNegative>>,
        /// Which of the mesh's UV sets: 0 or 1. Default 0.
        uv_set: u32 = 0,
    }
}

keys! {
    /// One channel of a texture with a factor.
    struct TexturedScalar {
        /// Name of the texture.
        texture: At<String>,
        /// Factor on the channel. Default 1.
        factor: NonNegative = NonNegative(1.0),
        /// Channel: "r", "g", "b" or "a". Default "r".
        channel: ChannelName = ChannelName(0),
        /// Which of the mesh's UV sets: 0 or 1. Default 0.
        uv_set: u32 = 0,
    }
}

/// A channel of a texture.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChannelName(usize);

words! { ChannelName: "r" => ChannelName(0), "g" => ChannelName(1), "b" => ChannelName(2), "a" => ChannelName(3); }

/// A number for all channels, or RGB.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grey<R>(pub(super) [R; 3]);

impl<R: Channel> Read for Grey<R> {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::Array(_) => <[R; 3]>::read(node).map(Self),
            DeValue::Float(_) | DeValue::Integer(_) => R::read(node).map(|x| Self([x; 3])),
            _ => Err(mismatch::<Self>(node)),
        }
    }
    fn one() -> String {
        format!("{} or {}", R::one(), <[R; 3]>::one())
    }
    fn many() -> String {
        R::many()
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "anyOf": [R::schema(defs), <[R; 3]>::schema(defs)] })
    }
}

impl<R: Channel> Read for Color<R> {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::Array(_) | DeValue::Float(_) | DeValue::Integer(_) => {
                Grey::read(node).map(|c| Self::Constant(c.0))
            }
            DeValue::String(s) if s.starts_with('#') => {
                let rgb = hex(s).ok_or_else(|| mismatch::<Self>(node))?;
                Ok(Self::Constant(rgb.map(R::from_fraction)))
            }
            DeValue::String(_) => {
                let factor = [R::from_fraction(1.0); 3];
                Ok(Self::Textured(Textured { texture: At::read(node)?, factor, uv_set: 0 }))
            }
            DeValue::Table(_) => {
                let t = TexturedColor::read(node)?;
                let factor = match t.factor {
                    None => [R::from_fraction(1.0); 3],
                    Some(Grey(rgb)) => rgb.map(|x| R::from_fraction(x.0)),
                };
                Ok(Self::Textured(Textured { texture: t.texture, factor, uv_set: t.uv_set }))
            }
            _ => Err(mismatch::<Self>(node)),
        }
    }
    fn one() -> String {
        format!("{}, [r, g, b], \"#rrggbb\", a texture's name or {{ texture = …, factor = … }}", R::one())
    }
    fn many() -> String {
        "colours".into()
    }
    fn schema(defs: &mut Defs) -> Json {
        let (one, three) = (R::schema(defs), <[R; 3]>::schema(defs));
        json!({ "anyOf": [one, three, { "type": "string" }, defs.reference::<TexturedColor>()] })
    }
}

/// `#rrggbb` in sRGB to linear RGB.
fn hex(s: &str) -> Option<[f32; 3]> {
    let digits = s.strip_prefix('#').filter(|d| d.len() == 6 && d.bytes().all(|b| b.is_ascii_hexdigit()))?;
    let n = u32::from_str_radix(digits, 16).ok()?;
    let [_, r, g, b] = n.to_be_bytes();
    let [r, g, b, _] = srgb8_to_linear([r, g, b, 255]);
    Some([r, g, b])
}

/// A number in [0, 1], the name of a texture (its red channel), or a table `{ texture = "name", channel = "g" }`.
#[derive(Clone, Debug)]
pub(super) enum Scalar {
    /// The same everywhere.
    Constant(f32),
    /// From a texture.
    Textured(TexturedScalar),
}

impl Read for Scalar {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::Float(_) | DeValue::Integer(_) => Fraction::read(node).map(|x| Self::Constant(x.0)),
            DeValue::String(_) => Ok(Self::Textured(TexturedScalar {
                texture: At::read(node)?,
                factor: NonNegative(1.0),
                channel: ChannelName(0),
                uv_set: 0,
            })),
            DeValue::Table(_) => TexturedScalar::read(node).map(Self::Textured),
            _ => Err(mismatch::<Self>(node)),
        }
    }
    fn one() -> String {
        format!("{}, a texture's name or {{ texture = …, channel = … }}", Fraction::one())
    }
    fn many() -> String {
        "numbers".into()
    }
    fn schema(defs: &mut Defs) -> Json {
        let one = Fraction::schema(defs);
        json!({ "anyOf": [one, { "type": "string" }, defs.reference::<TexturedScalar>()] })
    }
}

impl<R: Channel> Color<R> {
    /// The parameter, with its texture looked up.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<ColorParam, Fault> {
        Ok(match self {
            Self::Constant(rgb) => ColorParam::constant(rgb.map(R::get)),
            Self::Textured(t) => ColorParam {
                factor: t.factor.map(R::get),
                texture: Some(b.texture(&t.texture, t.uv_set, true)?),
                vertex_color: false,
            },
        })
    }

    /// The parameter, times the vertex colour of meshes that have one.
    pub(super) fn build_base(&self, b: &mut Builder<'_>) -> Result<ColorParam, Fault> {
        Ok(ColorParam { vertex_color: true, ..self.build(b)? })
    }
}

impl Scalar {
    /// The parameter, with its texture looked up.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<ScalarParam, Fault> {
        Ok(match self {
            Self::Constant(x) => ScalarParam::constant(*x),
            Self::Textured(t) => ScalarParam {
                factor: t.factor.0,
                texture: Some((b.texture(&t.texture, t.uv_set, false)?, t.channel.0)),
            },
        })
    }
}
