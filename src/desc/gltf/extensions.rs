//! Which extensions are honoured, and what happens to the others.

use super::notes::Notes;
use crate::desc::Error;
use serde_json::Value;
use std::path::Path;

/// Extensions whose meaning reaches the picture.
pub const HONOURED: [&str; 10] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_texture_transform",
];

/// Extensions that say nothing about the picture.
const METADATA: [&str; 2] = ["KHR_xmp", "KHR_xmp_json_ld"];

/// Refuses a document that requires what is not honoured, and notes what it only uses.
pub(super) fn check(document: &Value, file: &Path, notes: &mut Notes) -> Result<(), Error> {
    let required = names(document, "extensionsRequired", file)?;
    let refused: Vec<_> = required.iter().enumerate().filter(|(_, name)| !known(name)).collect();
    if let Some((first, _)) = refused.first() {
        let list: Vec<_> = refused.iter().map(|(_, name)| format!("`{name}`")).collect();
        let message = format!("requires {}, which is not honoured yet", list.join(", "));
        return Err(Error::unsupported(file, format!("/extensionsRequired/{first}"), message));
    }
    for name in names(document, "extensionsUsed", file)?.into_iter().filter(|name| !known(name)) {
        notes.say(format!("`{name}` is not honoured yet; the file is read as if it were absent"));
    }
    Ok(())
}

fn known(name: &str) -> bool {
    HONOURED.contains(&name) || METADATA.contains(&name)
}

/// The list of strings under `key`; empty where the document has none.
fn names<'a>(document: &'a Value, key: &str, file: &Path) -> Result<Vec<&'a str>, Error> {
    let Some(list) = document.get(key) else { return Ok(Vec::new()) };
    let Value::Array(list) = list else {
        return Err(Error::invalid(file, format!("/{key}"), format!("is {}; expected a list of names", kind(list))));
    };
    let name = |(i, value): (usize, &'a Value)| {
        let wrong = || Error::invalid(file, format!("/{key}/{i}"), format!("is {}; expected a name", kind(value)));
        value.as_str().ok_or_else(wrong)
    };
    list.iter().enumerate().map(name).collect()
}

/// What sort of JSON value it is, for messages.
pub(super) fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "a truth value",
        Value::Number(_) => "a number",
        Value::String(_) => "a string",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}
