//! EXT_meshopt_compression and KHR_draco_mesh_compression: a stream equals what was encoded.

use super::document::{Document, F32, U16, bytes_of, mesh};
use draco_core::draco_types::DataType;
use draco_core::encoder_buffer::EncoderBuffer;
use draco_core::encoder_options::EncoderOptions;
use draco_core::geometry_attribute::{GeometryAttributeType, PointAttribute};
use draco_core::mesh_encoder::MeshEncoder;
use draco_core::{Mesh as DracoMesh, PointCloud};
use glam::Vec3;
use meshoptimizer_rs::codec::{self, ExpMode, IndexEncoding, VertexEncoding};
use meshoptimizer_rs::{Limits, Workspace};
use radianza::desc::Mesh;
use radianza::glam;
use serde_json::{Value, json};

/// A strip of `n` squares of a wave, two triangles each.
fn wave(n: usize) -> (Vec<[f32; 3]>, Vec<u32>) {
    let vertex = |i: usize| [(i / 2) as f32, (i % 2) as f32, (0.3 * (i / 2) as f32).sin()];
    let square = |i: u32| [2 * i, 2 * i + 2, 2 * i + 1, 2 * i + 1, 2 * i + 2, 2 * i + 3];
    ((0..2 * n + 2).map(vertex).collect(), (0..n as u32).flat_map(square).collect())
}

/// The same without compression.
fn plain(n: usize) -> Document {
    let (positions, indices) = wave(n);
    let mut d = Document::mesh(&positions);
    d.indices(U16, &indices);
    d
}

fn workspace() -> Workspace {
    Workspace::new(Limits::default())
}

/// Compresses view `index` of `d`: `stream` becomes a view of its own, whose range the extension names.
fn compress(d: &mut Document, index: usize, stream: &[u8], mode: &str, stride: usize, filter: &str) {
    let length = d.json["bufferViews"][index]["byteLength"].as_u64().unwrap() as usize;
    let view = d.view(stream);
    let at = d.json["bufferViews"][view]["byteOffset"].clone();
    let extension = json!({ "buffer": 0, "byteOffset": at, "byteLength": stream.len(), "byteStride": stride,
        "count": length / stride, "mode": mode, "filter": filter });
    d.set(&format!("/bufferViews/{index}/extensions"), json!({ "EXT_meshopt_compression": extension }));
    d.set(&format!("/bufferViews/{index}/buffer"), json!(1));
    d.set(&format!("/bufferViews/{index}/byteOffset"), json!(0));
    d.set("/extensionsRequired", json!(["EXT_meshopt_compression"]));
}

/// The buffers of a document with a fallback that is not there.
fn with_fallback(mut d: Document) -> Document {
    let fallback = json!({ "byteLength": 1 << 20, "extensions": { "EXT_meshopt_compression": { "fallback": true } } });
    d.json["buffers"] = json!([{ "byteLength": d.bin.len() }, fallback]);
    d
}

/// The wave, compressed, its own bytes wiped out.
pub(crate) fn meshopt(n: usize, mode: &str) -> Document {
    let (positions, indices) = wave(n);
    let mut d = plain(n);
    d.bin.fill(0xee);
    let bytes = bytes_of(positions.as_flattened());
    let vertices =
        codec::encode_vertex_buffer(&bytes, positions.len(), 12, VertexEncoding::new(0, 2).unwrap(), &mut workspace())
            .unwrap();
    let encoding = IndexEncoding::DEFAULT;
    let indices = match mode {
        "TRIANGLES" => codec::encode_index_buffer(&indices, encoding, &mut workspace()).unwrap(),
        _ => codec::encode_index_sequence(&indices, encoding, &mut workspace()).unwrap(),
    };
    compress(&mut d, 0, &vertices, "ATTRIBUTES", 12, "NONE");
    compress(&mut d, 1, &indices, mode, 2, "NONE");
    with_fallback(d)
}

/// Triangles as positions, each begun with its smallest corner, in order.
fn triangles(m: &Mesh) -> Vec<[[u32; 3]; 3]> {
    let corner = |i: u32| m.positions[i as usize].to_array().map(f32::to_bits);
    let turned = |t: &[u32; 3]| {
        let mut t = t.map(corner);
        let first = (0..3).min_by_key(|i| t[*i]).unwrap();
        t.rotate_left(first);
        t
    };
    let mut list: Vec<_> = m.indices.iter().map(turned).collect();
    list.sort();
    list
}

#[test]
fn meshopt_streams_are_what_was_encoded() {
    for n in [1, 40, 700] {
        for mode in ["TRIANGLES", "INDICES"] {
            let (m, twin) = (meshopt(n, mode).read_mesh(), plain(n).read_mesh());
            assert_eq!(m.positions, twin.positions);
            assert_eq!(triangles(&m), triangles(&twin), "{mode} {n}");
        }
    }
}

