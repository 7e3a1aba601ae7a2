//! OBJ and PLY.

use super::{assets, folder, png};
use radianza::desc::*;
use radianza::glam::{Vec2, Vec3, Vec4};
use std::path::Path;

fn obj(text: &str) -> Result<Scene, Error> {
    radianza::desc::obj::parse(text, Path::new("a.obj"))
}

fn ply(bytes: &[u8]) -> Result<Scene, Error> {
    radianza::desc::ply::parse(bytes, Path::new("a.ply"))
}

fn mesh(scene: &Scene, object: usize) -> &Mesh {
    match &scene.shapes[scene.objects[object].shape] {
        Shape::Mesh(mesh) => mesh,
        other => panic!("{other:?}"),
    }
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn obj_polygons_are_fans() {
    let s = obj(&format!("# a square\n{SQUARE}f 1 2 3 4\nf -4 -3 \\\n-2\n")).unwrap();
    assert_eq!(mesh(&s, 0).indices, [[0, 1, 2], [0, 2, 3], [0, 1, 2]]);
    assert_eq!(mesh(&s, 0).positions.len(), 4);
    assert!(mesh(&s, 0).normals.is_empty() && mesh(&s, 0).uv[0].is_empty() && mesh(&s, 0).colors.is_empty());
    assert_eq!(s.materials[0].name, "default");
    assert!(s.notes.iter().any(|n| n.contains("without a material are grey")), "{:?}", s.notes);
}

#[test]
fn obj_attributes() {
    let s =
        obj(&format!("{SQUARE}vt 0 0\nvt 0.5 0.25\nvn 0 0 3\nf 1/1/1 2/2/1 3/1/1\nf 1//1 3//1 4//1\nl 1 2\n")).unwrap();
    let m = mesh(&s, 0);
    assert_eq!(m.positions.len(), 6, "corners with other attributes are other vertices");
    assert_eq!((m.uv[0][0], m.uv[0][1]), (Vec2::new(0.0, 1.0), Vec2::new(0.5, 0.75)));
    assert!(m.normals.iter().all(|n| *n == Vec3::Z));
    assert!(s.notes.iter().any(|n| n.contains("1 lines, points or curves")), "{:?}", s.notes);

    // Where only some corners have normals, the others are flat.
    let s = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1 2 4\nf 1 3 4\n").unwrap();
    let m = mesh(&s, 0);
    assert_eq!(m.normals[m.indices[1][0] as usize], Vec3::NEG_Y);
    assert_eq!(m.normals[m.indices[2][0] as usize], Vec3::X);

    let s = obj("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n").unwrap();
    assert_eq!(mesh(&s, 0).colors, [Vec4::new(1., 0., 0., 1.), Vec4::new(0., 1., 0., 1.), Vec4::new(0., 0., 1., 1.)]);
}

#[test]
fn obj_materials() {
    let text = format!(
        "mtllib lib/m.mtl\n{SQUARE}o first\nusemtl matt\nf 1 2 3\nusemtl glass\nf 1 3 4\no second\nusemtl nix\nf 1 2 4\nusemtl shiny\nf 2 3 4\nusemtl mirror\nf 2 3 4\n"
    );
    let mtl = "newmtl matt\nKd 0 0 0\nmap_Kd -s 2 2 1 m.png\nKe 1 2 3\nd 0.5\nillum 1\n\
        newmtl glass\nNi 1.4\nTf 0.9 1 1\nillum 7\n\
        newmtl shiny\nKd 0.5 0.4 2\nKs 0.2 0.2 0.2\nNs 98\n\
        newmtl mirror\nKd 0 0 0\nKs 0.8 0.8 0.8\nillum 3\n";
    let files = folder(&[("a.obj", text.as_bytes()), ("lib/m.mtl", mtl.as_bytes()), ("m.png", &png())]);
    let s = load(&files.path().join("a.obj")).unwrap();
    let by = |i: usize| &s.materials[s.objects[i].material];
    assert_eq!(
        s.objects.iter().map(|o| o.name.as_str()).collect::<Vec<_>>(),
        ["first", "first", "second", "second", "second"]
    );

    let matt = by(0);
    let Model::Diffuse { reflectance } = matt.model else { panic!("{matt:?}") };
    assert_eq!(reflectance.factor, [1.0; 3], "a texture on black is the texture");
    assert_eq!(s.images[0].name, "m.png");
    let emission = Emission { radiance: ColorParam::constant([1.0, 2.0, 3.0]), sides: Sides::Front, coat: None };
    assert_eq!(matt.emission, Some(emission));
    assert_eq!(matt.alpha, Alpha::Blend { coverage: ScalarParam::constant(0.5) });

    let Model::Dielectric { ior, tint, .. } = by(1).model else { panic!("{:?}", by(1)) };
    assert_eq!((ior, tint.factor), (1.4, [0.9, 1.0, 1.0]));
    assert_eq!(by(2).name, "default");
    let Model::MetallicRoughness(shiny) = &by(3).model else { panic!("{:?}", by(3)) };
    assert_eq!(shiny.base_color.factor, [0.5, 0.4, 1.0]);
    // α = √(2/100), roughness √α; F0 = 0.04 × 5 = Ks.
    assert!((shiny.roughness.factor - 0.02f32.sqrt().sqrt()).abs() < 1e-6);
    assert!((shiny.specular_color.factor[0] - 5.0).abs() < 1e-6);
    assert_eq!(by(4).model, Model::Mirror { reflectance: ColorParam::constant([0.8; 3]) });
    assert!(s.notes.iter().any(|n| n.contains("nix unknown")), "{:?}", s.notes);
    assert!(s.notes.iter().any(|n| n.contains("`shiny`: reflectances above 1")), "{:?}", s.notes);
    assert!(s.environment.is_none() && s.cameras.len() == 1);
}

#[test]
fn obj_errors() {
    for (text, place, message) in [
        ("v 0 0\n", "1", "found 2 numbers, expected 3 to 7"),
        ("v 0 0 nan\n", "1", "found `nan`, expected a finite number"),
        ("\nv 0 0 x\n", "2", "found `x`, expected a finite number"),
        ("v 0 0 0\nf 1 1\n", "2", "a face has 2 corners, expected at least 3"),
        ("v 0 0 0\nf 1 2 1\n", "2", "`2` names vertex 2; there are 1 so far, numbered from 1"),
        ("v 0 0 0\nf 0 1 1\n", "2", "`0` names vertex 0"),
        ("v 0 0 0\nf 1 -2 1\n", "2", "`-2` names vertex -2"),
        ("v 0 0 0\nf 1/1 1 1\n", "2", "`1/1` names texture coordinate 1; there are 0 so far"),
        ("v 0 0 0\nf 1//9 1 1\n", "2", "`1//9` names normal 9"),
        ("v 0 0 0\nf a b c\n", "2", "`a` is not a corner; expected v, v/t, v//n or v/t/n"),
        ("v 0 0 0\nvn 0 0\n", "2", "found 2 numbers, expected 3"),
        ("v 0 0 0\nf 1 1 1\n", "", "has no face with an area"),
        ("hello\n", "", "has no face with an area"),
        ("mtllib ../../../../../../../../etc/hostname\n", "1", "lies outside the scene's folder"),
    ] {
        let e = obj(text).expect_err(text);
        assert_eq!(e.place, place, "{e}");
        assert!(e.message.contains(message), "{e}");
    }
    let s = obj(&format!("mtllib none.mtl\n{SQUARE}f 1 2 3\nf 1 1 2\n")).unwrap();
    assert!(s.notes.iter().any(|n| n.contains("`none.mtl` is missing")), "{:?}", s.notes);
    assert!(s.notes.iter().any(|n| n.contains("1 triangles without area")), "{:?}", s.notes);
}

#[test]
fn mtl_errors() {
    for (mtl, place, message) in [
        ("newmtl a\nKd 1 2 x\n", "2", "`Kd`: found `x`, expected a finite number"),
        ("newmtl a\n\nKd -1 0 0\n", "3", "`Kd`: found -1, expected numbers ≥ 0"),
        ("newmtl a\nmap_Kd none.png\n", "2", "`map_Kd`: `none.png` cannot be read"),
        ("newmtl a\nmap_Kd a.obj\n", "2", "`map_Kd`: `a.obj` is an unknown format"),
    ] {
        let files = folder(&[("a.obj", b"mtllib a.mtl\n"), ("a.mtl", mtl.as_bytes())]);
        let e = load(&files.path().join("a.obj")).unwrap_err();
        assert_eq!((e.place.as_str(), e.file.as_path()), (place, files.path().join("a.mtl").as_path()), "{e}");
        assert!(e.message.contains(message), "{e}");
    }
}

/// A square with normals, texture coordinates and colours, as ASCII.
pub(super) const PLY: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\nproperty list uchar int vertex_indices\nelement edge 1\nproperty int a\nend_header\n0 0 0 0 0 1 0 0 255 0 0\n1 0 0 0 0 1 1 0 0 255 0\n1 1 0 0 0 1 1 1 0 0 255\n0 1 0 0 0 1 0 1 128 128 128\n4 0 1 2 3\n3 0 1 3\n7\n";

#[test]
fn ply_ascii() {
    let s = ply(PLY.as_bytes()).unwrap();
    let m = mesh(&s, 0);
    assert_eq!(m.indices, [[0, 1, 2], [0, 2, 3], [0, 1, 3]]);
    assert_eq!(m.positions[2], Vec3::new(1.0, 1.0, 0.0));
    assert_eq!(m.normals, [Vec3::Z; 4]);
    assert_eq!(m.uv[0][0], Vec2::new(0.0, 1.0));
    assert!((m.colors[3] - Vec4::new(0.215_861, 0.215_861, 0.215_861, 1.0)).length() < 1e-5);
    assert_eq!(s.objects[0].name, "a");
}

/// The same triangle in both byte orders.
fn binary(format: &str, float: impl Fn(f64) -> [u8; 8], int: impl Fn(u16) -> [u8; 2]) -> Vec<u8> {
    let mut file = format!("ply\nformat {format} 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\nelement face 1\nproperty list uchar ushort vertex_index\nend_header\n").into_bytes();
    for x in [0.0, 0.0, 0.0, 2.5, 0.0, 0.0, 0.0, 1.5, 0.0] {
        file.extend(float(x));
    }
    file.push(3);
    for i in [0, 1, 2] {
        file.extend(int(i));
    }
    file
}

#[test]
fn ply_binary() {
    for file in [
        binary("binary_little_endian", f64::to_le_bytes, u16::to_le_bytes),
        binary("binary_big_endian", f64::to_be_bytes, u16::to_be_bytes),
    ] {
        let s = ply(&file).unwrap();
        assert_eq!(mesh(&s, 0).positions, [Vec3::ZERO, Vec3::X * 2.5, Vec3::Y * 1.5]);
        assert_eq!(mesh(&s, 0).indices, [[0, 1, 2]]);
        assert!(ply(&file[..file.len() - 1]).is_err());
    }
}

#[test]
fn ply_errors() {
    let change = |from: &str, to: &str| PLY.replacen(from, to, 1);
    for (text, place, message) in [
        (String::from("plx\n"), "1", ""),
        (change("4 0 1 2 3\n", "4 0 1 2 9\n"), "", "triangle 1 has the vertex 9; there are 4"),
        (change("4 0 1 2 3\n", "4 0 1 2 -3\n"), "", "triangle 1 has the vertex 4294967295"),
        (change("1 1 0 0 0 1", "1 1e39 0 0 0 1"), "", "vertex 2 is [1.0, inf, 0.0], expected finite coordinates"),
        (change("1 1 0 0 0 1", "1 x 0 0 0 1"), "23", ""),
        (change("element face 2", "element face 2000000000"), "", "announces 2000000000 elements `face`"),
        (
            change("element face 2", "element face 0").replace("4 0 1 2 3\n3 0 1 3\n", ""),
            "",
            "point clouds are not honoured",
        ),
        (change("property int a\n", ""), "", "announces 1 elements `edge`"),
        (change("4 0 1 2 3\n3 0 1 3\n", "3 0 0 1\n3 1 1 2\n"), "", "has no face with an area"),
    ] {
        let e = ply(text.as_bytes()).expect_err(&text);
        assert_eq!(e.place, place, "{e}");
        assert!(e.message.contains(message), "{e}");
    }
}

#[test]
fn unknown_extensions() {
    let e = load(Path::new("a.blend")).unwrap_err();
    assert_eq!(
        (e.kind, e.message.as_str()),
        (ErrorKind::Unsupported, "extension `.blend` is not known; expected .toml, .gltf, .glb, .obj or .ply")
    );
    assert_eq!(load(Path::new("none.ply")).unwrap_err().kind, ErrorKind::Missing);
    assert_eq!(load(Path::new("none.glb")).unwrap_err().kind, ErrorKind::Missing);
}

#[test]
fn asset_meshes_load() {
    let Some(folder) = assets("mesh") else { return };
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "obj") {
            let s = load(&path).unwrap_or_else(|e| panic!("{e}"));
            let (min, max) = bounds(&s).unwrap();
            println!("{}: {} triangles, {min} … {max}, {:?}", path.display(), mesh(&s, 0).indices.len(), s.notes);
            assert!(mesh(&s, 0).indices.len() > 100 && !mesh(&s, 0).uv[0].is_empty());
            seen += 1;
        }
    }
    assert!(seen > 0);
}

