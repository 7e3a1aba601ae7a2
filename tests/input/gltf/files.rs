//! `.gltf` files with buffers and images beside them.

use super::document::{Document, mesh, png};
use radianza::desc::{ErrorKind, gltf};
use serde_json::json;

#[test]
fn buffers_and_images_beside_the_document() {
    let folder = tempfile::tempdir().unwrap();
    let mut d = Document::material(json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }));
    d.set("/images", json!([{ "uri": "sub/my%20image.png" }])).set("/textures", json!([{ "source": 0 }]));
    d.set("/buffers", json!([{ "byteLength": d.bin.len(), "uri": "data.bin" }]));
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    std::fs::write(folder.path().join("sub/my image.png"), png([1, 1], &[[1, 2, 3, 4]])).unwrap();
    std::fs::write(folder.path().join("data.bin"), &d.bin).unwrap();
    let file = folder.path().join("scene.gltf");
    std::fs::write(&file, d.text()).unwrap();
    let scene = gltf::read(&file).unwrap();
    assert_eq!((scene.name.as_str(), scene.source.as_deref()), ("scene", Some(file.as_path())));
    assert_eq!(mesh(&scene, 0).positions.len(), 3);
    assert_eq!(scene.images[0].size, [1, 1]);

    // A short buffer, and a missing one.
    std::fs::write(folder.path().join("data.bin"), &d.bin[1..]).unwrap();
    assert_eq!(gltf::read(&file).unwrap_err().place, "/buffers/0/byteLength");
    std::fs::remove_file(folder.path().join("data.bin")).unwrap();
    let e = gltf::read(&file).unwrap_err();
    assert_eq!((e.place.as_str(), e.kind), ("/buffers/0/uri", ErrorKind::Missing));
    assert_eq!(gltf::read(&folder.path().join("absent.glb")).unwrap_err().kind, ErrorKind::Missing);
}

#[test]
fn nothing_outside_the_folder_is_read() {
    let outer = tempfile::tempdir().unwrap();
    let inner = outer.path().join("inner");
    std::fs::create_dir(&inner).unwrap();
    let d = Document::triangle();
    std::fs::write(outer.path().join("data.bin"), &d.bin).unwrap();
    let absolute = outer.path().join("data.bin").to_string_lossy().into_owned();
    for uri in ["../data.bin", "%2e%2e/data.bin", absolute.as_str()] {
        let mut d = d.clone();
        d.set("/buffers", json!([{ "byteLength": d.bin.len(), "uri": uri }]));
        let file = inner.join("scene.gltf");
        std::fs::write(&file, d.text()).unwrap();
        let e = gltf::read(&file).unwrap_err();
        assert!(e.place == "/buffers/0/uri" && e.message.contains("outside the scene's folder"), "{uri}: {e}");
    }
}
