//! Tables with known keys. A table is declared once; its declaration reads it, refuses unknown and missing keys,
//! documents it and becomes its JSON Schema.

use super::read::{Fault, Node, Read, list, mismatch, read_key, suggest};
use super::schema::{Alternative, Defs};
use super::write::Write;
use ::toml::de::{DeTable, DeValue};
use serde_json::Value as Json;
use std::collections::HashMap;
use std::ops::Range;

/// Declares a table: `keys! { /// about struct Name { /// about key: Type = default, ..part: Part, } }`.
///
/// A key without default may be left out if its type is an `Option`. A part is another declared table, whose keys
/// stand among the others.
macro_rules! keys {
    (
        $(#[doc = $about:literal])+
        struct $Name:ident {
            $($(#[doc = $doc:literal])+ $key:ident: $ty:ty $(= $default:expr)?,)*
            $(..$part:ident: $Part:ty,)*
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Debug)]
        pub(in crate::desc::toml) struct $Name {
            $($(#[doc = $doc])+ pub(in crate::desc::toml) $key: $ty,)*
            $(
                /// Further keys.
                pub(in crate::desc::toml) $part: $Part,
            )*
        }

        impl $crate::desc::toml::keys::Keys for $Name {
            const NAME: &'static str = stringify!($Name);
            const ABOUT: &'static str = concat!($($about, "\n"),+);

            #[allow(unused_variables, reason = "a table without parts does not look at its values")]
            fn names(
                table: &$crate::desc::toml::keys::Table<'_>,
                names: &mut Vec<&'static str>,
            ) -> Result<(), $crate::desc::toml::read::Fault> {
                names.extend::<&[&'static str]>(&[$(stringify!($key)),*]);
                $(<$Part as $crate::desc::toml::keys::Keys>::names(table, names)?;)*
                Ok(())
            }

            #[allow(unused_variables, reason = "a table without keys is not looked at")]
            fn take(
                table: &$crate::desc::toml::keys::Table<'_>,
            ) -> Result<Self, $crate::desc::toml::read::Fault> {
                Ok(Self {
                    $($key: {
                        #[allow(unused_mut, unused_assignments, reason = "the default is optional")]
                        let mut default = <$ty as $crate::desc::toml::read::Read>::absent();
                        $(default = Some($default);)?
                        table.take(stringify!($key), default)?
                    },)*
                    $($part: <$Part as $crate::desc::toml::keys::Keys>::take(table)?,)*
                })
            }

            #[allow(unused_variables, reason = "keys and parts are optional")]
            fn each(&self, visit: &mut dyn FnMut(&'static str, &dyn $crate::desc::toml::write::Write)) {
                $({
                    let value: &dyn $crate::desc::toml::write::Write = &self.$key;
                    #[allow(unused_mut, unused_assignments, reason = "the default is optional")]
                    let mut is_default = value.is_omitted();
                    $({
                        let default: $ty = $default;
                        is_default = is_default || $crate::desc::toml::write::Write::equals(&self.$key, &default);
                    })?
                    if !is_default {
                        visit(stringify!($key), value);
                    }
                })*
                $($crate::desc::toml::keys::Keys::each(&self.$part, visit);)*
            }

            #[allow(unused_mut, unused_variables, reason = "keys and parts are optional")]
            fn alternatives(
                defs: &mut $crate::desc::toml::schema::Defs,
            ) -> Vec<$crate::desc::toml::schema::Alternative> {
                let mut own = $crate::desc::toml::schema::Alternative::default();
                $({
                    #[allow(unused_mut, unused_assignments, reason = "the default is optional")]
                    let mut optional = <$ty as $crate::desc::toml::read::Read>::absent().is_some();
                    $(optional = true; let _ = || -> $ty { $default };)?
                    let schema = <$ty as $crate::desc::toml::read::Read>::schema(defs);
                    own.add(stringify!($key), concat!($($doc, "\n"),+), !optional, schema);
                })*
                let mut all = vec![own];
                $(all = $crate::desc::toml::schema::product(&all, &<$Part as $crate::desc::toml::keys::Keys>::alternatives(defs));)*
                all
            }
        }
    };
}
pub(super) use keys;

/// Declares tables of several types: `one_of! { /// about enum Name { "word" => Variant, … } default "word" }`. Each
/// variant holds the declared table of its name; the key `type` chooses.
macro_rules! one_of {
    ($(#[doc = $about:literal])+ enum $Name:ident { $($word:literal => $Variant:ident,)+ } default $default:expr) => {
        $(#[doc = $about])+
        #[derive(Clone, Debug)]
        #[allow(clippy::enum_variant_names, reason = "a variant is called as its table")]
        #[allow(clippy::large_enum_variant, reason = "a table is read once, and few are kept")]
        pub(in crate::desc::toml) enum $Name {
            $(
                /// As its table says.
                $Variant($Variant),
            )+
        }

        impl $crate::desc::toml::keys::Keys for $Name {
            const NAME: &'static str = stringify!($Name);
            const ABOUT: &'static str = concat!($($about, "\n"),+);

            fn names(
                table: &$crate::desc::toml::keys::Table<'_>,
                names: &mut Vec<&'static str>,
            ) -> Result<(), $crate::desc::toml::read::Fault> {
                names.push("type");
                match table.word(&[$($word),+], $default)? {
                    $($word => $Variant::names(table, names),)+
                    _ => Ok(()),
                }
            }

            fn take(
                table: &$crate::desc::toml::keys::Table<'_>,
            ) -> Result<Self, $crate::desc::toml::read::Fault> {
                let word = table.word(&[$($word),+], $default)?;
                $(if word == $word {
                    return $Variant::take(table).map(Self::$Variant);
                })+
                Err($crate::desc::toml::read::Fault::new(&table.at, "`type` is not known"))
            }

            fn each(&self, visit: &mut dyn FnMut(&'static str, &dyn $crate::desc::toml::write::Write)) {
                match self {
                    $(Self::$Variant(table) => {
                        if $default != Some($word) {
                            visit("type", &String::from($word));
                        }
                        $crate::desc::toml::keys::Keys::each(table, visit);
                    })+
                }
            }

            fn alternatives(
                defs: &mut $crate::desc::toml::schema::Defs,
            ) -> Vec<$crate::desc::toml::schema::Alternative> {
                let mut all = Vec::new();
                $(for alternative in $Variant::alternatives(defs) {
                    all.push(alternative.tagged($word, $Variant::ABOUT, $default != Some($word)));
                })+
                all
            }
        }
    };
}
pub(super) use one_of;

/// A declared table.
pub(super) trait Keys: Sized {
    /// Name in the schema.
    const NAME: &'static str;
    /// What it is.
    const ABOUT: &'static str;
    /// The keys that this table may have.
    fn names(table: &Table<'_>, names: &mut Vec<&'static str>) -> Result<(), Fault>;
    /// Reads the table, whose keys are known.
    fn take(table: &Table<'_>) -> Result<Self, Fault>;
    /// Visits its keys in order, without those that are left out or have their defaults.
    fn each(&self, visit: &mut dyn FnMut(&'static str, &dyn Write));
    /// Its keys, for the schema: one list for each `type`.
    fn alternatives(defs: &mut Defs) -> Vec<Alternative>;
}

/// A table with its place.
pub(super) struct Table<'a> {
    keys: &'a DeTable<'a>,
    /// Bytes of the text.
    pub(super) at: Range<usize>,
}

impl<'a> Table<'a> {
    /// The value as a table.
    fn of(node: &'a Node<'_>) -> Option<Self> {
        match node.get_ref() {
            DeValue::Table(keys) => Some(Self { keys, at: node.span() }),
            _ => None,
        }
    }

    /// Refuses keys that `K` does not have. The first in the file is named.
    fn check<K: Keys>(&self) -> Result<(), Fault> {
        let mut known = Vec::new();
        K::names(self, &mut known)?;
        let unknown = |key: &str| !known.contains(&underscored(key).as_str());
        let first = self.keys.keys().filter(|k| unknown(k.get_ref())).min_by_key(|k| k.span().start);
        first.map_or(Ok(()), |key| {
            let hint = suggest(&underscored(key.get_ref()), known.iter().copied());
            Err(Fault::new(&key.span(), format!("unknown key `{}`; {hint}", key.get_ref())))
        })
    }

    /// The value of a key; the one written with underscores where both spellings are there.
    fn get(&self, key: &str) -> Result<Option<&'a Node<'a>>, Fault> {
        let mut all = self.keys.iter().filter(|(k, _)| underscored(k.get_ref()) == key);
        match (all.next(), all.next()) {
            (_, Some((again, _))) => Err(Fault::new(&again.span(), format!("`{key}` is given twice"))),
            (one, None) => Ok(one.map(|(_, node)| node)),
        }
    }

    /// Reads the value of a key.
    pub(super) fn take<T: Read>(&self, key: &str, default: Option<T>) -> Result<T, Fault> {
        match (self.get(key)?, default) {
            (Some(node), _) => read_key(key, node),
            (None, Some(default)) => Ok(default),
            (None, None) => Err(Fault::new(&self.at, format!("missing key `{key}`; expected {}", T::one()))),
        }
    }

    /// The value of `type`.
    pub(super) fn word(&self, known: &[&'static str], default: Option<&'static str>) -> Result<&'static str, Fault> {
        let Some(node) = self.get("type")? else {
            let missing = || Fault::new(&self.at, format!("missing key `type`; expected one of {}", list(known)));
            return default.ok_or_else(missing);
        };
        let word: String = read_key("type", node)?;
        known.iter().copied().find(|k| *k == word).ok_or_else(|| {
            Fault::new(&node.span(), format!("unknown type `{word}`; {}", suggest(&word, known.iter().copied())))
        })
    }
}

/// A hyphen in a key is read as an underscore.
fn underscored(key: &str) -> String {
    key.replace('-', "_")
}

impl<K: Keys> Read for K {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        let table = Table::of(node).ok_or_else(|| mismatch::<Self>(node))?;
        table.check::<K>()?;
        K::take(&table)
    }
    fn one() -> String {
        "a table".into()
    }
    fn many() -> String {
        "tables".into()
    }
    fn schema(defs: &mut Defs) -> Json {
        defs.reference::<K>()
    }
}

/// Tables by name, `[material.white]`, in the order of the file.
#[derive(Clone, Debug)]
pub(super) struct Named<T> {
    /// In the order of the file.
    pub(super) entries: Vec<Entry<T>>,
    /// The number of each name.
    numbers: HashMap<String, usize>,
}

impl<T> Named<T> {
    fn new(entries: Vec<Entry<T>>) -> Self {
        let numbers = entries.iter().enumerate().map(|(i, entry)| (entry.name.clone(), i)).collect();
        Self { entries, numbers }
    }

    /// Tables that were not read.
    pub(super) fn of(tables: impl IntoIterator<Item = (String, T)>) -> Self {
        let entry = |(name, value)| Entry { name, at: 0..0, table: 0..0, value };
        Self::new(tables.into_iter().map(entry).collect())
    }

    /// The number of the table of this name.
    pub(super) fn number(&self, name: &str) -> Option<usize> {
        self.numbers.get(name).copied()
    }
}

/// One of them.
#[derive(Clone, Debug)]
pub(super) struct Entry<T> {
    /// Its name.
    pub(super) name: String,
    /// Where the name stands.
    pub(super) at: Range<usize>,
    /// Where the table stands.
    pub(super) table: Range<usize>,
    /// The table.
    pub(super) value: T,
}

impl<T: Read> Read for Named<T> {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        let table = node.get_ref().as_table().ok_or_else(|| mismatch::<Self>(node))?;
        let mut entries = Vec::new();
        for (name, node) in table.iter() {
            entries.push(Entry {
                name: name.get_ref().to_string(),
                at: name.span(),
                table: node.span(),
                value: read_key(name.get_ref(), node)?,
            });
        }
        entries.sort_by_key(|e| e.at.start);
        Ok(Self::new(entries))
    }
    fn absent() -> Option<Self> {
        Some(Self::new(Vec::new()))
    }
    fn one() -> String {
        format!("{} by name", T::many())
    }
    fn many() -> String {
        Self::one()
    }
    fn schema(defs: &mut Defs) -> Json {
        serde_json::json!({ "type": "object", "additionalProperties": T::schema(defs) })
    }
}

/// One table, or an array of them.
#[derive(Clone, Debug)]
pub(super) struct OneOrMore<T>(pub(super) Vec<T>);

impl<T: Read> Read for OneOrMore<T> {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::Array(_) => Vec::read(node).map(Self),
            DeValue::Table(_) => T::read(node).map(|one| Self(vec![one])),
            _ => Err(mismatch::<Self>(node)),
        }
    }
    fn absent() -> Option<Self> {
        Some(Self(Vec::new()))
    }
    fn one() -> String {
        format!("{} or an array of {}", T::one(), T::many())
    }
    fn many() -> String {
        T::many()
    }
    fn schema(defs: &mut Defs) -> Json {
        let one = T::schema(defs);
        serde_json::json!({ "anyOf": [one, { "type": "array", "items": one }] })
    }
}
