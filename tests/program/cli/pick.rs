//! `--at`, `--frame`, `--variant`.

use super::{folder, header, radianza, triangle};
use std::fs;
use std::path::Path;

/// The triangle turns away from the camera in one second, and has two variants.
fn turning(folder: &Path) {
    triangle(folder, "turn.gltf", "");
    let floats: Vec<u8> =
        [0f32, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    fs::write(folder.join("turn.bin"), floats).unwrap();
    let path = folder.join("turn.gltf");
    let mut json: serde_json::Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
    let push = |json: &mut serde_json::Value, list: &str, value| json[list].as_array_mut().unwrap().push(value);
    push(&mut json, "buffers", serde_json::json!({ "byteLength": 40, "uri": "turn.bin" }));
    push(&mut json, "bufferViews", serde_json::json!({ "buffer": 1, "byteLength": 40 }));
    for (offset, count, kind) in [(0, 2, "SCALAR"), (8, 2, "VEC4")] {
        let accessor = serde_json::json!({ "bufferView": 1, "byteOffset": offset, "componentType": 5126, "count": count, "type": kind, "max": [1] });
        push(&mut json, "accessors", accessor);
    }
    json["animations"] = serde_json::json!([{ "channels": [{ "sampler": 0, "target": { "node": 0, "path": "rotation" } }],
        "samplers": [{ "input": 1, "output": 2 }] }]);
    json["materials"] = serde_json::json!([{ "name": "dark" }, { "name": "bright" }]);
    json["extensions"] =
        serde_json::json!({ "KHR_materials_variants": { "variants": [{ "name": "day" }, { "name": "night" }] } });
    json["meshes"][0]["primitives"][0]["extensions"] = serde_json::json!({ "KHR_materials_variants": {
        "mappings": [{ "material": 0, "variants": [1] }, { "material": 1, "variants": [0] }] } });
    fs::write(path, json.to_string()).unwrap();
}

#[test]
fn a_time_and_a_variant_reach_scene_and_header() {
    let folder = folder();
    turning(folder.path());
    let render = |more: &[&str]| {
        let basic = ["render", "turn.gltf", "--size", "8x8", "--spp", "4", "-q", "-o", "a.exr"];
        let (code, _, err) = radianza(folder.path(), &[&basic[..], more].concat());
        assert_eq!((code, err.as_str()), (0, ""));
        header(&folder.path().join("a.exr"))
    };
    let chosen = |h: radianza::film::Header| (h.at, h.variant);
    assert_eq!(chosen(render(&[])), (None, None));
    assert_eq!(chosen(render(&["--at", "0.5", "--variant", "day"])), (Some(0.5), Some("day".into())));
    assert_eq!(chosen(render(&["--frame", "12"])), (Some(0.5), None));
    assert_eq!(chosen(render(&["--frame", "12", "--fps", "48"])), (Some(0.25), None));

    // A quarter turn about x after half a second: what was upright lies flat, in z.
    let info = |more: &[&str]| {
        let (code, out, _) = radianza(folder.path(), &[&["info", "turn.gltf"], more].concat());
        assert_eq!(code, 0);
        out
    };
    let rest = info(&[]);
    assert!(rest.contains("[-1, -1, 0] to [1, 1, 0]"), "{rest}");
    assert!(rest.contains("time       the pose that the nodes state, of animations of 1 s"), "{rest}");
    assert!(rest.contains("variant    none, of 2: day, night"), "{rest}");
    let half = info(&["--at", "0.5", "--variant", "night"]);
    assert!(half.contains("variant    `night`") && half.contains("materials  1: dark"), "{half}");
    assert!(!half.contains("[-1, -1, 0] to [1, 1, 0]"), "{half}");
}

#[test]
fn they_hold_for_the_files_that_a_scene_places() {
    let folder = folder();
    turning(folder.path());
    triangle(folder.path(), "still.gltf", "");
    let shape = |file: &str| format!("[[shape]]\ntype = \"file\"\nfile = \"{file}\"\n");
    fs::write(folder.path().join("both.toml"), shape("turn.gltf") + &shape("still.gltf")).unwrap();
    let (code, out, err) = radianza(folder.path(), &["info", "both.toml", "--at", "0.5", "--variant", "day"]);
    assert!(code == 0 && out.contains("bright") && !out.contains("dark"), "{out}{err}");
    assert!(out.contains("time       0.5 s, of animations of 1 s") && out.contains("variant    `day`"), "{out}");
    let (code, _, err) = radianza(folder.path(), &["info", "both.toml", "--variant", "dusk"]);
    assert!(code == 2 && err.contains("it has `day`, `night`"), "{err}");
}

#[test]
fn what_a_scene_lacks_is_2() {
    let folder = folder();
    turning(folder.path());
    triangle(folder.path(), "still.gltf", "");
    let wrong = |arguments: &[&str], says: &str| {
        let (code, _, err) = radianza(folder.path(), arguments);
        assert!(code == 2 && err.contains(says), "{arguments:?}: {code}\n{err}");
    };
    wrong(&["info", "turn.gltf", "--variant", "dusk"], "turn.gltf: has no variant `dusk`; it has `day`, `night`");
    wrong(&["render", "still.gltf", "--variant", "dusk"], "has no variant `dusk`; it has none");
    wrong(&["verify", "still.gltf", "--variant", "dusk"], "it has none");
    wrong(&["verify", "--list", "--at", "1"], "needs a scene");
    wrong(&["info", "turn.gltf", "--at", "nan"], "no finite number");
    wrong(&["info", "turn.gltf", "--at", "1", "--frame", "1"], "cannot be used with");
    wrong(&["info", "turn.gltf", "--frame", "1", "--fps", "0"], "no positive number");
    let (code, out, _) = radianza(folder.path(), &["info", "still.gltf", "--at", "1"]);
    assert!(code == 0 && out.contains("nothing moves in this scene"), "{out}");
}
