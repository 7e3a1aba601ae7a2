//! Values with a short form: one number for several, or a texture's name for a table.

use super::keys::Keys;
use super::read::{At, Fault, Node, Read, mismatch};
use super::schema::Defs;
use super::write::{Write, array};
use ::toml::de::DeValue;
use serde_json::{Value as Json, json};

/// An array of N values, or one value for all of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Each<T, const N: usize>(pub(super) [T; N]);

impl<T: Read + Copy, const N: usize> Read for Each<T, N> {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::Array(_) => <[T; N]>::read(node).map(Self),
            _ => T::read(node).map(|x| Self([x; N])).map_err(|fault| {
                // What is no such value at all might have been meant as an array.
                if fault.message.starts_with("found") { mismatch::<Self>(node) } else { fault }
            }),
        }
    }
    fn one() -> String {
        format!("{} or {}", T::one(), <[T; N]>::one())
    }
    fn many() -> String {
        T::many()
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "anyOf": [T::schema(defs), <[T; N]>::schema(defs)] })
    }
}

impl<T: Write, const N: usize> Write for Each<T, N> {
    fn text(&self) -> String {
        match &self.0[..] {
            [first, others @ ..] if others.iter().all(|x| x.text() == first.text()) => first.text(),
            all => array(all),
        }
    }
}

/// A table about a texture whose other keys have defaults.
pub(super) trait OfTexture: Keys {
    /// A key beside `texture`, for messages.
    const KEY: &'static str;
    /// The table with this texture and defaults.
    fn of_texture(name: At<String>) -> Self;
}

/// The name of a texture, or a table about it.
#[derive(Clone, Debug)]
pub(super) struct NameOr<K>(pub(super) K);

impl<K: OfTexture> Read for NameOr<K> {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::String(_) => At::read(node).map(|name| Self(K::of_texture(name))),
            DeValue::Table(_) => K::read(node).map(Self),
            _ => Err(mismatch::<Self>(node)),
        }
    }
    fn one() -> String {
        format!("a texture's name or {{ texture = …, {} = … }}", K::KEY)
    }
    fn many() -> String {
        "textures".into()
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "anyOf": [{ "type": "string" }, defs.reference::<K>()] })
    }
}

impl<K: OfTexture> Write for NameOr<K> {
    fn text(&self) -> String {
        self.0.text()
    }
}
