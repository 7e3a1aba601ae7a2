//! Values of a TOML file, with their places, to numbers, words and lists.

use super::schema::Defs;
use super::write::{Write, array};
use crate::desc::{Error, ErrorKind};
use ::toml::Spanned;
use ::toml::de::DeValue;
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

    /// This fault, said of the value of `key`.
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

impl<T> At<T> {
    /// A value that was not read: a default, or what is to be written.
    pub(super) fn nowhere(value: T) -> Self {
        Self { at: 0..0, value }
    }
}

/// What can be read from a value, and how a JSON Schema says it.
pub(super) trait Read: Write + Sized {
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
    /// Longest word whose distance from others is looked for, as that takes the product of both lengths.
    const LONGEST: usize = 64;
    /// Most words that a message lists.
    const MOST: usize = 32;
    let known: Vec<_> = known.into_iter().collect();
    let comparable = known.iter().filter(|k| word.len().max(k.len()) <= LONGEST);
    let near = comparable.map(|k| (strsim::damerau_levenshtein(word, k), k)).min();
    match near {
        Some((distance, k)) if distance <= 1 + word.chars().count() / 3 => format!("did you mean `{k}`?"),
        _ if known.is_empty() => "there is none".into(),
        _ if known.len() > MOST => format!("there are {}, none of a similar name", known.len()),
        _ => format!("expected one of {}", list(&known)),
    }
}

/// `a`, `b`, `c`.
pub(super) fn list(words: &[&str]) -> String {
    words.iter().map(|w| format!("`{w}`")).collect::<Vec<_>>().join(", ")
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

impl Write for bool {
    fn text(&self) -> String {
        self.to_string()
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

impl Write for String {
    fn text(&self) -> String {
        super::write::string(self)
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

impl<T: Write> Write for At<T> {
    fn text(&self) -> String {
        self.value.text()
    }
    fn is_omitted(&self) -> bool {
        self.value.is_omitted()
    }
    fn body(&self) -> Option<String> {
        self.value.body()
    }
    fn section(&self, key: &str, out: &mut String) {
        self.value.section(key, out);
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

impl<T: Write> Write for Option<T> {
    fn text(&self) -> String {
        self.as_ref().map(T::text).unwrap_or_default()
    }
    fn is_omitted(&self) -> bool {
        self.is_none()
    }
    fn section(&self, key: &str, out: &mut String) {
        self.iter().for_each(|value| value.section(key, out));
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

impl<T: Write, const N: usize> Write for [T; N] {
    fn text(&self) -> String {
        array(self)
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

impl<T: Write> Write for Vec<T> {
    fn text(&self) -> String {
        array(self)
    }
    fn equals(&self, other: &Self) -> bool {
        self.len() == other.len() && self.iter().zip(other).all(|(a, b)| a.equals(b))
    }
    fn section(&self, key: &str, out: &mut String) {
        super::write::sections(self, key, out);
    }
}

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
