//! Any bytes, and any change to a document, end in a scene that keeps its promises, or in an error.

use super::compressed::{draco, meshopt};
use super::document::{Document, glb, parse};
use super::hostile::everything;
use super::pose::{at, morphed};
use super::skinned::moving;
use proptest::prelude::*;
use radianza::desc::{Scene, Shape};
use serde_json::{Value, json};

/// What readers promise of a scene.
fn check(scene: &Scene) {
    for shape in &scene.shapes {
        let Shape::Mesh(m) = shape else { panic!("glTF has meshes only") };
        assert!(m.positions.iter().all(|p| p.is_finite()) && !m.indices.is_empty());
        assert!(m.indices.iter().flatten().all(|i| (*i as usize) < m.positions.len()));
        assert!(m.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-3));
        assert!(m.tangents.iter().all(|t| (t.truncate().length() - 1.0).abs() < 1e-3 && t.w.abs() == 1.0));
        let lengths = [m.normals.len(), m.tangents.len(), m.uv[0].len(), m.uv[1].len(), m.colors.len()];
        assert!(lengths.iter().all(|n| *n == 0 || *n == m.positions.len()), "{lengths:?}");
    }
    for o in &scene.objects {
        assert!(o.shape < scene.shapes.len() && o.material < scene.materials.len() && o.to_world.is_finite());
    }
    for c in &scene.cameras {
        assert!(c.to_world.is_finite() && (c.to_world.determinant() - 1.0).abs() < 1e-3);
    }
}

/// All JSON pointers of a document.
fn pointers(value: &Value, at: &str, into: &mut Vec<String>) {
    into.push(at.to_owned());
    match value {
        Value::Array(list) => list.iter().enumerate().for_each(|(i, v)| pointers(v, &format!("{at}/{i}"), into)),
        Value::Object(map) => map.iter().for_each(|(key, v)| pointers(v, &format!("{at}/{key}"), into)),
        _ => {}
    }
}

fn hostile_value() -> impl Strategy<Value = Value> {
    prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::Bool),
        (0u64..8).prop_map(|n| json!(n)),
        any::<u64>().prop_map(|n| json!(n)),
        any::<i32>().prop_map(|n| json!(n)),
        any::<f64>().prop_map(|x| json!(x)),
        prop_oneof![Just(5120), Just(5121), Just(5122), Just(5123), Just(5125), Just(5126)].prop_map(|n| json!(n)),
        "[a-zA-Z0-9_/%:,.]{0,12}".prop_map(Value::String),
        prop_oneof![Just("VEC2"), Just("VEC3"), Just("VEC4"), Just("SCALAR"), Just("MAT4"), Just("BLEND")]
            .prop_map(|s| json!(s)),
        prop::collection::vec(-3i32..9, 0..5).prop_map(|list| json!(list)),
        prop::collection::vec(any::<f32>(), 0..17).prop_map(|list| json!(list)),
        Just(json!({})),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn changed_documents(changes in prop::collection::vec((any::<prop::sample::Index>(), hostile_value()), 1..5)) {
        let mut d = everything();
        d.set("/buffers", json!([{ "byteLength": d.bin.len() }]));
        for (place, value) in changes {
            let mut list = Vec::new();
            pointers(&d.json, "", &mut list);
            *d.json.pointer_mut(place.get::<String>(&list)).unwrap() = value;
        }
        if let Ok(scene) = parse(&glb(&serde_json::to_vec(&d.json).unwrap(), &d.bin)) {
            check(&scene);
        }
    }

    #[test]
    fn changed_bytes(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..20)) {
        let mut file = everything().glb();
        for (place, byte) in changes {
            *place.get_mut(&mut file) = byte;
        }
        if let Ok(scene) = parse(&file) {
            check(&scene);
        }
    }

    /// Skins, morph targets, instances and animations, at a time.
    #[test]
    fn changed_documents_that_move(changes in prop::collection::vec((any::<prop::sample::Index>(), hostile_value()), 1..5)) {
        let mut d = moving();
        d.set("/buffers", json!([{ "byteLength": d.bin.len() }]));
        for (place, value) in changes {
            let mut list = Vec::new();
            pointers(&d.json, "", &mut list);
            *d.json.pointer_mut(place.get::<String>(&list)).unwrap() = value;
        }
        if let Ok(scene) = at(&d, 0.3) {
            check(&scene);
        }
    }

    #[test]
    fn changed_buffers_that_move(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u32>()), 1..12)) {
        for mut d in [moving(), morphed()] {
            for (place, word) in &changes {
                let at = place.index(d.bin.len() / 4) * 4;
                d.bin[at..at + 4].copy_from_slice(&word.to_le_bytes());
            }
            if let Ok(scene) = at(&d, 0.3) {
                check(&scene);
            }
        }
    }

    /// Compressed streams: what is decoded is no longer what was encoded.
    #[test]
    fn changed_streams(which in 0..4usize, changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let mut d = [|| draco(12, 0), || draco(12, 1), || meshopt(12, "TRIANGLES"), || meshopt(12, "INDICES")][which]();
        for (place, byte) in changes {
            *place.get_mut(&mut d.bin) = byte;
        }
        if let Ok(scene) = d.read() {
            check(&scene);
        }
    }

    /// The buffer alone: the document stays valid, the numbers do not.
    #[test]
    fn changed_buffers(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u32>()), 1..12)) {
        let mut d = everything();
        for (place, word) in changes {
            let at = place.index(d.bin.len() / 4) * 4;
            d.bin[at..at + 4].copy_from_slice(&word.to_le_bytes());
        }
        if let Ok(scene) = d.read() {
            check(&scene);
        }
    }

    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..200), binary in any::<bool>()) {
        let file = if binary { [b"glTF\x02\0\0\0", &bytes[..]].concat() } else { bytes };
        prop_assert!(parse(&file).is_err());
    }
}

