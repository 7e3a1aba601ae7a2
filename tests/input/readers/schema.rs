//! The JSON Schema says what the reader does.

use super::EVERYTHING;
use radianza::desc::ErrorKind;
use radianza::desc::toml::{parse, schema};
use serde_json::Value as Json;
use std::path::Path;

/// Whether `value` agrees with `schema`; the keywords that the schema uses, and a panic at any other.
fn valid(root: &Json, schema: &Json, value: &Json) -> bool {
    let Some(schema) = schema.as_object() else { return schema.as_bool().unwrap() };
    let sub = |s: &Json, v: &Json| valid(root, s, v);
    schema.iter().all(|(keyword, s)| match keyword.as_str() {
        "$schema" | "$defs" | "title" | "description" | "format" | "default" => true,
        "$ref" => {
            let pointer = s.as_str().unwrap().strip_prefix('#').unwrap();
            sub(root.pointer(pointer).unwrap_or_else(|| panic!("{s} leads nowhere")), value)
        }
        "anyOf" => s.as_array().unwrap().iter().any(|s| sub(s, value)),
        "oneOf" => s.as_array().unwrap().iter().filter(|s| sub(s, value)).count() == 1,
        "const" => s == value,
        "enum" => s.as_array().unwrap().contains(value),
        "type" => {
            let is = |t: &Json| match t.as_str().unwrap() {
                "object" => value.is_object(),
                "array" => value.is_array(),
                "string" => value.is_string(),
                "boolean" => value.is_boolean(),
                "number" => value.is_number(),
                "integer" => value.is_i64() || value.is_u64(),
                "null" => value.is_null(),
                other => panic!("type {other}"),
            };
            s.as_array().map_or_else(|| is(s), |any| any.iter().any(is))
        }
        "minimum" => value.as_f64().is_none_or(|x| x >= s.as_f64().unwrap()),
        "maximum" => value.as_f64().is_none_or(|x| x <= s.as_f64().unwrap()),
        "exclusiveMinimum" => value.as_f64().is_none_or(|x| x > s.as_f64().unwrap()),
        "exclusiveMaximum" => value.as_f64().is_none_or(|x| x < s.as_f64().unwrap()),
        "minItems" => value.as_array().is_none_or(|a| a.len() as u64 >= s.as_u64().unwrap()),
        "maxItems" => value.as_array().is_none_or(|a| a.len() as u64 <= s.as_u64().unwrap()),
        "items" => value.as_array().is_none_or(|a| a.iter().all(|v| sub(s, v))),
        "required" => {
            value.as_object().is_none_or(|o| s.as_array().unwrap().iter().all(|k| o.contains_key(k.as_str().unwrap())))
        }
        "properties" => value.as_object().is_none_or(|o| o.iter().all(|(k, v)| s.get(k).is_none_or(|s| sub(s, v)))),
        "additionalProperties" => value.as_object().is_none_or(|o| {
            let known = |k: &str| schema.get("properties").is_some_and(|p| p.get(k).is_some());
            o.iter().all(|(k, v)| known(k) || sub(s, v))
        }),
        other => panic!("the schema uses `{other}`, which this check does not know"),
    })
}

/// A TOML text as JSON, keys with underscores.
fn json(text: &str) -> Json {
    serde_json::to_value(toml::from_str::<toml::Table>(&text.replace("max-depth", "max_depth")).unwrap()).unwrap()
}

#[test]
fn what_is_read_is_valid() {
    let root: Json = serde_json::from_str(&schema()).unwrap();
    assert_eq!(root["$schema"], "https://json-schema.org/draft/2020-12/schema");
    assert!(valid(&root, &root, &json(EVERYTHING)));
    assert!(valid(&root, &root, &json("")));
    assert!(valid(&root, &root, &json("[camera]\nposition = [0, 0, 1]\ntarget = [0, 0, 0]\n[expect]\nradiance = 1")));
}

/// Each scene that is shipped is read, and valid.
#[test]
fn shipped_scenes_are_valid() {
    let root: Json = serde_json::from_str(&schema()).unwrap();
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "toml") {
                let text = std::fs::read_to_string(&path).unwrap();
                match parse(&text, &path) {
                    // Images that are written on demand need not be there.
                    Err(e) if e.kind == ErrorKind::Missing => println!("{e}"),
                    other => drop(other.unwrap_or_else(|e| panic!("{e}"))),
                }
                assert!(valid(&root, &root, &json(&text)), "{}", path.display());
            }
        }
    }
}

/// Each line of the large example misspelt or given a wrong value: the reader refuses what the schema refuses.
#[test]
fn what_is_invalid_is_refused() {
    let root: Json = serde_json::from_str(&schema()).unwrap();
    let lines: Vec<_> = EVERYTHING.lines().collect();
    let (mut invalid, mut refused) = (0, 0);
    for i in 0..lines.len() {
        let Some((key, _)) = lines[i].split_once(" = ") else { continue };
        for changed in [
            format!("{}q", lines[i]).replacen(key, &format!("{key}q"), 1),
            format!("{key} = -7"),
            format!("{key} = true"),
            format!("{key} = []"),
            String::new(),
        ] {
            let mut text = lines.clone();
            text[i] = &changed;
            let text = text.join("\n");
            let Ok(table) = toml::from_str::<toml::Table>(&text.replace("max-depth", "max_depth")) else { continue };
            let ok = valid(&root, &root, &serde_json::to_value(table).unwrap());
            let read = parse(&text, Path::new("scene.toml"));
            invalid += usize::from(!ok);
            refused += usize::from(read.is_err());
            assert!(ok || read.is_err(), "the schema refuses what is read: {changed:?} in place of {:?}", lines[i]);
        }
    }
    // What the reader refuses beyond the schema are contradictions and unknown names, few of these changes.
    assert!(
        invalid > 250 && refused >= invalid && refused - invalid < invalid / 5,
        "{invalid} invalid, {refused} refused"
    );
}

#[test]
fn every_key_is_described() {
    fn walk(json: &Json, missing: &mut Vec<String>) {
        match json {
            Json::Object(o) => {
                if let Some(Json::Object(properties)) = o.get("properties") {
                    for (key, value) in properties {
                        if value.get("description").and_then(Json::as_str).is_none_or(str::is_empty) {
                            missing.push(key.clone());
                        }
                    }
                }
                o.values().for_each(|v| walk(v, missing));
            }
            Json::Array(a) => a.iter().for_each(|v| walk(v, missing)),
            _ => {}
        }
    }
    let mut missing = Vec::new();
    walk(&serde_json::from_str(&schema()).unwrap(), &mut missing);
    assert!(missing.is_empty(), "{missing:?}");
}
