//! Numbers with their ranges, and vectors of them.

use super::read::{Fault, Node, Read, mismatch};
use super::schema::Defs;
use super::write::{Write, array, degrees, float};
use ::toml::de::DeValue;
use glam::{Vec2, Vec3, Vec4};
use serde_json::{Value as Json, json};

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

        impl Write for $Name {
            fn text(&self) -> String {
                float(self.0)
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
}

/// Defines an angle with a range: degrees in the file, radians here. The conversion is in f64, so that every f32 of radians
/// has a number of degrees.
macro_rules! angles {
    ($($(#[doc = $doc:literal])+ $Name:ident: $one:literal, $many:literal, |$x:ident| $valid:expr, $schema:tt;)+) => {$(
        $(#[doc = $doc])+
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(super) struct $Name(pub(super) f32);

        impl Read for $Name {
            fn read(node: &Node<'_>) -> Result<Self, Fault> {
                let degrees = number(node).ok_or_else(|| mismatch::<Self>(node))?;
                let $x = degrees as f32;
                if $x.is_finite() && $valid { Ok(Self(degrees.to_radians() as f32)) } else { Err(mismatch::<Self>(node)) }
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

        impl Write for $Name {
            fn text(&self) -> String {
                degrees(self.0)
            }
        }
    )+};
}

angles! {
    /// Any angle \[rad\].
    Angle: "a finite number", "finite numbers", |x| true, { "type": "number" };
    /// 0° < x < 180° \[rad\].
    ViewAngle: "an angle between 0 and 180 degrees", "angles between 0 and 180 degrees", |x| (f32::MIN_POSITIVE..180.0).contains(&x), { "type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 180 };
    /// 0° ≤ x ≤ 90° \[rad\].
    HalfAngle: "an angle from 0 to 90 degrees", "angles from 0 to 90 degrees", |x| (0.0..=90.0).contains(&x), { "type": "number", "minimum": 0, "maximum": 90 };
}

/// A number ≥ 0 that is kept in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exact(pub(super) f64);

impl Read for Exact {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        let x = number(node).filter(|x| x.is_finite() && *x >= 0.0);
        x.map(Self).ok_or_else(|| mismatch::<Self>(node))
    }
    fn one() -> String {
        NonNegative::one()
    }
    fn many() -> String {
        NonNegative::many()
    }
    fn schema(defs: &mut Defs) -> Json {
        NonNegative::schema(defs)
    }
}

impl Write for Exact {
    fn text(&self) -> String {
        super::write::double(self.0)
    }
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

        impl Write for $T {
            fn text(&self) -> String {
                self.to_string()
            }
        }
    )+};
}

integers! {
    u32: 0, u32::MAX, "a whole number ≥ 0", "whole numbers ≥ 0";
    i32: -2_147_483_648, i32::MAX, "a whole number", "whole numbers";
    u64: 0, u64::MAX, "a whole number ≥ 0", "whole numbers ≥ 0";
}

/// Defines a whole number with a range.
macro_rules! counts {
    ($($(#[doc = $doc:literal])+ $Name:ident: $range:pat, $one:literal, $many:literal, $schema:tt;)+) => {$(
        $(#[doc = $doc])+
        #[derive(Clone, Copy, Debug)]
        pub(super) struct $Name(pub(super) u32);

        impl Read for $Name {
            fn read(node: &Node<'_>) -> Result<Self, Fault> {
                match u32::read(node) {
                    Ok(n @ $range) => Ok(Self(n)),
                    _ => Err(mismatch::<Self>(node)),
                }
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

        impl Write for $Name {
            fn text(&self) -> String {
                self.0.to_string()
            }
        }
    )+};
}

counts! {
    /// A side of an image in pixels.
    PixelCount: 1..=65_536, "a whole number from 1 to 65536", "whole numbers from 1 to 65536", { "type": "integer", "minimum": 1, "maximum": 65_536 };
    /// At least one.
    Count: 1.., "a whole number ≥ 1", "whole numbers ≥ 1", { "type": "integer", "minimum": 1, "maximum": 4_294_967_295_u32 };
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

        impl Write for $T {
            fn text(&self) -> String {
                array(&self.to_array().map(Number))
            }
        }
    )+};
}

vectors! {
    Vec2, 2;
    Vec3, 3;
    Vec4, 4;
}
