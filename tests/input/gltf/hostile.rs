//! What is wrong is refused, with the place and the reason.

use super::document::{Document, F32, U8, U16, U32, bytes_of, glb, parse};
use radianza::desc::ErrorKind;
use serde_json::{Value, json};

const POSITION: &str = "/meshes/0/primitives/0/attributes/POSITION";

/// A triangle with indices, a textured material and a camera: something of everything.
pub(crate) fn everything() -> Document {
    let mut d = Document::material(json!({
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } }, "normalTexture": { "index": 0 }, "alphaMode": "MASK",
        "extensions": { "KHR_materials_transmission": { "transmissionFactor": 1 }, "KHR_materials_ior": { "ior": 1.4 } } }));
    d.indices(U16, &[0, 1, 2]);
    d.attribute("NORMAL", "VEC3", &[[0.0, 0.0, 1.0]; 3]);
    d.attribute("COLOR_0", "VEC4", &[[0.5; 4]; 3]);
    d.texture([1, 1], &[[9; 4]]);
    d.set("/cameras", json!([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 1 } }]));
    d.set("/extensions/KHR_lights_punctual/lights", json!([{ "type": "point" }]));
    d.set("/nodes/0/children", json!([1]));
    d.set(
        "/nodes/1",
        json!({ "camera": 0, "rotation": [0, 0, 0, 1], "extensions": { "KHR_lights_punctual": { "light": 0 } } }),
    );
    let (indices, values) = (d.view(&[1]), d.view(&bytes_of(&[1.0, 0.0, 0.5])));
    d.set("/accessors/0/sparse", json!({ "count": 1, "indices": { "bufferView": indices, "componentType": U8 }, "values": { "bufferView": values } }));
    d
}

#[test]
fn a_file_cut_off_anywhere_is_refused() {
    let file = everything().glb();
    assert!(parse(&file).is_ok());
    for length in 0..file.len() {
        assert!(parse(&file[..length]).is_err(), "the first {length} bytes");
    }
    let text = everything().text();
    for length in 0..text.len() {
        assert!(parse(&text[..length]).is_err(), "the first {length} bytes");
    }
}

#[test]
fn containers_that_lie() {
    let file = Document::triangle().glb();
    let with = |at: usize, word: u32| {
        let mut file = file.clone();
        file[at..at + 4].copy_from_slice(&word.to_le_bytes());
        parse(&file).unwrap_err()
    };
    assert_eq!(with(4, 1).kind, ErrorKind::Unsupported);
    for (at, word, says) in [
        (8, 3, "length of 3 bytes"),
        (8, u32::MAX, "length of 4294967295 bytes"),
        (12, u32::MAX, "chunk 0 states 4294967295 bytes"),
        (16, 0x004E_4942, "expected JSON"),
    ] {
        assert!(with(at, word).message.contains(says), "{}", with(at, word));
    }
}