#[test]
fn the_document_that_is_changed_is_valid() {
    let scene = everything().read().unwrap();
    check(&scene);
    assert_eq!((scene.objects.len(), scene.cameras.len(), scene.lights.len(), scene.images.len()), (1, 1, 1, 1));
    check(&Document::triangle().read().unwrap());
    let scene = at(&moving(), 0.3).unwrap();
    check(&scene);
    assert_eq!((scene.objects.len(), scene.shapes.len()), (3, 2));
}

/// `cargo test --test input -- --ignored seeds`.
#[test]
#[ignore = "writes tests/fuzz/corpus/gltf"]
fn seeds_of_the_fuzzer() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus/gltf");
    std::fs::create_dir_all(&folder).unwrap();
    let write = |name: &str, bytes: Vec<u8>| std::fs::write(folder.join(name), bytes).unwrap();
    write("everything.glb", everything().glb());
    write("triangle.glb", Document::triangle().glb());
    let data = |d: &Document| {
        let encoded = base64::Engine::encode(&base64::prelude::BASE64_STANDARD, &d.bin);
        let mut d = d.clone();
        let uri = format!("data:application/octet-stream;base64,{encoded}");
        d.set("/buffers", json!([{ "byteLength": d.bin.len(), "uri": uri }]));
        d.text()
    };
    write("everything.gltf", data(&everything()));
    let slot = json!({ "index": 0, "texCoord": 5, "extensions": { "KHR_texture_transform": { "scale": [2, 3] } } });
    let mut textured = Document::material(json!({ "pbrMetallicRoughness": { "baseColorTexture": slot } }));
    textured.attribute("TEXCOORD_5", "VEC2", &[[0.0, 0.5]; 3]);
    textured.texture([1, 1], &[[1, 2, 3, 4]]);
    let view = textured.view(include_bytes!("images/etc1s.ktx2"));
    textured.set("/images/1", json!({ "bufferView": view }));
    textured.set("/textures/0/extensions/KHR_texture_basisu", json!({ "source": 1 }));
    textured.set("/asset/extensions/KHR_xmp_json_ld", json!({ "packet": 0 }));
    textured.set("/extensions/KHR_xmp_json_ld/packets", json!([{ "dc:title": "seed" }]));
    write("textured.glb", textured.glb());
}
