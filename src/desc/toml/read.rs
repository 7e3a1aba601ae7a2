//! Values of a TOML file, with their places, to numbers, words and lists.

use super::schema::Defs;
use crate::desc::{Error, ErrorKind};
use ::toml::Spanned;
use ::toml::de::DeValue;
use glam::{Vec2, Vec3};
use serde_json::{Value as Json, json};
use std::ops::Range;
use std::path::Path;

/// A value with its place.
pub(super) type Node<'a> = Spanned<DeValue<'a>>;

/// Something that is wrong at a place.
#[derive(Clone, Debug)]
pub(super) struct Fault {
    /// Bytes of the text.
    pub(super) at: Range<usize>,
    /// What was found and what was expected.
    pub(super) message: String,
    /// What sort of failure.
    pub(super) kind: ErrorKind,
}

impl Fault {
    pub(super) fn new(at: &Range<usize>, message: impl Into<String>) -> Self {
        Self { at: at.clone(), message: message.into(), kind: ErrorKind::Invalid }
    }

    /// What went wrong with a file that this place names.
    pub(super) fn of_file(at: &Range<usize>, e: Error) -> Self {
        let place = if e.place.is_empty() { String::new() } else { format!("{}: ", e.place) };
        Self { at: at.clone(), message: format!("{place}{}", e.message), kind: e.kind }
    }

    /// The same, said of the value of `key`.
    pub(super) fn under(self, key: &str) -> Self {
        Self { message: format!("`{key}`: {}", self.message), ..self }
    }

    /// With file, line and column.
    pub(super) fn locate(self, path: &Path, text: &str) -> Error {
        let before = text.get(..self.at.start).unwrap_or(text);
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        Error { file: path.into(), place: format!("{line}:{column}"), message: self.message, kind: self.kind }
    }
}

/// A value that remembers where it stood.
#[derive(Clone, Debug)]
pub(super) struct At<T> {
    /// Bytes of the text.
    pub(super) at: Range<usize>,
    /// The value.
    pub(super) value: T,
}

/// What can be read from a value, and how a JSON Schema says it.
pub(super) trait Read: Sized {
    /// Reads one value.
    fn read(node: &Node<'_>) -> Result<Self, Fault>;
    /// The value of a key that is left out; `None`: the key must be there.
    fn absent() -> Option<Self> {
        None
    }
    /// "a number".
    fn one() -> String;
    /// "numbers".
    fn many() -> String;
    /// The JSON Schema of the value.
    fn schema(defs: &mut Defs) -> Json;
}

/// What stands there, for messages.
pub(super) fn found(node: &Node<'_>) -> String {
    match node.get_ref() {
        DeValue::String(s) if s.chars().count() > 40 => format!("a string of {} characters", s.chars().count()),
        DeValue::String(s) => format!("the string {s:?}"),
        DeValue::Integer(i) => i.to_string(),
        DeValue::Float(f) => f.to_string(),
        DeValue::Boolean(b) => b.to_string(),
        DeValue::Datetime(d) => format!("the date {d}"),
        DeValue::Array(a) => match a.len() {
            1 => "an array of 1 value".into(),
            n => format!("an array of {n} values"),
        },
        DeValue::Table(_) => "a table".into(),
    }
}

/// "found this, expected a `T`".
pub(super) fn mismatch<T: Read>(node: &Node<'_>) -> Fault {
    unexpected(node, &T::one())
}

/// "found this, expected that".
pub(super) fn unexpected(node: &Node<'_>, expected: &str) -> Fault {
    Fault::new(&node.span(), format!("found {}, expected {expected}", found(node)))
}

/// The nearest of the known words, as the end of a sentence; all of them where none is near.
pub(super) fn suggest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<_> = known.into_iter().collect();
    let near = known.iter().map(|k| (strsim::damerau_levenshtein(word, k), k)).min();
    match near {
        Some((distance, k)) if distance <= 1 + word.chars().count() / 3 => format!("did you mean `{k}`?"),
        _ if known.is_empty() => "there is none".into(),
        _ => format!("expected one of {}", list(&known)),
    }
}

/// `a`, `b`, `c`.
pub(super) fn list(words: &[&str]) -> String {
    words.iter().map(|w| format!("`{w}`")).collect::<Vec<_>>().join(", ")
}

