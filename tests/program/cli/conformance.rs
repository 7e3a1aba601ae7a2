//! `radianza info --conformance`, and the metadata that images carry.

use super::{folder, header, radianza, triangle};
use serde_json::{Value, json};
use std::path::Path;

/// A triangle of this material, in a document with these additions at its root.
fn asset(folder: &Path, material: Value, root: Value) {
    triangle(folder, "a.gltf", "");
    let path = folder.join("a.gltf");
    let mut document: Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    document["materials"] = json!([material]);
    document["meshes"][0]["primitives"][0]["material"] = json!(0);
    for (key, value) in root.as_object().unwrap() {
        document[key] = value.clone();
    }
    std::fs::write(path, document.to_string()).unwrap();
}

fn report(folder: &Path, file: &str) -> Value {
    let (code, out, err) = radianza(folder, &["info", file, "--conformance", "--json"]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    serde_json::from_str(&out).unwrap()
}

#[test]
fn every_extension_has_a_status_and_every_material_an_albedo() {
    let folder = folder();
    let pbr = json!({ "baseColorFactor": [0.5, 0.25, 1, 1], "metallicFactor": 1, "roughnessFactor": 0 });
    asset(
        folder.path(),
        json!({ "name": "half", "pbrMetallicRoughness": pbr }),
        json!({
            "extensionsUsed": ["KHR_materials_ior", "KHR_materials_unlit", "ACME_cloud", "KHR_xmp_json_ld"],
            "extensionsRequired": ["KHR_materials_ior"],
        }),
    );
    let report = report(folder.path(), "a.gltf");
    let extensions: Vec<_> = report["extensions"]
        .as_array()
        .unwrap()
        .iter()
        .map(|e| {
            assert!(e["meaning"].as_str().unwrap().len() > 5, "{e}");
            (e["name"].as_str().unwrap(), e["status"].as_str().unwrap(), e["required"].as_bool().unwrap())
        })
        .collect();
    assert_eq!(
        extensions,
        [
            ("KHR_materials_ior", "honoured", true),
            ("KHR_materials_unlit", "approximated", false),
            ("ACME_cloud", "ignored", false),
            ("KHR_xmp_json_ld", "carried", false),
        ]
    );

    // A mirror of blue 1 sends on all of the blue, at every angle; Schlick brings the others there only at grazing ones.
    let material = &report["materials"][0];
    assert_eq!(material["name"], "half");
    let [albedo, se] = ["largest_albedo", "standard_error"].map(|key| material[key].as_f64().unwrap());
    assert!((albedo - 1.0).abs() < 1e-3 + 5.0 * se && se < 0.01, "{material}");
    assert!(material["at"].as_str().unwrap().contains("cos "), "{material}");

    // The same for people.
    let (code, out, _) = radianza(folder.path(), &["info", "a.gltf", "--conformance"]);
    assert_eq!(code, 0);
    for words in [
        "honoured     KHR_materials_ior, required: ",
        "ignored      ACME_cloud: unknown",
        " half (metalness 1.00, roughness 0.00",
    ] {
        assert!(out.contains(words), "{words} in\n{out}");
    }
    assert!(radianza(folder.path(), &["info", "a.gltf", "--json"]).0 == 2);
}

/// A diffuse material sends on its reflectance: the report measures, it does not quote.
#[test]
fn other_formats_have_materials_only() {
    let folder = folder();
    let scene = "[material.wall]\ntype = \"diffuse\"\nreflectance = [0.2, 0.6, 0.4]\n[material.lamp]\ntype = \"absorb\"\n\
                 [[shape]]\ntype = \"sphere\"\nmaterial = \"wall\"\n[[shape]]\ntype = \"sphere\"\nmaterial = \"lamp\"\n";
    std::fs::write(folder.path().join("a.toml"), scene).unwrap();
    let report = report(folder.path(), "a.toml");
    assert_eq!(report["extensions"], json!([]));
    let material = |name: &str| {
        let list = report["materials"].as_array().unwrap();
        list.iter().find(|m| m["name"] == name).unwrap_or_else(|| panic!("{name} in {report}")).clone()
    };
    let wall = material("wall")["largest_albedo"].as_f64().unwrap();
    assert!((wall - 0.6).abs() < 2e-3, "{wall}");
    assert_eq!((&material("lamp")["largest_albedo"], &material("lamp")["at"]), (&json!(0.0), &Value::Null));
}

#[test]
fn errors_are_those_of_other_commands() {
    let folder = folder();
    asset(folder.path(), json!({}), json!({ "extensionsRequired": ["ACME_cloud"] }));
    for (file, code) in [("a.gltf", 5), ("none.gltf", 4), ("a.docx", 5)] {
        let (found, out, err) = radianza(folder.path(), &["info", file, "--conformance"]);
        assert!(found == code && out.is_empty() && err.contains(file), "{file}: {found}\n{out}{err}");
    }
}

/// The packet that the asset refers to, and no other, is in the header of the image.
#[test]
fn xmp_packets_reach_the_image() {
    let folder = folder();
    let packet =
        json!({ "@context": { "dc": "http://purl.org/dc/elements/1.1/" }, "dc:creator": { "@list": ["Zoë 🌍"] } });
    let with = |reference: Value| {
        let packets = json!([{ "dc:title": "of a node" }, packet, 7]);
        asset(
            folder.path(),
            json!({}),
            json!({
                "asset": { "version": "2.0", "extensions": { "KHR_xmp_json_ld": reference } },
                "extensionsUsed": ["KHR_xmp_json_ld"],
                "extensions": { "KHR_xmp_json_ld": { "packets": packets } },
            }),
        );
        radianza(folder.path(), &["render", "a.gltf", "--size", "4x4", "--spp", "4", "-o", "a.exr", "--quiet"])
    };
    let (code, _, err) = with(json!({ "packet": 1 }));
    assert_eq!((code, err.as_str()), (0, ""));
    assert_eq!(header(&folder.path().join("a.exr")).metadata, std::slice::from_ref(&packet));
    assert_eq!(report(folder.path(), "a.gltf")["metadata"], json!([packet]));
    for (reference, place, message) in [
        (json!({ "packet": 9 }), "/asset/extensions/KHR_xmp_json_ld/packet", "refers to packet 9; the file has 3"),
        (json!({}), "/asset/extensions/KHR_xmp_json_ld/packet", "expected that of a packet"),
        (json!({ "packet": 2 }), "/extensions/KHR_xmp_json_ld/packets/2", "is a number; expected an object"),
    ] {
        let (code, _, err) = with(reference);
        assert!(code == 3 && err.contains(place) && err.contains(message), "{err}");
    }
}

#[test]
fn long_packets_are_refused() {
    let folder = folder();
    asset(
        folder.path(),
        json!({}),
        json!({
            "asset": { "version": "2.0", "extensions": { "KHR_xmp_json_ld": { "packet": 0 } } },
            "extensions": { "KHR_xmp_json_ld": { "packets": [{ "dc:title": "x".repeat(70_000) }] } },
        }),
    );
    let (code, _, err) = radianza(folder.path(), &["info", "a.gltf"]);
    assert!(code == 3 && err.contains("at most 65536 are carried"), "{err}");
}