#[test]
fn documents_that_are_none() {
    for (text, place, says) in [
        ("", "1:0", "is not JSON"),
        ("[]", "", "a list; expected an object"),
        ("{", "1:1", "is not JSON"),
        ("{}", "/asset/version", "is missing"),
        (r#"{"asset":{"version":"1.0"}}"#, "/asset/version", "\"1.0\"; expected \"2.0\""),
        (r#"{"asset":{"version":"2.0","minVersion":"2.1"}}"#, "/asset/minVersion", "2.1"),
        (r#"{"asset":{"version":"2.0"},"nodes":{}}"#, "/nodes", "an object; expected a list"),
        (r#"{"asset":{"version":"2.0"},"nodes":[{},{"mesh":-1}]}"#, "/nodes/1", "-1"),
        (r#"{"asset":{"version":"2.0"},"extensionsRequired":7}"#, "/extensionsRequired", "a number; expected a list"),
        (r#"{"asset":{"version":"2.0"},"extensionsUsed":["a",7]}"#, "/extensionsUsed/1", "a number; expected a name"),
        (r#"{"asset":{"version":"2.0"},"scene":4}"#, "/scene", "refers to scene 4; the file has 0"),
    ] {
        let e = parse(text.as_bytes()).unwrap_err();
        assert!(e.place == place && e.message.contains(says), "{text}: {e}");
    }
    let nested = format!(r#"{{"asset":{{"version":"2.0"}},"extras":{}1{}}}"#, "[".repeat(100_000), "]".repeat(100_000));
    assert!(parse(nested.as_bytes()).is_err());
    let empty = parse(br#"{"asset":{"version":"2.0"}}"#).unwrap();
    assert!(empty.objects.is_empty());
}

#[test]
fn required_extensions_that_are_not_honoured_are_named() {
    let mut d = Document::triangle();
    d.set("/extensionsUsed", json!(["MSFT_texture_dds", "EXT_of_nobody", "KHR_xmp_json_ld", "KHR_materials_ior"]));
    let scene = d.read().unwrap();
    assert_eq!(scene.notes.len(), 2, "{:?}", scene.notes);
    assert!(scene.notes[0].starts_with("`MSFT_texture_dds` is not honoured yet (images in DDS)"));
    let uses: Vec<_> = scene.extensions.iter().map(|u| (&*u.name, u.required, u.word())).collect();
    assert_eq!(uses[..2], [("MSFT_texture_dds", false, "ignored"), ("EXT_of_nobody", false, "ignored")]);
    assert_eq!(uses[2..], [("KHR_xmp_json_ld", false, "carried"), ("KHR_materials_ior", false, "honoured")]);
    d.set("/extensionsRequired", json!(["KHR_materials_ior", "MSFT_texture_dds", "EXT_texture_avif"]));
    d.fails("/extensionsRequired/1", "`MSFT_texture_dds`, `EXT_texture_avif`");
    assert_eq!(d.read().unwrap_err().kind, ErrorKind::Unsupported);
}

#[test]
fn indices_out_of_range() {
    let mut d = Document::triangle();
    d.indices(U8, &[0, 1, 3]);
    d.fails("/meshes/0/primitives/0/indices", "element 2 is 3; expected an index below 3");
    for (pointer, place, says) in [
        ("/meshes/0/primitives/0/indices", "/meshes/0/primitives/0/indices", "accessor 99; the file has 2"),
        (POSITION, POSITION, "accessor 99"),
        ("/accessors/0/bufferView", "/accessors/0/bufferView", "buffer view 99"),
        ("/bufferViews/0/buffer", "/bufferViews/0/buffer", "buffer 99"),
        ("/nodes/0/mesh", "/nodes/0/mesh", "mesh 99"),
        ("/nodes/0/camera", "/nodes/0/camera", "camera 99"),
        ("/nodes/0/extensions/KHR_lights_punctual/light", "/nodes/0/extensions/KHR_lights_punctual/light", "light 99"),
        ("/scenes/0/nodes/0", "/scenes/0/nodes/0", "node 99"),
        ("/scene", "/scene", "scene 99"),
        ("/meshes/0/primitives/0/material", "/meshes/0/primitives/0/material", "material 99"),
    ] {
        let mut d = Document::triangle();
        d.indices(U8, &[0, 1, 2]);
        d.set(pointer, json!(99)).fails(place, says);
    }
    Document::triangle().set("/nodes/0/children", json!([99])).fails("/nodes/0/children/0", "node 99");
}

#[test]
fn numbers_that_are_none() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        Document::mesh(&[[0.0; 3], [1.0, bad, 0.0], [0.0, 1.0, 0.0]]).fails(POSITION, "element 1 is [1.0, ");
        for (name, place) in [("NORMAL", 3), ("COLOR_0", 3)] {
            let mut d = Document::triangle();
            d.attribute(name, "VEC3", &[[0.0; 3], [0.0; 3], [bad; 3]]);
            d.fails(&format!("/meshes/0/primitives/0/attributes/{name}"), &format!("element {}", place - 1));
        }
    }
    // 1e39 is valid JSON, and infinite as f32.
    for pointer in ["/nodes/0/translation", "/nodes/0/scale"] {
        Document::triangle().set(pointer, json!([1e39, 0, 0])).fails(pointer, "not finite");
    }
    for (pointer, value) in [
        ("/materials/0/pbrMetallicRoughness/metallicFactor", json!(1e39)),
        ("/materials/0/emissiveFactor", json!([1e39, 0, 0])),
        ("/materials/0/normalTexture/scale", json!(-1e39)),
        ("/materials/0/alphaCutoff", json!(1e39)),
        ("/materials/0/extensions/KHR_materials_ior/ior", json!(1e39)),
    ] {
        everything().set(pointer, value).fails(pointer, "finite");
    }
    let transform = "/materials/0/normalTexture/extensions/KHR_texture_transform";
    everything()
        .set(transform, json!({ "scale": [1e39, 1] }))
        .fails("/materials/0/normalTexture/extensions/KHR_texture_transform", "not finite");
    everything().set(transform, json!({ "scale": 1 })).fails(transform, "invalid type");
}

#[test]
fn accessors_that_do_not_fit() {
    let with = |changes: &[(&str, Value)], place: &str, says: &str| {
        let mut d = Document::triangle();
        changes.iter().for_each(|(pointer, value)| {
            d.set(pointer, value.clone());
        });
        d.fails(place, says);
    };
    with(&[("/accessors/0/count", json!(0))], "/accessors/0/count", "is 0; expected at least 1");
    with(&[("/accessors/0/count", json!(u64::MAX))], "/accessors/0/count", "18446744073709551615");
    with(&[("/accessors/0/count", json!(1u64 << 60))], "/accessors/0", "its view has 36 bytes");
    with(&[("/accessors/0/count", json!(4))], "/accessors/0", "has 4 elements of 12 bytes");
    with(&[("/accessors/0/count", json!(-3))], "/accessors/0", "-3");
    with(&[("/accessors/0/byteOffset", json!(4))], "/accessors/0", "from byte 4; its view has 36 bytes");
    with(&[("/accessors/0/byteOffset", json!(u64::MAX))], "/accessors/0", "its view has 36 bytes");
    with(&[("/accessors/0/componentType", json!(U16))], POSITION, "VEC3 of u16; expected VEC3 of f32");
    with(&[("/accessors/0/componentType", json!(7))], POSITION, "an unknown componentType");
    with(&[("/accessors/0/type", json!("VEC4"))], POSITION, "VEC4 of f32; expected VEC3 of f32");
    with(&[("/accessors/0/type", json!("MAT9"))], POSITION, "an unknown type");
    with(&[("/accessors/0/normalized", json!(true))], POSITION, "normalised f32");
    with(
        &[("/bufferViews/0/byteStride", json!(8))],
        "/accessors/0",
        "elements of 12 bytes; its view's byteStride is 8",
    );
    with(&[("/bufferViews/0/byteStride", json!(0))], "/bufferViews/0/byteStride", "expected 4 to 252");
    with(&[("/bufferViews/0/byteStride", json!(-12))], "/bufferViews/0", "-12");
    with(&[("/bufferViews/0/byteStride", json!(16))], "/accessors/0", "16 apart");
    with(&[("/bufferViews/0/byteOffset", json!(4))], "/bufferViews/0", "36 bytes from byte 4; its buffer has 36");
    with(&[("/bufferViews/0/byteLength", json!(u64::MAX))], "/bufferViews/0", "18446744073709551615");
    with(&[("/buffers", json!([{ "byteLength": 999 }]))], "/buffers/0/byteLength", "is 999; there are 36 bytes");
    with(
        &[("/buffers", json!([{ "byteLength": 36, "uri": "data:;base64,AAAA" }]))],
        "/buffers/0/byteLength",
        "there are 3 bytes",
    );
    with(&[("/buffers", json!([{ "byteLength": 36, "uri": "data:;base64,%%" }]))], "/buffers/0/uri", "not base64");
    with(
        &[("/buffers", json!([{ "byteLength": 1 }, { "byteLength": 36 }])), ("/bufferViews/0/buffer", json!(1))],
        "/buffers/1/uri",
        "only buffer 0 can be the BIN chunk",
    );
    Document::triangle().remove("/accessors/0/bufferView").fails("/accessors/0", "neither bufferView nor sparse");
    let e = parse(&Document::triangle().text()).unwrap_err();
    assert!(e.place == "/buffers/0/uri" && e.message.contains("no BIN chunk"), "{e}");
}

#[test]
fn attributes_that_do_not_match() {
    let mut d = Document::triangle();
    d.attribute("NORMAL", "VEC3", &[[0.0, 0.0, 1.0]; 2]);
    d.fails("/meshes/0/primitives/0/attributes/NORMAL", "has 2 elements; expected 3");
    let mut d = Document::triangle();
    let signed = d.accessor(5122, "SCALAR", 3, &[0; 6]);
    d.set("/meshes/0/primitives/0/indices", json!(signed)).fails("/meshes/0/primitives/0/indices", "SCALAR of i16");
    let float = d.accessor(F32, "SCALAR", 3, &[0; 12]);
    d.set("/meshes/0/primitives/0/indices", json!(float)).fails("/meshes/0/primitives/0/indices", "SCALAR of f32");
    let pairs = d.accessor(U32, "VEC2", 3, &[0; 24]);
    d.set("/meshes/0/primitives/0/indices", json!(pairs)).fails("/meshes/0/primitives/0/indices", "VEC2 of u32");
}

#[test]
fn sparse_accessors_that_do_not_fit() {
    let place = "/accessors/0/sparse";
    for (key, value, at, says) in [
        ("count", json!(0), "/count", "is 0"),
        ("count", json!(2), "/indices", "has 2 elements of 1 bytes"),
        ("count", json!(u64::MAX), "/count", "18446744073709551615"),
        ("indices/bufferView", json!(99), "/indices/bufferView", "buffer view 99"),
        ("indices/componentType", json!(F32), "/indices/componentType", "expected 5121"),
        ("indices/byteOffset", json!(9), "/indices", "from byte 9"),
        ("values/bufferView", json!(99), "/values/bufferView", "buffer view 99"),
        ("values/byteOffset", json!(4), "/values", "from byte 4"),
    ] {
        everything().set(&format!("{place}/{key}"), value).fails(&format!("{place}{at}"), says);
    }
    let mut d = everything();
    let view = d.view(&[3]);
    d.set("/accessors/0/sparse/indices/bufferView", json!(view)).fails("/accessors/0/sparse/indices", "element 0 is 3");
}

#[test]
fn few_bytes_cannot_ask_for_much_memory() {
    // Zeros need no buffer: the count alone asks for 48 GB.
    let mut d = everything();
    d.remove("/accessors/0/bufferView").set("/accessors/0/count", json!(4_000_000_000u64));
    d.fails("/accessors/0", "too many for a file of this size");

    // Many primitives over the same data, each with a material of its own and other indices.
    let mut d = Document::mesh(&vec![[0.0; 3]; 100_000]);
    let mut primitives = Vec::new();
    for i in 0..4000 {
        let accessor = d.accessor(U8, "SCALAR", 1, &[0]);
        primitives.push(json!({ "attributes": { "POSITION": 0 }, "indices": accessor, "material": null, "extras": i }));
    }
    d.set("/meshes/0/primitives", json!(primitives));
    let e = d.read().unwrap_err();
    assert!(e.message.contains("too many for a file of this size"), "{e}");

    // Nodes × primitives.
    let mut d = Document::triangle();
    let primitive = d.json["meshes"][0]["primitives"][0].clone();
    d.set("/meshes/0/primitives", json!(vec![primitive; 3000]));
    d.set("/nodes", json!(vec![json!({ "mesh": 0 }); 3000]));
    d.set("/scenes/0/nodes", json!((0..3000).collect::<Vec<_>>()));
    let e = d.read().unwrap_err();
    assert!(e.message.contains("too many for a file of this size"), "{e}");
}

#[test]
fn few_bytes_cannot_ask_for_many_lights() {
    // A thousand triangles, each a light, at two thousand places.
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mut d = Document::mesh(&corners.repeat(1000));
    let places = d.accessor(F32, "VEC3", 2000, &vec![0; 24_000]);
    let instances = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } });
    d.set("/nodes/0", json!({ "mesh": 0, "extensions": instances }));
    d.set("/materials", json!([{ "emissiveFactor": [0, 0, 0] }])).set("/meshes/0/primitives/0/material", json!(0));
    assert_eq!(d.read().unwrap().objects.len(), 2000, "what does not emit is no light");
    d.set("/materials/0/emissiveFactor", json!([1, 1, 1]));
    d.fails("/nodes/0", "1999000 × 512 bytes are too many for a file of this size");

    // Once is no multiplication.
    d.remove("/nodes/0/extensions");
    assert_eq!(d.read().unwrap().objects.len(), 1);
}

#[test]
fn few_bytes_cannot_ask_for_many_copies_of_a_file() {
    // One file by many names is read once, and grants its growth once.
    let mut d = Document::triangle();
    let names = ["data.bin", "./data.bin", "a/../data.bin", "%64ata.bin"];
    let length = d.bin.len();
    d.set("/buffers", json!(names.map(|uri| json!({ "byteLength": length, "uri": uri }))));
    let views = (0..names.len()).map(|i| json!({ "buffer": i, "byteLength": length })).collect::<Vec<_>>();
    d.set("/bufferViews", json!(views));
    for i in 0..names.len() {
        let accessor = json!({ "bufferView": i, "componentType": F32, "type": "VEC3", "count": 3 });
        d.set(&format!("/accessors/{i}"), accessor);
        d.set(&format!("/meshes/0/primitives/{i}/attributes/POSITION"), json!(i));
    }
    let read = std::cell::Cell::new(0);
    let resolve = |name: &str, _: &str| {
        assert_eq!(name, "data.bin");
        read.set(read.get() + 1);
        Ok(d.bin.clone())
    };
    let scene = radianza::desc::gltf::parse(&d.text(), std::path::Path::new("a.gltf"), &resolve).unwrap();
    assert_eq!((scene.objects.len(), read.get()), (names.len(), 1));

    // A camera with a long name at many nodes.
    let nodes = 4000;
    let camera =
        json!({ "type": "perspective", "perspective": { "yfov": 1, "znear": 1 }, "name": "x".repeat(1 << 20) });
    let mut d = Document::triangle();
    d.set("/cameras", json!([camera])).set("/nodes", json!(vec![json!({ "camera": 0 }); nodes]));
    d.set("/scenes/0/nodes", json!((0..nodes).collect::<Vec<_>>()));
    let e = d.read().unwrap_err();
    assert!(e.place.starts_with("/nodes/") && e.message.contains("too many for a file of this size"), "{e}");
}

#[test]
fn few_bytes_cannot_ask_for_many_names_or_weights() {
    // A long name for each of many instances.
    let mut d = Document::triangle();
    let places = d.accessor(F32, "VEC3", 5000, &vec![0; 60_000]);
    let instances = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } });
    d.set("/nodes/0", json!({ "mesh": 0, "extensions": instances, "name": "x".repeat(1 << 20) }));
    d.fails("/nodes/0", "too many for a file of this size");

    // Many nodes that share a long list of weights, and many channels that give each of them its own.
    let (nodes, weights) = (4000, 100_000);
    let mut d = Document::triangle();
    d.set("/meshes/0/weights", json!(vec![0; weights]));
    d.set("/nodes", json!(vec![json!({ "mesh": 0 }); nodes]));
    d.set("/scenes/0/nodes", json!((0..nodes).collect::<Vec<_>>()));
    let e = d.read().unwrap_err();
    assert!(e.message.contains("too many for a file of this size"), "{e}");
    let (times, values) = (d.accessor(F32, "SCALAR", 1, &[0; 4]), d.accessor(F32, "SCALAR", 1, &[0; 4]));
    let channel = |node: usize| {
        let pointer = json!({ "KHR_animation_pointer": { "pointer": format!("/nodes/{node}/weights/0") } });
        json!({ "sampler": 0, "target": { "path": "pointer", "extensions": pointer } })
    };
    let channels: Vec<Value> = (0..nodes).map(channel).collect();
    d.set("/animations", json!([{ "channels": channels, "samplers": [{ "input": times, "output": values }] }]));
    let e = super::pose::at(&d, 0.0).unwrap_err();
    assert!(e.place.starts_with("/animations/0/channels/") && e.message.contains("too many for a file"), "{e}");
}

#[test]
fn nodes_that_make_no_tree() {
    Document::triangle()
        .set("/nodes/0/children", json!([0]))
        .fails("/nodes/0/children/0", "node 0, which is reached twice");
    let mut d = Document::triangle();
    d.set("/nodes", json!([{ "children": [1] }, { "children": [2] }, { "children": [0] }]));
    d.fails("/nodes/2/children/0", "node 0, which is reached twice");
    d.set("/nodes", json!([{ "children": [1, 2] }, { "children": [2] }, {}]))
        .fails("/nodes/0/children/1", "reached twice");
    d.set("/nodes", json!([{}])).set("/scenes/0/nodes", json!([0, 0])).fails("/scenes/0/nodes/1", "reached twice");
}

#[test]
fn matrices_that_are_not_affine() {
    let mut m = glam_identity();
    m[3] = 0.5;
    Document::triangle().set("/nodes/0/matrix", json!(m)).fails("/nodes/0/matrix", "not affine");
    let mut m = glam_identity();
    m[12] = 1e39;
    Document::triangle().set("/nodes/0/matrix", json!(m)).fails("/nodes/0/matrix", "not affine");
    m[12] = 2.0;
    let mut d = Document::triangle();
    d.set("/nodes/0/matrix", json!(m))
        .set("/nodes/0/scale", json!([2, 2, 2]))
        .fails("/nodes/0/matrix", "stands beside");
    Document::triangle().set("/nodes/0/matrix", json!([1, 2])).fails("/nodes/0", "invalid length 2");
    Document::triangle()
        .set("/nodes/0/rotation", json!([0, 0, 0, 0]))
        .fails("/nodes/0/rotation", "expected a unit quaternion");
    let mut d = Document::triangle();
    d.set("/nodes", json!([{ "scale": [3e38, 1, 1], "children": [1] }, { "scale": [3e38, 1, 1], "mesh": 0 }]));
    d.fails("/nodes/1", "not finite");
}

fn glam_identity() -> [f64; 16] {
    std::array::from_fn(|i| if i % 5 == 0 { 1.0 } else { 0.0 })
}

#[test]
fn cameras_and_lights_that_are_wrong() {
    for (key, value, at, says) in [
        ("type", json!("fisheye"), "/cameras/0/type", "expected \"perspective\""),
        ("type", json!("orthographic"), "/cameras/0", "lacks the object that its type names"),
        ("perspective/yfov", json!(0), "/cameras/0/perspective/yfov", "positive"),
        ("perspective/yfov", json!(3.2), "/cameras/0/perspective/yfov", "less than π"),
        ("perspective/aspectRatio", json!(-1), "/cameras/0/perspective/aspectRatio", "positive"),
    ] {
        everything().set(&format!("/cameras/0/{key}"), value).fails(at, says);
    }
    let light = "/extensions/KHR_lights_punctual/lights/0";
    everything().set(&format!("{light}/type"), json!("laser")).fails(&format!("{light}/type"), "expected \"point\"");
    everything().set(&format!("{light}/intensity"), json!(1e39)).fails(&format!("{light}/intensity"), "finite");
}

#[test]
fn bytes_after_the_buffer_do_not_matter() {
    let d = Document::triangle();
    assert!(parse(&glb(&d.text(), &[&d.bin[..], &[0; 3]].concat())).is_ok());
}