#[test]
fn a_file_is_read_once_however_often_and_however_it_is_named() {
    let obj = format!("{}{SQUARE}usemtl a\nf 1 2 3\n", "mtllib m.mtl\nmtllib ./m.mtl\n".repeat(100));
    let mtl = "newmtl a\nmap_Kd p.png\nmap_d ./p.png\n";
    let text = "[texture.a]\ntype = 'image'\nfile = 'p.png'\n[texture.b]\ntype = 'image'\nfile = './p.png'\n\
        [[shape]]\ntype = 'file'\nfile = 'm.obj'\n[[shape]]\ntype = 'file'\nfile = './/m.obj'\n";
    let files = folder(&[
        ("scene.toml", text.as_bytes()),
        ("m.obj", obj.as_bytes()),
        ("m.mtl", mtl.as_bytes()),
        ("p.png", &png()),
    ]);
    let s = load(&files.path().join("m.obj")).unwrap();
    assert_eq!((s.materials.len(), s.images.len()), (1, 1));
    let s = load(&files.path().join("scene.toml")).unwrap();
    assert_eq!((s.shapes.len(), s.objects.len(), s.materials.len()), (1, 2, 1));
    assert_eq!(s.images.len(), 2, "the scene's own, and the library's");
}

#[test]
fn long_names_are_not_multiplied() {
    let name = "x".repeat(1 << 20);
    let e = obj(&format!("{SQUARE}o {name}\n{}", "usemtl a\nf 1 2 3\n".repeat(10))).unwrap_err();
    assert_eq!((e.place.as_str(), e.kind), ("5", ErrorKind::Invalid));
    assert!(e.message.contains("a name of 1048576 bytes"), "{e}");
}