#[test]
fn meshopt_filters_are_undone() {
    let normals = [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.0, -1.0, 0.0]];
    let mut d = Document::triangle();
    d.set("/extensionsUsed", json!(["KHR_mesh_quantization"]));
    let four: Vec<f32> = normals.iter().flat_map(|[x, y, z]| [*x, *y, *z, 0.0]).collect();

    // Octahedral, into 4 × i8.
    let filtered = codec::encode_filter_oct(3, 4, 8, &four, &mut workspace()).unwrap();
    let encoded =
        codec::encode_vertex_buffer(&filtered, 3, 4, VertexEncoding::new(0, 2).unwrap(), &mut workspace()).unwrap();
    let accessor = d.accessor(5120, "VEC3", 3, &[0; 12]);
    d.set(&format!("/accessors/{accessor}/normalized"), json!(true));
    d.set("/bufferViews/1/byteStride", json!(4));
    d.set("/meshes/0/primitives/0/attributes/NORMAL", json!(accessor));
    compress(&mut d, 1, &encoded, "ATTRIBUTES", 4, "OCTAHEDRAL");
    let m = with_fallback(d.clone()).read_mesh();
    for (found, expected) in m.normals.iter().zip(normals) {
        assert!(found.abs_diff_eq(Vec3::from_array(expected), 0.02), "{found} {expected:?}");
    }

    // Exponential, into floats.
    let positions = [0.0f32, 0.0, 0.0, 1.5, 0.0, 0.0, 0.0, 0.75, 0.0];
    let filtered = codec::encode_filter_exp(3, 12, 15, &positions, ExpMode::Separate, &mut workspace()).unwrap();
    let encoded =
        codec::encode_vertex_buffer(&filtered, 3, 12, VertexEncoding::new(0, 2).unwrap(), &mut workspace()).unwrap();
    compress(&mut d, 0, &encoded, "ATTRIBUTES", 12, "EXPONENTIAL");
    let m = with_fallback(d).read_mesh();
    assert_eq!(m.positions, [Vec3::ZERO, 1.5 * Vec3::X, 0.75 * Vec3::Y]);
}

#[test]
fn meshopt_quaternions_turn_instances() {
    let q = [0.5f32, -0.5, 0.5, 0.5, 0.0, 0.0, 0.0, 1.0];
    let filtered = codec::encode_filter_quat(2, 8, 12, &q, &mut workspace()).unwrap();
    let encoded =
        codec::encode_vertex_buffer(&filtered, 2, 8, VertexEncoding::new(0, 2).unwrap(), &mut workspace()).unwrap();
    let mut d = Document::triangle();
    let accessor = d.accessor(5122, "VEC4", 2, &[0; 16]);
    d.set(&format!("/accessors/{accessor}/normalized"), json!(true));
    d.set("/nodes/0/extensions", json!({ "EXT_mesh_gpu_instancing": { "attributes": { "ROTATION": accessor } } }));
    compress(&mut d, 1, &encoded, "ATTRIBUTES", 8, "QUATERNION");
    let scene = with_fallback(d).read().unwrap();
    let x = scene.objects[0].to_world.transform_vector3(Vec3::X);
    let expected = glam::Quat::from_xyzw(0.5, -0.5, 0.5, 0.5) * Vec3::X;
    assert!(x.abs_diff_eq(expected, 2e-3), "{x} {expected}");
    assert_eq!(scene.objects[1].to_world, glam::Mat4::IDENTITY);
}

#[test]
fn meshopt_streams_that_are_wrong() {
    let place = "/bufferViews/0/extensions/EXT_meshopt_compression";
    for (key, value, at, says) in [
        ("mode", json!("POINTS"), "/mode", "expected \"ATTRIBUTES\""),
        ("filter", json!("SHARPEN"), "/filter", "expected \"NONE\""),
        ("filter", json!("OCTAHEDRAL"), "", "12 bytes do not fit"),
        ("byteStride", json!(13), "", "elements of 13 bytes"),
        ("count", json!(0), "", "0 elements"),
        ("count", json!(1u64 << 62), "", "do not fit"),
        ("count", json!(83), "", "its view has 984 bytes"),
        ("count", json!(-1), "", "-1"),
        ("byteLength", json!(20), "", "is not a stream of 82"),
        ("byteOffset", json!(u64::MAX), "", "its buffer has"),
        ("buffer", json!(7), "/buffer", "refers to buffer 7"),
        ("buffer", json!(1), "/buffers/1/uri", "is missing"),
    ] {
        let mut d = meshopt(40, "TRIANGLES");
        d.set(&format!("{place}/{key}"), value);
        let at = if at.starts_with("/buffers") { at.to_owned() } else { format!("{place}{at}") };
        d.fails(&at, says);
    }
    // Few bytes cannot ask for much: 2⁴⁰ bytes are not even begun.
    let mut d = meshopt(40, "TRIANGLES");
    d.set(&format!("{place}/count"), json!(1u64 << 38)).set(&format!("{place}/byteStride"), json!(4));
    d.set("/bufferViews/0/byteLength", json!(1u64 << 40)).fails(place, "too many for a file of this size");
}

