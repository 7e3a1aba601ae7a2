//! Primitives: modes, indices, attributes, accessors.

use super::document::{Document, F32, U8, U16, U32, bytes_of, mesh, noted};
use glam::{Vec2, Vec3, Vec4};
use radianza::glam;
use serde_json::json;

/// Five points of a strip in the plane z = 0.
const STRIP: [[f32; 3]; 5] = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 0.0, 0.0]];

#[test]
fn triangle_without_anything_else() {
    let scene = Document::triangle().read().unwrap();
    assert_eq!((scene.shapes.len(), scene.objects.len(), scene.materials.len()), (1, 1, 1));
    assert_eq!((scene.cameras.len(), scene.lights.len(), scene.environment.is_none()), (0, 0, true));
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    assert_eq!(scene.name, "test");
    let m = mesh(&scene, 0);
    assert_eq!(m.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(m.indices, [[0, 1, 2]]);
    assert!(m.normals.is_empty() && m.tangents.is_empty() && m.uv[0].is_empty() && m.colors.is_empty());
}

#[test]
fn modes_that_make_triangles() {
    let of = |mode: u32| {
        let mut d = Document::mesh(&STRIP);
        d.set("/meshes/0/primitives/0/mode", json!(mode));
        d
    };
    assert_eq!(of(5).read_mesh().indices, [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
    assert_eq!(of(6).read_mesh().indices, [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
    let scene = of(4).read().unwrap();
    assert_eq!(mesh(&scene, 0).indices, [[0, 1, 2]]);
    assert!(noted(&scene, "no multiple of 3"));
    for mode in 0..=3 {
        let scene = of(mode).read().unwrap();
        assert!(scene.objects.is_empty() && noted(&scene, "points and lines are skipped"), "mode {mode}");
    }
    of(7).fails("/meshes/0/primitives/0/mode", "expected 0 to 6");
}

#[test]
fn indices_of_all_widths() {
    for component in [U8, U16, U32] {
        let mut d = Document::mesh(&STRIP);
        d.indices(component, &[2, 1, 0, 4, 2, 3]);
        assert_eq!(d.read_mesh().indices, [[2, 1, 0], [4, 2, 3]]);
    }
    let mut d = Document::mesh(&STRIP);
    d.indices(U16, &[0, 1, 2, 3, 4]);
    d.set("/meshes/0/primitives/0/mode", json!(5));
    assert_eq!(d.read_mesh().indices, [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
}

#[test]
fn triangles_without_area_are_dropped() {
    let mut d = Document::mesh(&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    d.indices(U8, &[0, 1, 2, 0, 1, 1, 0, 1, 3]);
    let scene = d.read().unwrap();
    assert_eq!(mesh(&scene, 0).indices, [[0, 1, 3]]);
    assert!(noted(&scene, "without area are dropped (first at /meshes/0/primitives/0; 2 in all)"), "{:?}", scene.notes);

    d.indices(U8, &[0, 1, 2]);
    let scene = d.read().unwrap();
    assert!(scene.objects.is_empty() && scene.shapes.is_empty() && noted(&scene, "without a triangle are skipped"));
}

#[test]
fn tiny_and_huge_triangles_have_area() {
    for scale in [1e-30, 1e30] {
        let d = Document::mesh(&[[0.0; 3], [scale, 0.0, 0.0], [0.0, scale, 0.0]]);
        assert_eq!(d.read_mesh().indices.len(), 1, "{scale}");
    }
}

#[test]
fn normals_are_made_unit() {
    let mut d = Document::triangle();
    d.attribute("NORMAL", "VEC3", &[[0.0, 0.0, 2.0], [3e38, 3e38, 0.0], [0.0, 0.0, 0.0]]);
    let scene = d.read().unwrap();
    let m = mesh(&scene, 0);
    assert_eq!(m.normals[0], Vec3::Z);
    assert!(m.normals[1].abs_diff_eq(Vec3::new(0.5f32.sqrt(), 0.5f32.sqrt(), 0.0), 1e-6));
    assert_eq!(m.normals[2], Vec3::Z);
    assert!(noted(&scene, "length zero are replaced"));
}

#[test]
fn tangents_are_made_unit_and_need_normals() {
    let mut d = Document::triangle();
    d.attribute("TANGENT", "VEC4", &[[2.0, 0.0, 0.0, -3.0], [0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 0.0, 1.0]]);
    assert!(d.read_mesh().tangents.is_empty());
    d.attribute("NORMAL", "VEC3", &[[0.0, 0.0, 1.0]; 3]);
    let scene = d.read().unwrap();
    let m = mesh(&scene, 0);
    assert_eq!(m.tangents[0], Vec4::new(1.0, 0.0, 0.0, -1.0));
    for t in &m.tangents[1..] {
        assert!(t.truncate().is_normalized() && t.truncate().dot(Vec3::Z).abs() < 1e-6 && t.w == 1.0, "{t}");
    }
    assert!(noted(&scene, "tangents without a direction"));
}

#[test]
fn texture_coordinates_as_floats_and_normalised_integers() {
    let mut d = Document::triangle();
    let bytes = [0u8, 255, 0, 0, 51, 0, 0, 0, 255, 255, 0, 0];
    let normalised = d.accessor(U8, "VEC2", 3, &bytes);
    d.set(&format!("/accessors/{normalised}/normalized"), json!(true));
    d.set("/bufferViews/1/byteStride", json!(4));
    d.set("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(normalised));
    let words: Vec<u8> = [0u16, 65535, 13107, 0, 65535, 65535].iter().flat_map(|x| x.to_le_bytes()).collect();
    let normalised = d.accessor(U16, "VEC2", 3, &words);
    d.set(&format!("/accessors/{normalised}/normalized"), json!(true));
    d.set("/meshes/0/primitives/0/attributes/TEXCOORD_1", json!(normalised));
    let m = d.read_mesh();
    for uv in &m.uv {
        assert_eq!(uv[..], [Vec2::Y, Vec2::new(0.2, 0.0), Vec2::ONE]);
    }
}

#[test]
fn vertex_colours_of_all_kinds() {
    let with = |component, kind: &str, bytes: &[u8], normalised: bool| {
        let mut d = Document::triangle();
        let a = d.accessor(component, kind, 3, bytes);
        d.set(&format!("/accessors/{a}/normalized"), json!(normalised));
        d.set("/meshes/0/primitives/0/attributes/COLOR_0", json!(a));
        d
    };
    let rgb = with(F32, "VEC3", &bytes_of(&[0.5, 0.25, 2.0, -1.0, 0.0, 0.0, 1.0, 1.0, 1.0]), false).read_mesh();
    assert_eq!(rgb.colors, [Vec4::new(0.5, 0.25, 1.0, 1.0), Vec4::W, Vec4::ONE]);
    let rgba = with(U8, "VEC4", &[51, 0, 255, 102, 0, 0, 0, 0, 255, 255, 255, 255], true).read_mesh();
    assert_eq!(rgba.colors, [Vec4::new(0.2, 0.0, 1.0, 0.4), Vec4::ZERO, Vec4::ONE]);
    with(U8, "VEC4", &[0; 12], false).fails("/meshes/0/primitives/0/attributes/COLOR_0", "VEC4 of u8; expected VEC4");
}

#[test]
fn attributes_interleaved_in_one_view() {
    let mut d = Document::triangle();
    let vertex = |p: [f32; 3], n: [f32; 3]| [p, n].concat();
    let (a, b, c) = ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 9.0, 9.0]);
    let data = [vertex(a, [0.0, 0.0, 1.0]), vertex(b, [0.0, 1.0, 0.0]), vertex(c, [1.0, 0.0, 0.0])].concat();
    let view = d.view(&bytes_of(&data));
    d.set(&format!("/bufferViews/{view}/byteStride"), json!(24));
    for (name, offset) in [("POSITION", 0), ("NORMAL", 12)] {
        let n = d.json["accessors"].as_array().unwrap().len();
        let accessor =
            json!({ "bufferView": view, "byteOffset": offset, "componentType": F32, "type": "VEC3", "count": 3 });
        d.set(&format!("/accessors/{n}"), accessor);
        d.set(&format!("/meshes/0/primitives/0/attributes/{name}"), json!(n));
    }
    let m = d.read_mesh();
    assert_eq!(m.positions, [Vec3::from(a), Vec3::from(b), Vec3::from(c)]);
    assert_eq!(m.normals, [Vec3::Z, Vec3::Y, Vec3::X]);
}

#[test]
fn sparse_accessors_over_a_view_and_over_zeros() {
    let mut d = Document::triangle();
    let (indices, values) = (d.view(&[2]), d.view(&bytes_of(&[5.0, 6.0, 7.0])));
    let sparse = |count: usize| json!({ "count": count, "indices": { "bufferView": indices, "componentType": U8 }, "values": { "bufferView": values } });
    d.set("/accessors/0/sparse", sparse(1));
    assert_eq!(d.read_mesh().positions, [Vec3::ZERO, Vec3::X, Vec3::new(5.0, 6.0, 7.0)]);

    d.remove("/accessors/0/bufferView");
    let (indices, values) = (d.view(&[1, 2]), d.view(&bytes_of(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0])));
    d.set("/accessors/0/sparse/count", json!(2));
    d.set("/accessors/0/sparse/indices/bufferView", json!(indices));
    d.set("/accessors/0/sparse/values/bufferView", json!(values));
    assert_eq!(d.read_mesh().positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

#[test]
fn equal_data_is_one_shape() {
    let mut d = Document::triangle();
    let primitive = d.json["meshes"][0]["primitives"][0].clone();
    let mut green = primitive.clone();
    green["material"] = json!(0);
    d.set("/meshes/0/primitives", json!([primitive, green]));
    d.set("/materials", json!([{ "name": "green" }]));
    d.set("/nodes", json!([{ "mesh": 0, "name": "a" }, { "mesh": 0, "name": "b" }]));
    d.set("/scenes/0/nodes", json!([0, 1]));
    let scene = d.read().unwrap();
    assert_eq!(scene.shapes.len(), 1);
    let seen: Vec<_> = scene.objects.iter().map(|o| (o.name.as_str(), o.shape, o.material)).collect();
    assert_eq!(seen, [("a", 0, 0), ("a", 0, 1), ("b", 0, 0), ("b", 0, 1)]);
    assert_eq!([&scene.materials[0].name, &scene.materials[1].name], ["default", "green"]);
}