/// A real number, infinite and NaN included.
fn number(node: &Node<'_>) -> Option<f64> {
    match node.get_ref() {
        DeValue::Float(f) => f.as_str().parse().ok(),
        DeValue::Integer(i) => i128::from_str_radix(i.as_str(), i.radix()).ok().map(|i| i as f64),
        _ => None,
    }
}

/// Defines a number with a range.
macro_rules! numbers {
    ($($(#[doc = $doc:literal])+ $Name:ident: $one:literal, $many:literal, |$x:ident| $valid:expr, $schema:tt;)+) => {$(
        $(#[doc = $doc])+
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(super) struct $Name(pub(super) f32);

        impl Read for $Name {
            fn read(node: &Node<'_>) -> Result<Self, Fault> {
                let $x = number(node).ok_or_else(|| mismatch::<Self>(node))? as f32;
                if $x.is_finite() && $valid { Ok(Self($x)) } else { Err(mismatch::<Self>(node)) }
            }
            fn one() -> String {
                $one.into()
            }
            fn many() -> String {
                $many.into()
            }
            fn schema(_: &mut Defs) -> Json {
                json!($schema)
            }
        }
    )+};
}

numbers! {
    /// Any number.
    Number: "a finite number", "finite numbers", |x| true, { "type": "number" };
    /// x > 0.
    Positive: "a number > 0", "numbers > 0", |x| x > 0.0, { "type": "number", "exclusiveMinimum": 0 };
    /// x ≥ 0.
    NonNegative: "a number ≥ 0", "numbers ≥ 0", |x| x >= 0.0, { "type": "number", "minimum": 0 };
    /// 0 ≤ x ≤ 1.
    Fraction: "a number in [0, 1]", "numbers in [0, 1]", |x| (0.0..=1.0).contains(&x), { "type": "number", "minimum": 0, "maximum": 1 };
    /// 0° < x < 180°.
    ViewAngle: "an angle between 0 and 180 degrees", "angles between 0 and 180 degrees", |x| x > 0.0 && x < 180.0, { "type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 180 };
    /// 0° ≤ x ≤ 90°.
    HalfAngle: "an angle from 0 to 90 degrees", "angles from 0 to 90 degrees", |x| (0.0..=90.0).contains(&x), { "type": "number", "minimum": 0, "maximum": 90 };
}

/// Implements [`Read`] for integers.
macro_rules! integers {
    ($($T:ty: $min:expr, $max:expr, $one:literal, $many:literal;)+) => {$(
        impl Read for $T {
            fn read(node: &Node<'_>) -> Result<Self, Fault> {
                let DeValue::Integer(i) = node.get_ref() else { return Err(mismatch::<Self>(node)) };
                let value = <$T>::from_str_radix(i.as_str(), i.radix()).map_err(|_| mismatch::<Self>(node))?;
                Ok(value)
            }
            fn one() -> String {
                $one.into()
            }
            fn many() -> String {
                $many.into()
            }
            fn schema(_: &mut Defs) -> Json {
                json!({ "type": "integer", "minimum": $min, "maximum": $max })
            }
        }
    )+};
}

integers! {
    u32: 0, u32::MAX, "a whole number ≥ 0", "whole numbers ≥ 0";
    i32: -2_147_483_648, i32::MAX, "a whole number", "whole numbers";
}

/// A side of an image in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelCount(pub(super) u32);

impl Read for PixelCount {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match u32::read(node) {
            Ok(n @ 1..=65_536) => Ok(Self(n)),
            _ => Err(mismatch::<Self>(node)),
        }
    }
    fn one() -> String {
        "a whole number from 1 to 65536".into()
    }
    fn many() -> String {
        "whole numbers from 1 to 65536".into()
    }
    fn schema(_: &mut Defs) -> Json {
        json!({ "type": "integer", "minimum": 1, "maximum": 65_536 })
    }
}

impl Read for bool {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        node.get_ref().as_bool().ok_or_else(|| mismatch::<Self>(node))
    }
    fn one() -> String {
        "true or false".into()
    }
    fn many() -> String {
        "values true or false".into()
    }
    fn schema(_: &mut Defs) -> Json {
        json!({ "type": "boolean" })
    }
}

impl Read for String {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        node.get_ref().as_str().map(Into::into).ok_or_else(|| mismatch::<Self>(node))
    }
    fn one() -> String {
        "a string".into()
    }
    fn many() -> String {
        "strings".into()
    }
    fn schema(_: &mut Defs) -> Json {
        json!({ "type": "string" })
    }
}