/// The wave as a Draco stream, quantised to `bits`, with UV.
fn draco_stream(n: usize, method: i32, bits: i32) -> Vec<u8> {
    let (positions, indices) = wave(n);
    let mut mesh = DracoMesh::new();
    let points: &mut PointCloud = &mut mesh;
    points.set_num_points(positions.len());
    for (kind, lanes) in [(GeometryAttributeType::Position, 3), (GeometryAttributeType::TexCoord, 2)] {
        let mut attribute = PointAttribute::new();
        attribute.init(kind, lanes as u8, DataType::Float32, false, positions.len());
        let values: Vec<f32> = positions.iter().flat_map(|p| p[..lanes].to_vec()).collect();
        attribute.buffer_mut().update_f32s_le(0, &values);
        points.add_attribute(attribute);
    }
    mesh.set_num_faces(indices.len() / 3);
    mesh.set_faces_from_flat_indices(&indices);
    let mut options = EncoderOptions::new();
    options.set_encoding_method(method);
    for attribute in 0..2 {
        options.set_attribute_quantization(attribute, bits);
    }
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(mesh);
    let mut stream = EncoderBuffer::new();
    encoder.encode(&options, &mut stream).unwrap();
    stream.data().to_vec()
}

/// The wave from that stream; accessors without bytes.
pub(crate) fn draco(n: usize, method: i32) -> Document {
    let (positions, indices) = wave(n);
    let mut d = Document::triangle();
    let view = d.view(&draco_stream(n, method, 16));
    let accessor =
        |component: u32, kind: &str, count: usize| json!({ "componentType": component, "type": kind, "count": count });
    d.json["accessors"] = json!([
        accessor(F32, "VEC3", positions.len()),
        accessor(F32, "VEC2", positions.len()),
        accessor(U16, "SCALAR", indices.len()),
    ]);
    d.set(
        "/meshes/0/primitives/0",
        json!({ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "extensions": {
        "KHR_draco_mesh_compression": { "bufferView": view, "attributes": { "POSITION": 0, "TEXCOORD_0": 1 } } } }),
    );
    d.set("/extensionsRequired", json!(["KHR_draco_mesh_compression"]));
    d
}

#[test]
fn draco_streams_are_what_was_encoded() {
    // 0: sequential, 1: edgebreaker. Quantised to 16 bits of an extent of n.
    for method in [0, 1] {
        for n in [1, 40, 300] {
            let scene = draco(n, method).read().unwrap();
            assert_eq!(scene.shapes.len(), 1, "{method} {n} {:?}", scene.notes);
            let (m, twin) = (mesh(&scene, 0), plain(n).read_mesh());
            let rounding = 1.01 * n as f32 / 65535.0;
            let near = |a: Vec3, b: Vec3| (a - b).abs().max_element() <= rounding;
            assert_eq!(m.indices.len(), twin.indices.len(), "{method} {n}");
            let corners = |m: &Mesh| m.indices.iter().map(|t| t.map(|i| m.positions[i as usize])).collect::<Vec<_>>();
            let expected = corners(&twin);
            for t in corners(m) {
                let same = |e: &[Vec3; 3]| (0..3).any(|turn| (0..3).all(|i| near(t[i], e[(i + turn) % 3])));
                assert!(expected.iter().any(same), "{method} {n}: {t:?}");
            }
            for (p, uv) in m.positions.iter().zip(&m.uv[0]) {
                assert!((p.truncate() - *uv).abs().max_element() <= 2.0 * rounding, "{p} {uv}");
            }
        }
    }
}

#[test]
fn draco_streams_that_are_wrong() {
    let place = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    let position = "/meshes/0/primitives/0/attributes/POSITION";
    let with = |pointer: &str, value: Value, at: &str, says: &str| {
        let mut d = draco(40, 1);
        d.set(pointer, value).fails(at, says);
    };
    with(&format!("{place}/bufferView"), json!(99), &format!("{place}/bufferView"), "buffer view 99");
    with(&format!("{place}/bufferView"), json!("x"), place, "invalid type");
    with(&format!("{place}/bufferView"), json!(0), place, "is no Draco stream");
    with(&format!("{place}/attributes/POSITION"), json!(5), position, "attribute 5 of the stream");
    with(&format!("{place}/attributes/POSITION"), json!(1), position, "has 2 components");
    with("/accessors/0/type", json!("VEC2"), position, "its accessor says VEC2");
}

#[test]
fn streams_cut_off_anywhere_end_in_an_error_or_a_mesh() {
    let d = draco(40, 1);
    let length = d.json["bufferViews"][1]["byteLength"].as_u64().unwrap();
    for n in 0..length {
        let mut cut = d.clone();
        cut.set("/bufferViews/1/byteLength", json!(n));
        let e = cut.read().expect_err("a stream that ends early");
        assert!(e.place.starts_with("/meshes/0/primitives/0"), "{e}");
    }
    let d = meshopt(40, "TRIANGLES");
    let length = d.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["byteLength"].as_u64().unwrap();
    for n in 0..length {
        let mut cut = d.clone();
        cut.set("/bufferViews/0/extensions/EXT_meshopt_compression/byteLength", json!(n));
        cut.fails("/bufferViews/0/extensions/EXT_meshopt_compression", "is not a stream");
    }
}
