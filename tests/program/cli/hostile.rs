//! Input that means harm, or is merely broken: a reason and an exit code, never a panic, and no output.

use super::{folder, radianza, triangle};

/// A scene that renders, in our own format.
const GOOD: &str = r#"
[camera]
position = [0, 0, 3]
target = [0, 0, 0]
view_angle = 40
resolution = [16, 16]

[texture.wood]
type = "image"
file = "wood.png"

[material.table]
type = "diffuse"
reflectance = "wood"

[[shape]]
type = "sphere"
radius = 0.5
material = "table"
"#;

#[test]
fn hostile_toml() {
    let folder = folder();
    image::RgbImage::from_pixel(2, 2, image::Rgb([200, 100, 50])).save(folder.path().join("wood.png")).unwrap();
    std::fs::write(folder.path().join("good.toml"), GOOD).unwrap();
    let (code, _, err) = radianza(folder.path(), &["render", "good.toml", "--spp", "1"]);
    assert_eq!(code, 0, "{err}");
    std::fs::remove_dir_all(folder.path().join("out")).unwrap();

    // Each: what is replaced by what, the exit code, and what the message must name.
    let cases = [
        ("radius = 0.5", "radios = 0.5", 3, ":18"),
        ("radius = 0.5", "radius = nan", 3, ":18"),
        ("radius = 0.5", "radius = -1", 3, ":18"),
        ("radius = 0.5", "radius = 0.5\nfile = 3", 3, ":19"),
        ("resolution = [16, 16]", "resolution = [0, 0]", 3, ":6"),
        ("resolution = [16, 16]", "resolution = [99999999999, 2]", 3, ":6"),
        ("target = [0, 0, 0]", "target = [0, 0, 3]", 3, ":"),
        ("material = \"table\"", "material = \"tabel\"", 3, "table"),
        ("wood.png", "gone.png", 4, "gone.png"),
        ("wood.png", "../wood.png", 4, "../wood.png"),
        ("wood.png", "../../../../../../etc/passwd", 3, "outside"),
        ("wood.png", "bad.toml", 3, "bad.toml"),
        ("[camera]", "[camera", 3, ":2"),
        ("[camera]", "\u{0}", 3, ":2"),
    ];
    for (from, to, expected, named) in cases {
        std::fs::write(folder.path().join("bad.toml"), GOOD.replace(from, to)).unwrap();
        let (code, _, err) = radianza(folder.path(), &["render", "bad.toml"]);
        assert_eq!(code, expected, "{to}: {err}");
        assert!(err.contains("bad.toml") && err.contains(named), "{to}: {err}");
    }
    assert!(!folder.path().join("out").exists());
}

#[test]
fn hostile_environment() {
    let folder = folder();
    triangle(folder.path(), "tri.gltf", "");
    std::fs::write(folder.path().join("text.exr"), "no image").unwrap();
    std::fs::write(folder.path().join("half.hdr"), "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9999 +X 9999\n").unwrap();
    for (name, expected) in [("text.exr", 3), ("half.hdr", 3), ("none.exr", 4), (".", 4)] {
        let (code, _, err) = radianza(folder.path(), &["render", "tri.gltf", "--env", name]);
        assert_eq!(code, expected, "{name}: {err}");
        assert!(err.contains(name), "{err}");
    }
    assert!(!folder.path().join("out").exists());
}

#[test]
fn hostile_gltf() {
    let folder = folder();
    triangle(folder.path(), "good.gltf", "");
    let good = std::fs::read_to_string(folder.path().join("good.gltf")).unwrap();
    let far = "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA";
    let cases = [
        ("half.gltf", good[..good.len() / 2].to_string(), 3),
        ("empty.gltf", String::new(), 3),
        ("range.gltf", good.replace("\"count\": 3", "\"count\": 3000000000"), 3),
        ("short.gltf", good.replace(far, "AACAvwAA"), 3),
        ("node.gltf", good.replace("\"nodes\": [0, 1]", "\"nodes\": [0, 9]"), 3),
        ("missing.gltf", good.replace("data:application/octet-stream;base64,", "gone/"), 4),
        ("outside.gltf", good.replace("data:application/octet-stream;base64,", "../../"), 4),
        ("required.gltf", good.replace("\"scene\": 0", "\"scene\": 0, \"extensionsRequired\": [\"X_magic\"]"), 5),
        ("bin.glb", "glTF\u{2}\0\0\0\u{7f}\0\0\0".into(), 3),
    ];
    for (name, text, expected) in cases {
        std::fs::write(folder.path().join(name), text).unwrap();
        let (code, _, err) = radianza(folder.path(), &["render", name]);
        assert_eq!(code, expected, "{name}: {err}");
        assert!(err.contains(name), "{name}: {err}");
    }
    assert!(!folder.path().join("out").exists());
}