impl<T: Read> Read for At<T> {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        Ok(Self { at: node.span(), value: T::read(node)? })
    }
    fn one() -> String {
        T::one()
    }
    fn many() -> String {
        T::many()
    }
    fn schema(defs: &mut Defs) -> Json {
        T::schema(defs)
    }
}

impl<T: Read> Read for Option<T> {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        T::read(node).map(Some)
    }
    fn absent() -> Option<Self> {
        Some(None)
    }
    fn one() -> String {
        T::one()
    }
    fn many() -> String {
        T::many()
    }
    fn schema(defs: &mut Defs) -> Json {
        T::schema(defs)
    }
}

impl<T: Read, const N: usize> Read for [T; N] {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        let wrong = || mismatch::<Self>(node);
        let items = node.get_ref().as_array().filter(|a| a.len() == N).ok_or_else(wrong)?;
        let items: Vec<T> = items.iter().map(T::read).collect::<Result<_, _>>()?;
        items.try_into().map_err(|_| wrong())
    }
    fn one() -> String {
        format!("an array of {N} {}", T::many())
    }
    fn many() -> String {
        format!("arrays of {N} {}", T::many())
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "type": "array", "items": T::schema(defs), "minItems": N, "maxItems": N })
    }
}

impl<T: Read> Read for Vec<T> {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        let items = node.get_ref().as_array().ok_or_else(|| mismatch::<Self>(node))?;
        items.iter().map(T::read).collect()
    }
    fn one() -> String {
        format!("an array of {}", T::many())
    }
    fn many() -> String {
        format!("arrays of {}", T::many())
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "type": "array", "items": T::schema(defs) })
    }
}

/// Reads arrays of numbers as vectors.
macro_rules! vectors {
    ($($T:ty, $n:literal;)+) => {$(
        impl Read for $T {
            fn read(node: &Node<'_>) -> Result<Self, Fault> {
                <[Number; $n]>::read(node).map(|v| v.map(|x| x.0).into())
            }
            fn one() -> String {
                <[Number; $n]>::one()
            }
            fn many() -> String {
                <[Number; $n]>::many()
            }
            fn schema(defs: &mut Defs) -> Json {
                <[Number; $n]>::schema(defs)
            }
        }
    )+};
}

vectors! {
    Vec2, 2;
    Vec3, 3;
}

/// Reads strings as the values of an enum: `words! { Sides: "front" => Sides::Front, …; }`.
macro_rules! words {
    ($($T:ty: $($word:literal => $value:expr),+;)+) => {$(
        impl $crate::desc::toml::read::Read for $T {
            fn read(node: &$crate::desc::toml::read::Node<'_>) -> Result<Self, $crate::desc::toml::read::Fault> {
                use $crate::desc::toml::read::{Fault, mismatch, suggest};
                match node.get_ref().as_str() {
                    $(Some($word) => Ok($value),)+
                    Some(other) => Err(Fault::new(&node.span(), format!("unknown value {other:?}; {}", suggest(other, [$($word),+])))),
                    None => Err(mismatch::<Self>(node)),
                }
            }
            fn one() -> String {
                format!("one of {}", $crate::desc::toml::read::list(&[$($word),+]))
            }
            fn many() -> String {
                format!("of {}", $crate::desc::toml::read::list(&[$($word),+]))
            }
            fn schema(_: &mut $crate::desc::toml::schema::Defs) -> serde_json::Value {
                serde_json::json!({ "enum": [$($word),+] })
            }
        }
    )+};
}
pub(super) use words;

/// What is wrong with the value of a key, said of the key.
pub(super) fn read_key<T: Read>(key: &str, node: &Node<'_>) -> Result<T, Fault> {
    T::read(node).map_err(|fault| {
        if fault.message.starts_with("found") || fault.message.starts_with("unknown value") {
            fault.under(key)
        } else {
            fault
        }
    })
}
