//! Values of a scene file as text: the inverse of [`read`](super::read). What is written reads as the same value, to the bit.

use super::keys::{Entry, Keys, Named, OneOrMore};

/// Width that arrays of a line of their own are broken at.
const WIDTH: usize = 110;

/// What can be written as the value of a key.
pub(super) trait Write {
    /// The value, as it may stand behind a `key = ` or in an array.
    fn text(&self) -> String;

    /// Whether `other` is written alike.
    fn equals(&self, other: &Self) -> bool
    where
        Self: Sized,
    {
        self.text() == other.text()
    }

    /// Whether there is nothing to write, and the key is left out.
    fn is_omitted(&self) -> bool {
        false
    }

    /// Of a table, the lines of its keys.
    fn body(&self) -> Option<String> {
        None
    }

    /// The key of the whole file, on a line or as tables with a heading.
    fn section(&self, key: &str, out: &mut String) {
        *out += &format!("{key} = {}\n", self.text());
    }
}

/// Keys and values of a table without those of their defaults; `type` comes first.
pub(super) fn pairs(table: &impl Keys) -> Vec<(&'static str, String)> {
    let mut pairs: Vec<(&'static str, String)> = Vec::new();
    table.each(&mut |key, value| {
        let at = if key == "type" { 0 } else { pairs.len() };
        pairs.insert(at, (key, value.text()));
    });
    pairs
}

impl<K: Keys> Write for K {
    fn text(&self) -> String {
        let pairs: Vec<_> = pairs(self).into_iter().map(|(key, text)| format!("{key} = {text}")).collect();
        if pairs.is_empty() { "{}".into() } else { format!("{{ {} }}", pairs.join(", ")) }
    }

    fn body(&self) -> Option<String> {
        Some(pairs(self).into_iter().map(|(key, text)| format!("{key} = {text}\n")).collect())
    }

    fn section(&self, key: &str, out: &mut String) {
        *out += &format!("\n[{key}]\n{}", self.body().unwrap_or_default());
    }
}

impl<T: Write> Write for Named<T> {
    fn text(&self) -> String {
        let item = |entry: &Entry<T>| format!("{} = {}", key(&entry.name), entry.value.text());
        let items: Vec<_> = self.entries.iter().map(item).collect();
        format!("{{ {} }}", items.join(", "))
    }

    fn is_omitted(&self) -> bool {
        self.entries.is_empty()
    }

    fn section(&self, kind: &str, out: &mut String) {
        for entry in &self.entries {
            entry.value.section(&format!("{kind}.{}", key(&entry.name)), out);
        }
    }
}

impl<T: Write> Write for OneOrMore<T> {
    fn text(&self) -> String {
        array(&self.0)
    }

    fn is_omitted(&self) -> bool {
        self.0.is_empty()
    }

    fn section(&self, key: &str, out: &mut String) {
        sections(&self.0, key, out);
    }
}

/// An array under a key of the whole file: tables with a heading each, other values on a line.
pub(super) fn sections<T: Write>(items: &[T], key: &str, out: &mut String) {
    match items.iter().map(T::body).collect::<Option<Vec<_>>>() {
        Some(bodies) => bodies.iter().for_each(|body| *out += &format!("\n[[{key}]]\n{body}")),
        None => *out += &format!("{key} = {}\n", array(items)),
    }
}

/// The keys of the whole file.
pub(super) fn document(file: &impl Keys) -> String {
    let mut out = String::new();
    file.each(&mut |key, value| value.section(key, &mut out));
    out
}

/// `[a, b, c]`, broken into lines where it is long.
pub(super) fn array<T: Write>(items: &[T]) -> String {
    let items: Vec<_> = items.iter().map(T::text).collect();
    if items.iter().map(|item| item.len() + 2).sum::<usize>() <= WIDTH {
        return format!("[{}]", items.join(", "));
    }
    let (mut out, mut column) = (String::from("["), usize::MAX);
    for item in items {
        if column.saturating_add(item.len()) > WIDTH {
            (out, column) = (out + "\n   ", 3);
        }
        column += item.len() + 2;
        out += &format!(" {item},");
    }
    out + "\n]"
}

/// The shortest number that reads as `x`.
pub(super) fn float(x: f32) -> String {
    let short = trimmed(format!("{x:?}"));
    // Readers go by f64, which may round the shortest f32 the other way.
    let same = short.parse::<f64>().is_ok_and(|read| (read as f32).to_bits() == x.to_bits());
    if same { short } else { double(x.into()) }
}

/// The shortest number that reads as `x`.
pub(super) fn double(x: f64) -> String {
    trimmed(format!("{x:?}"))
}

/// The angle `radians` in degrees; a short number where it reads as the same angle.
pub(super) fn degrees(radians: f32) -> String {
    let exact = f64::from(radians).to_degrees();
    let short = float(exact as f32);
    let same = short.parse::<f64>().is_ok_and(|read| (read.to_radians() as f32).to_bits() == radians.to_bits());
    if same { short } else { double(exact) }
}

/// Whole numbers without `.0`; only a float has a negative zero.
fn trimmed(text: String) -> String {
    match text.strip_suffix(".0") {
        Some(whole) if whole != "-0" => whole.into(),
        _ => text,
    }
}

/// A string in quotes.
pub(super) fn string(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => out += &format!("\\u{:04x}", u32::from(c)),
            c => out.push(c),
        }
    }
    out + "\""
}

/// A key, in quotes where it must be.
pub(super) fn key(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(bare) { name.into() } else { string(name) }
}
