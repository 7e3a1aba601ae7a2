//! The JSON Schema of the format, from the declarations that read it.

use super::keys::Keys;
use super::scene::SceneFile;
use serde_json::{Map, Value as Json, json};

/// The definitions collected so far.
#[derive(Debug, Default)]
pub(super) struct Defs(Map<String, Json>);

impl Defs {
    /// A reference to the definition of `K`, made at its first use.
    pub(super) fn reference<K: Keys>(&mut self) -> Json {
        if !self.0.contains_key(K::NAME) {
            // Held before it is filled, so that a recursive definition ends.
            self.0.insert(K::NAME.into(), Json::Null);
            let schema = object::<K>(self);
            self.0.insert(K::NAME.into(), schema);
        }
        json!({ "$ref": format!("#/$defs/{}", K::NAME) })
    }
}

/// The keys of a table, of one `type`.
#[derive(Clone, Debug, Default)]
pub(super) struct Alternative {
    about: Option<&'static str>,
    properties: Map<String, Json>,
    required: Vec<&'static str>,
}

impl Alternative {
    /// Another key.
    pub(super) fn add(&mut self, key: &'static str, about: &str, required: bool, mut schema: Json) {
        if let Some(object) = schema.as_object_mut() {
            object.insert("description".into(), text(about).into());
        }
        self.properties.insert(key.into(), schema);
        if required {
            self.required.push(key);
        }
    }

    /// This, where `type` is `word`.
    pub(super) fn tagged(mut self, word: &'static str, about: &'static str, required: bool) -> Self {
        self.add("type", about, required, json!({ "const": word }));
        self.about = Some(about);
        self
    }

    fn schema(&self, about: &str) -> Json {
        let about = text(self.about.unwrap_or(about));
        json!({
            "description": about, "type": "object", "properties": self.properties, "required": self.required,
            "additionalProperties": false,
        })
    }
}

/// Every pair of alternatives in one.
pub(super) fn product(a: &[Alternative], b: &[Alternative]) -> Vec<Alternative> {
    let join = |a: &Alternative, b: &Alternative| {
        let mut joint = a.clone();
        joint.about = a.about.or(b.about);
        joint.properties.extend(b.properties.clone());
        joint.required.extend(&b.required);
        joint
    };
    a.iter().flat_map(|a| b.iter().map(move |b| join(a, b))).collect()
}

/// The schema of a table.
fn object<K: Keys>(defs: &mut Defs) -> Json {
    match K::alternatives(defs).as_slice() {
        [one] => one.schema(K::ABOUT),
        many => {
            let all: Vec<_> = many.iter().map(|a| a.schema(K::ABOUT)).collect();
            json!({ "description": text(K::ABOUT), "oneOf": all })
        }
    }
}

/// A doc comment as one line of text.
fn text(doc: &str) -> String {
    doc.split_whitespace().collect::<Vec<_>>().join(" ").replace("\\[", "[").replace("\\]", "]")
}

/// The JSON Schema (draft 2020-12) of the scene format, for editors to complete and check it.
pub fn schema() -> String {
    let mut defs = Defs::default();
    let mut schema = object::<SceneFile>(&mut defs);
    if let Some(root) = schema.as_object_mut() {
        root.insert("$schema".into(), "https://json-schema.org/draft/2020-12/schema".into());
        root.insert("title".into(), "Radianza scene".into());
        root.insert("$defs".into(), Json::Object(defs.0));
    }
    format!("{schema:#}")
}
