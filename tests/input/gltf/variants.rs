//! KHR_materials_variants.

use super::document::{Document, noted};
use radianza::desc::{Error, Options, Scene, gltf};
use serde_json::json;
use std::path::Path;

fn shoe() -> Document {
    let mut d = Document::triangle();
    d.set("/materials", json!([{ "name": "own" }, { "name": "beach" }, { "name": "street" }]));
    d.set(
        "/extensions/KHR_materials_variants/variants",
        json!([{ "name": "sand" }, { "name": "tar" }, { "name": "snow" }]),
    );
    let mappings = json!([{ "material": 1, "variants": [0] }, { "material": 2, "variants": [1] }]);
    d.set(
        "/meshes/0/primitives/0",
        json!({ "attributes": { "POSITION": 0 }, "material": 0,
        "extensions": { "KHR_materials_variants": { "mappings": mappings } } }),
    );
    d
}

fn read(d: &Document, variant: &str) -> Result<Scene, Error> {
    let file = Path::new("test.glb");
    let options = Options { at: None, variant: Some(variant.into()) };
    gltf::parse_with(&d.glb(), file, &|name, place| Err(Error::missing(file, place, name)), &options)
}

#[test]
fn a_variant_chooses_materials() {
    let material = |scene: &Scene| scene.materials[scene.objects[0].material].name.clone();
    let none = shoe().read().unwrap();
    assert_eq!(
        (material(&none).as_str(), &none.variants[..]),
        ("own", &["sand".into(), "tar".into(), "snow".into()][..])
    );
    assert!(noted(&none, "of the variants `sand`, `tar`, `snow` none is chosen"));
    for (variant, expected) in [("sand", "beach"), ("tar", "street"), ("snow", "own"), ("mud", "own")] {
        let scene = read(&shoe(), variant).unwrap();
        assert_eq!(material(&scene), expected, "{variant}");
        assert_eq!(noted(&scene, "none is chosen"), variant == "mud");
    }
}

#[test]
fn variants_that_are_wrong() {
    let fails = |pointer: &str, value, place: &str, says: &str| {
        let e = read(shoe().set(pointer, value), "sand").unwrap_err();
        assert!(e.place == place && e.message.contains(says), "{e}");
    };
    let place = "/meshes/0/primitives/0/extensions/KHR_materials_variants";
    fails(&format!("{place}/mappings/0/material"), json!(9), &format!("{place}/mappings/0/material"), "material 9");
    fails(&format!("{place}/mappings"), json!(9), place, "invalid type");
    let names = "/extensions/KHR_materials_variants/variants";
    fails(names, json!(9), names, "no list");
    fails(&format!("{names}/1"), json!({}), &format!("{names}/1/name"), "expected the name");
}
