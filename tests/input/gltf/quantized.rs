//! KHR_mesh_quantization: integers are the numbers that they stand for.

use super::document::{Document, U8, U16};
use glam::{Vec2, Vec3, Vec4};
use radianza::glam;
use serde_json::json;

const I8: u32 = 5120;
const I16: u32 = 5122;

/// A triangle whose attribute `name` has these integers, all in elements of 4 or 8 bytes.
fn with(name: &str, component: u32, lanes: usize, normalized: bool, values: &[[i32; 3]]) -> Document {
    let mut d = Document::triangle();
    d.attribute("NORMAL", "VEC3", &[[0.0, 0.0, 1.0]; 3]);
    d.set("/extensionsRequired", json!(["KHR_mesh_quantization"]));
    let stride = if matches!(component, U8 | I8) { 4 } else { 8 };
    let element = |v: &[i32; 3]| {
        let four = [v[0], v[1], v[2], if lanes == 4 { 127 } else { 0 }];
        let mut bytes: Vec<u8> = four[..lanes].iter().flat_map(|c| c.to_le_bytes()[..stride / 4].to_vec()).collect();
        bytes.resize(stride, 0xee);
        bytes
    };
    let bytes: Vec<u8> = values.iter().flat_map(element).collect();
    let accessor = d.accessor(component, &format!("VEC{lanes}"), values.len(), &bytes);
    let view = d.json["accessors"][accessor]["bufferView"].as_u64().unwrap();
    d.set(&format!("/bufferViews/{view}/byteStride"), json!(stride));
    d.set(&format!("/accessors/{accessor}/normalized"), json!(normalized));
    d.set(&format!("/meshes/0/primitives/0/attributes/{name}"), json!(accessor));
    d
}

#[test]
fn positions_of_all_types() {
    let corners = [[0, 0, 0], [100, 0, 0], [0, 50, 7]];
    for (component, normalized, one) in [
        (I8, false, 1.0),
        (I8, true, 127.0),
        (U8, false, 1.0),
        (U8, true, 255.0),
        (I16, false, 1.0),
        (I16, true, 32767.0),
        (U16, false, 1.0),
        (U16, true, 65535.0),
    ] {
        let m = with("POSITION", component, 3, normalized, &corners).read_mesh();
        let expected = corners.map(|c| Vec3::from_array(c.map(|x| x as f32 / one)));
        assert_eq!(m.positions, expected, "{component} {normalized}");
    }
    let m = with("POSITION", I8, 3, true, &[[-128, -127, 127], [0, 0, 0], [127, 0, 0]]).read_mesh();
    assert_eq!(m.positions[0], Vec3::new(-1.0, -1.0, 1.0));
    let m = with("POSITION", U16, 3, false, &[[0, 0, 65535], [0, 9, 0], [127, 0, 0]]).read_mesh();
    assert_eq!(m.positions[0], Vec3::new(0.0, 0.0, 65535.0));
}

/// A cube on a grid equals its twin of floats under the matrix that undoes the grid.
#[test]
fn a_cube_equals_its_float_twin() {
    let corners: Vec<[i32; 3]> = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(|b| b * 30_000)).collect();
    let indices =
        [0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5];
    let floats: Vec<[f32; 3]> = corners.iter().map(|c| c.map(|x| x as f32)).collect();
    let mut twin = Document::mesh(&floats);
    let mut d = with("POSITION", I16, 3, false, &corners);
    d.remove("/meshes/0/primitives/0/attributes/NORMAL");
    for d in [&mut d, &mut twin] {
        d.indices(U8, &indices);
        d.set("/nodes/0/scale", json!([1.0 / 30_000.0, 1.0 / 30_000.0, 1.0 / 30_000.0]));
    }
    let (a, b) = (d.read().unwrap(), twin.read().unwrap());
    assert_eq!((a.shapes, a.objects), (b.shapes, b.objects));
}

#[test]
fn directions_and_texture_coordinates() {
    for (component, one) in [(I8, 127), (I16, 32767)] {
        let m = with("NORMAL", component, 3, true, &[[0, 0, one], [0, -one, 0], [one, 0, 0]]).read_mesh();
        assert_eq!(m.normals, [Vec3::Z, -Vec3::Y, Vec3::X]);
    }
    let m = with("TANGENT", I8, 4, true, &[[127, 0, 0]; 3]).read_mesh();
    assert_eq!(m.tangents, [Vec4::new(1.0, 0.0, 0.0, 1.0); 3]);
    for (component, normalized, one) in [(I8, false, 1.0), (U16, false, 1.0), (I16, true, 32767.0), (U8, true, 255.0)] {
        let m = with("TEXCOORD_0", component, 2, normalized, &[[0, 100, 0], [7, 0, 0], [1, 1, 0]]).read_mesh();
        assert_eq!(m.uv[0], [Vec2::new(0.0, 100.0), Vec2::new(7.0, 0.0), Vec2::ONE].map(|v| v / one));
    }
}

#[test]
fn what_the_extension_does_not_allow_is_refused() {
    let place = |name: &str| format!("/meshes/0/primitives/0/attributes/{name}");
    with("NORMAL", I8, 3, false, &[[0, 0, 1]; 3])
        .fails(&place("NORMAL"), "VEC3 of i8; expected VEC3 of f32 or of normalised i8");
    with("NORMAL", U8, 3, true, &[[0, 0, 1]; 3]).fails(&place("NORMAL"), "VEC3 of normalised u8");
    with("TANGENT", U16, 4, true, &[[1, 0, 0]; 3]).fails(&place("TANGENT"), "VEC4 of normalised u16");
    let mut d = with("POSITION", I16, 3, false, &[[0, 0, 0], [1, 0, 0], [0, 1, 0]]);
    d.remove("/extensionsRequired").fails(&place("POSITION"), "VEC3 of i16; expected VEC3 of f32");
}
