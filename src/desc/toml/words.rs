//! Strings of which a few are known.

/// Reads strings as the values of an enum: `words! { Sides: "front" => Sides::Front, …; }`.
macro_rules! words {
    ($($T:ty: $($word:literal => $value:expr),+;)+) => {$(
        impl $crate::desc::toml::read::Read for $T {
            fn read(node: &$crate::desc::toml::read::Node<'_>) -> Result<Self, $crate::desc::toml::read::Fault> {
                use $crate::desc::toml::read::{Fault, mismatch, suggest};
                match node.get_ref().as_str() {
                    $(Some($word) => Ok($value),)+
                    Some(other) => Err(Fault::new(&node.span(), format!("unknown value `{other}`; {}", suggest(other, [$($word),+])))),
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

        impl $crate::desc::toml::write::Write for $T {
            fn text(&self) -> String {
                let word = [$(($value, $word)),+].into_iter().find(|(value, _)| value == self);
                $crate::desc::toml::write::string(word.map_or("", |(_, word)| word))
            }
        }
    )+};
}
pub(super) use words;
