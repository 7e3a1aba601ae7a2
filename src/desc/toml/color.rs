//! Colours and numbers that may come from a texture.

use super::build::Builder;
use super::keys::keys;
use super::lookup::Lookup;
use super::number::{Fraction, NonNegative};
use super::read::{At, Fault, Node, Read, mismatch};
use super::schema::Defs;
use super::short::Each;
use super::words::words;
use super::write::Write;
use super::writer::Names;
use crate::desc::image_file::srgb8_to_linear;
use crate::desc::{ColorParam, ScalarParam};
use ::toml::de::DeValue;
use serde_json::{Value as Json, json};

/// A number for all channels, or RGB.
pub(super) type Rgb<R> = Each<R, 3>;

/// A linear RGB colour: one number for all three, `[r, g, b]`, `"#rrggbb"` (sRGB), the name of a texture, or a table
/// `{ texture = "name", factor = … }`. `Reflectance` and `Radiance` are its two ranges.
#[derive(Clone, Debug)]
pub(super) enum Color<R> {
    /// A constant.
    Constant([R; 3]),
    /// A factor on a texture or on vertex colours.
    Varying(TexturedColor),
}

/// Each channel in [0, 1].
pub(super) type Reflectance = Color<Fraction>;
/// Each channel at least 0.
pub(super) type Radiance = Color<NonNegative>;

/// A number that a colour may have in a channel.
pub(super) trait Channel: Read + Copy {
    /// Its value.
    fn get(self) -> f32;
    /// The channel whose value is `x`, in range.
    fn of(x: f32) -> Self;
    /// Whether `x` is in range.
    fn contains(x: f32) -> bool;
}

impl Channel for Fraction {
    fn get(self) -> f32 {
        self.0
    }
    fn of(x: f32) -> Self {
        Self(x)
    }
    fn contains(x: f32) -> bool {
        (0.0..=1.0).contains(&x)
    }
}

impl Channel for NonNegative {
    fn get(self) -> f32 {
        self.0
    }
    fn of(x: f32) -> Self {
        Self(x)
    }
    fn contains(x: f32) -> bool {
        x >= 0.0
    }
}

keys! {
    /// A factor, on a texture or on vertex colours.
    struct TexturedColor {
        /// Name of the texture. Default: none.
        texture: Option<At<String>>,
        /// Factor on its RGB: a number or [r, g, b]. Default 1.
        factor: At<Rgb<NonNegative>> = At::nowhere(Each([NonNegative(1.0); 3])),
        /// Whether the vertex colours of a mesh that has some are a factor too. Default: of base colours, and of the reflectance of diffuse and Phong materials.
        vertex_colors: Option<bool>,
        ..lookup: Lookup,
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
        ..lookup: Lookup,
    }
}

/// A channel of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ChannelName(pub(super) usize);

words! { ChannelName: "r" => ChannelName(0), "g" => ChannelName(1), "b" => ChannelName(2), "a" => ChannelName(3); }

impl<R: Channel> Read for Color<R> {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::Array(_) => <[R; 3]>::read(node).map(Self::Constant),
            DeValue::Float(_) | DeValue::Integer(_) => R::read(node).map(|x| Self::Constant([x; 3])),
            DeValue::String(s) if s.starts_with('#') => {
                let rgb = hex(s).ok_or_else(|| mismatch::<Self>(node))?;
                Ok(Self::Constant(rgb.map(R::of)))
            }
            DeValue::String(_) => Ok(Self::Varying(TexturedColor {
                texture: Some(At::read(node)?),
                factor: At::nowhere(Each([NonNegative(1.0); 3])),
                vertex_colors: None,
                lookup: Lookup::plain(),
            })),
            DeValue::Table(_) => {
                let table = TexturedColor::read(node)?;
                let factor = &table.factor;
                // Without a texture it is the colour itself, with the range of one.
                if table.texture.is_none() && factor.value.0.iter().any(|x| !R::contains(x.0)) {
                    return Err(Fault::new(&factor.at, format!("`factor` without a texture: expected {}", R::one())));
                }
                Ok(Self::Varying(table))
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

impl<R: Channel> Write for Color<R> {
    fn text(&self) -> String {
        match self {
            Self::Constant(rgb) => Each(*rgb).text(),
            Self::Varying(table) => table.text(),
        }
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
    /// A constant.
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
                lookup: Lookup::plain(),
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

impl Write for Scalar {
    fn text(&self) -> String {
        match self {
            Self::Constant(x) => Fraction(*x).text(),
            Self::Textured(table) => table.text(),
        }
    }
}

impl<R: Channel> Color<R> {
    /// White.
    pub(super) fn one_everywhere() -> Self {
        Self::Constant([R::of(1.0); 3])
    }

    /// The parameter, with its texture looked up.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<ColorParam, Fault> {
        self.param(false, b)
    }

    /// The parameter, by default times the vertex colour of meshes that have one.
    pub(super) fn build_base(&self, b: &mut Builder<'_>) -> Result<ColorParam, Fault> {
        self.param(true, b)
    }

    fn param(&self, vertex_color: bool, b: &mut Builder<'_>) -> Result<ColorParam, Fault> {
        Ok(match self {
            Self::Constant(rgb) => ColorParam { factor: rgb.map(R::get), texture: None, vertex_color },
            Self::Varying(t) => ColorParam {
                factor: t.factor.value.0.map(|x| x.0),
                texture: t.texture.as_ref().map(|name| b.texture(name, &t.lookup, true)).transpose()?,
                vertex_color: t.vertex_colors.unwrap_or(vertex_color),
            },
        })
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(param: &ColorParam, names: &Names) -> Self {
        Self::of_param(param, false, names)
    }

    /// The inverse of [`Self::build_base`].
    pub(super) fn of_base(param: &ColorParam, names: &Names) -> Self {
        Self::of_param(param, true, names)
    }

    fn of_param(param: &ColorParam, vertex_color: bool, names: &Names) -> Self {
        let ColorParam { factor, texture, vertex_color: varies } = param;
        if texture.is_none() && *varies == vertex_color {
            return Self::Constant(factor.map(R::of));
        }
        Self::Varying(TexturedColor {
            texture: texture.map(|t| names.texture(&t)),
            factor: At::nowhere(Each(factor.map(NonNegative))),
            vertex_colors: (*varies != vertex_color).then_some(*varies),
            lookup: texture.map_or(Lookup::plain(), |t| Lookup::of(&t)),
        })
    }
}

impl Scalar {
    /// The parameter, with its texture looked up.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<ScalarParam, Fault> {
        Ok(match self {
            Self::Constant(x) => ScalarParam::constant(*x),
            Self::Textured(t) => ScalarParam {
                factor: t.factor.0,
                texture: Some((b.texture(&t.texture, &t.lookup, false)?, t.channel.0)),
            },
        })
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(param: &ScalarParam, names: &Names) -> Self {
        match param.texture {
            None => Self::Constant(param.factor),
            Some((texture, channel)) => Self::Textured(TexturedScalar {
                texture: names.texture(&texture),
                factor: NonNegative(param.factor),
                channel: ChannelName(channel),
                lookup: Lookup::of(&texture),
            }),
        }
    }
}
