//! A document at a time: interpolations, pointers, morph targets.

use super::document::{Document, F32, U8, bytes_of, mesh, noted, parse};
use glam::{Quat, Vec2, Vec3, Vec4};
use radianza::desc::{Error, Light, Model, Options, Projection, Scene, gltf};
use radianza::glam;
use serde_json::{Value, json};
use std::path::Path;

/// Reads a document at a time.
pub(crate) fn at(d: &Document, time: f64) -> Result<Scene, Error> {
    let file = Path::new("test.glb");
    let options = Options { at: Some(time), variant: None };
    gltf::parse_with(&d.glb(), file, &|name, place| Err(Error::missing(file, place, name)), &options)
}

/// Adds a channel with a sampler of its own: keys at `times`, `values` of `lanes` numbers.
fn animate(d: &mut Document, target: Value, interpolation: &str, times: &[f32], lanes: usize, values: &[f32]) {
    let kind = ["", "SCALAR", "VEC2", "VEC3", "VEC4"][lanes];
    let input = d.accessor(F32, "SCALAR", times.len(), &bytes_of(times));
    let output = d.accessor(F32, kind, values.len() / lanes, &bytes_of(values));
    channel(d, target, interpolation, input, output);
}

fn channel(d: &mut Document, target: Value, interpolation: &str, input: usize, output: usize) {
    if d.json["animations"].is_null() {
        d.json["animations"] = json!([{ "channels": [], "samplers": [] }]);
    }
    let animation = d.json["animations"].as_array_mut().unwrap().last_mut().unwrap();
    let samplers = animation["samplers"].as_array_mut().unwrap();
    samplers.push(json!({ "input": input, "output": output, "interpolation": interpolation }));
    let sampler = samplers.len() - 1;
    animation["channels"].as_array_mut().unwrap().push(json!({ "sampler": sampler, "target": target }));
}

fn node(path: &str) -> Value {
    json!({ "node": 0, "path": path })
}

fn pointer(pointer: &str) -> Value {
    json!({ "path": "pointer", "extensions": { "KHR_animation_pointer": { "pointer": pointer } } })
}

/// Where the origin of the node is.
fn place(d: &Document, time: f64) -> Vec3 {
    at(d, time).unwrap().objects[0].to_world.w_axis.truncate()
}

#[test]
fn steps_lines_and_cubics() {
    let keys = [0.0, 0.0, 0.0, 2.0, 4.0, 8.0];
    let mut d = Document::triangle();
    d.set("/nodes/0/translation", json!([9, 9, 9]));
    animate(&mut d, node("translation"), "LINEAR", &[1.0, 3.0], 3, &keys);
    assert_eq!(place(&d, 0.0), Vec3::ZERO);
    assert_eq!(place(&d, 1.5), Vec3::new(0.5, 1.0, 2.0));
    assert_eq!(place(&d, 99.0), Vec3::new(2.0, 4.0, 8.0));
    assert_eq!(d.read().unwrap().objects[0].to_world.w_axis.truncate(), Vec3::splat(9.0));
    assert!(
        noted(&d.read().unwrap(), "the pose that the nodes state") && !noted(&at(&d, 0.0).unwrap(), "nothing moves")
    );

    d.set("/animations/0/samplers/0/interpolation", json!("STEP"));
    assert_eq!(place(&d, 2.99), Vec3::ZERO);
    assert_eq!(place(&d, 3.0), Vec3::new(2.0, 4.0, 8.0));

    // In-tangent, value, out-tangent of each key, against appendix C at u = ¼ of a segment of 2 s.
    let mut d = Document::triangle();
    let spline = [9.0, 9.0, 9.0, 0.0, 1.0, 2.0, 1.0, 0.0, -1.0, 0.5, 0.0, 3.0, 2.0, 1.0, 0.0, 9.0, 9.0, 9.0];
    animate(&mut d, node("translation"), "CUBICSPLINE", &[1.0, 3.0], 3, &spline);
    let (u, length) = (0.25f32, 2.0);
    let (v, b) = (Vec3::from_slice(&spline[3..]), Vec3::from_slice(&spline[6..]));
    let (a, w) = (Vec3::from_slice(&spline[9..]), Vec3::from_slice(&spline[12..]));
    let expected = (2.0 * u.powi(3) - 3.0 * u * u + 1.0) * v
        + length * (u.powi(3) - 2.0 * u * u + u) * b
        + (3.0 * u * u - 2.0 * u.powi(3)) * w
        + length * (u.powi(3) - u * u) * a;
    assert!(place(&d, 1.5).abs_diff_eq(expected, 1e-6), "{} {expected}", place(&d, 1.5));
    assert_eq!([place(&d, 0.0), place(&d, 4.0)], [v, w]);
}

#[test]
fn rotations_follow_the_shorter_arc() {
    // From 0° to 120° about y, and the same with the far end negated: the same rotation.
    for sign in [1.0, -1.0] {
        let end = (Quat::from_rotation_y(120f32.to_radians()) * sign).to_array();
        let mut d = Document::triangle();
        animate(&mut d, node("rotation"), "LINEAR", &[0.0, 1.0], 4, &[[0.0, 0.0, 0.0, 1.0], end].concat());
        for (time, degrees) in [(0.0, 0.0f32), (0.25, 30.0), (0.5, 60.0), (1.0, 120.0)] {
            let turned = at(&d, time).unwrap().objects[0].to_world;
            assert!(turned.abs_diff_eq(glam::Mat4::from_rotation_y(degrees.to_radians()), 1e-6), "{sign} {time}");
        }
    }
    // Normalised integers: a half turn about x at the second key.
    let mut d = Document::triangle();
    let input = d.accessor(F32, "SCALAR", 2, &bytes_of(&[0.0, 1.0]));
    let output = d.accessor(5120, "VEC4", 2, &[0, 0, 0, 127, 127, 0, 0, 0]);
    d.set(&format!("/accessors/{output}/normalized"), json!(true));
    channel(&mut d, node("rotation"), "LINEAR", input, output);
    let turned = at(&d, 0.5).unwrap().objects[0].to_world;
    assert!(turned.abs_diff_eq(glam::Mat4::from_rotation_x(90f32.to_radians()), 1e-6), "{turned}");
}

#[test]
fn all_animations_play_together() {
    let mut d = Document::triangle();
    animate(&mut d, node("scale"), "STEP", &[0.0], 3, &[2.0, 2.0, 2.0]);
    d.json["animations"].as_array_mut().unwrap().push(json!({ "channels": [], "samplers": [] }));
    animate(&mut d, node("translation"), "STEP", &[0.0], 3, &[1.0, 0.0, 0.0]);
    animate(&mut d, json!({ "path": "rotation" }), "STEP", &[0.0], 4, &[1.0, 0.0, 0.0, 0.0]);
    let scene = at(&d, 1.0).unwrap();
    let m = scene.objects[0].to_world;
    assert_eq!((m.x_axis.x, m.w_axis.x, m.y_axis.y), (2.0, 1.0, 2.0));
    assert!(noted(&scene, "channels without a target"));
    animate(&mut d, node("scale"), "STEP", &[0.0], 3, &[3.0, 3.0, 3.0]);
    let scene = at(&d, 1.0).unwrap();
    assert!(scene.objects[0].to_world.x_axis.x == 3.0 && noted(&scene, "the value of the last one"));
}

#[test]
fn pointers_animate_materials_lights_cameras_and_visibility() {
    let mut d = Document::material(json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0,
        "extensions": { "KHR_texture_transform": {} } } }, "emissiveFactor": [0, 0, 0] }));
    d.texture([1, 1], &[[255; 4]]);
    d.set("/cameras", json!([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 1 } }]));
    d.set("/extensions/KHR_lights_punctual/lights", json!([{ "type": "point" }]));
    d.set("/nodes/0/children", json!([1]));
    d.set(
        "/nodes/1",
        json!({ "camera": 0, "extensions": { "KHR_lights_punctual": { "light": 0 }, "KHR_node_visibility": {} } }),
    );
    let lane = |d: &mut Document, name: &str, values: &[f32]| {
        animate(d, pointer(name), "LINEAR", &[0.0, 1.0], values.len() / 2, values)
    };
    lane(&mut d, "/materials/0/pbrMetallicRoughness/roughnessFactor", &[0.0, 1.0]);
    lane(&mut d, "/materials/0/emissiveFactor", &[0.0, 0.0, 0.0, 1.0, 2.0, 0.5]);
    let texture = "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform";
    lane(&mut d, &format!("{texture}/offset"), &[0.0, 0.0, 1.0, 0.5]);
    lane(&mut d, "/extensions/KHR_lights_punctual/lights/0/intensity", &[10.0, 20.0]);
    lane(&mut d, "/cameras/0/perspective/yfov", &[0.5, 1.5]);
    lane(&mut d, "/nodes/0/translation", &[0.0, 0.0, 0.0, 0.0, 8.0, 0.0]);
    let input = d.accessor(F32, "SCALAR", 2, &bytes_of(&[0.0, 0.75]));
    let flags = d.accessor(U8, "SCALAR", 2, &[1, 0]);
    channel(&mut d, pointer("/nodes/1/extensions/KHR_node_visibility/visible"), "STEP", input, flags);
    for (i, absent) in [
        "/materials/0/name",
        "/accessors/0/count",
        "/materials/9/alphaCutoff",
        "/nodes/0/weights/0",
        "/materials/0/extensions/KHR_materials_ior/ior",
        "/nodes/0/extras/x",
        "",
        "nodes",
        "/nodes/99999999999999999999/scale",
    ]
    .into_iter()
    .enumerate()
    {
        let lanes = if i == 8 { 3 } else { 1 };
        animate(&mut d, pointer(absent), "STEP", &[0.0], lanes, &vec![1.0; lanes]);
    }
    let scene = at(&d, 0.5).unwrap();
    let Model::MetallicRoughness(m) = &scene.materials[0].model else { panic!("{:?}", scene.materials[0]) };
    assert_eq!(m.roughness.factor, 0.5);
    assert_eq!(scene.materials[0].emission.unwrap().radiance.factor, [0.5, 1.0, 0.25]);
    assert_eq!(m.base_color.texture.unwrap().transform.translation, Vec2::new(0.5, 0.25));
    assert!(matches!(scene.lights[0], Light::Point { intensity: [15.0, ..], position, .. } if position.y == 4.0));
    assert_eq!(scene.cameras[0].projection, Projection::Perspective { fov: radianza::desc::Fov::Vertical(1.0) });
    for words in [
        "`/accessors/0/count` is nothing that can be animated",
        "`/materials/9/alphaCutoff` is not in the document",
        "`/nodes/0/weights/0` is not in the document",
        "KHR_materials_ior/ior` is not in the document",
        "`/nodes/0/extras/x` is nothing",
        "`` is nothing",
    ] {
        assert!(noted(&scene, words), "{words}: {:?}", scene.notes);
    }
    // Once the flag falls the light goes out; the camera stays.
    let dark = at(&d, 0.75).unwrap();
    assert!(dark.lights.is_empty() && dark.cameras.len() == 1 && noted(&dark, "KHR_node_visibility"));
}

#[test]
fn invisible_nodes_take_all_below_them_away() {
    let mut d = Document::triangle();
    let hidden = |visible: bool| json!({ "KHR_node_visibility": { "visible": visible } });
    d.set("/nodes", json!([{ "extensions": hidden(false), "children": [1] }, { "mesh": 0, "extensions": hidden(true), "children": [2] }, { "mesh": 0 }, { "mesh": 0 }]));
    d.set("/scenes/0/nodes", json!([0, 3]));
    assert_eq!(d.read().unwrap().objects.len(), 1);
    d.set("/nodes/0/extensions", hidden(true));
    assert_eq!(d.read().unwrap().objects.len(), 3);
    d.set("/nodes/0/extensions/KHR_node_visibility/visible", json!(1));
    d.fails("/nodes/0/extensions/KHR_node_visibility", "invalid type");
}

/// A triangle with two targets: one lifts the last vertex and tilts all normals, one is sparse.
pub(crate) fn morphed() -> Document {
    let mut d = Document::triangle();
    d.attribute("NORMAL", "VEC3", &[[0.0, 0.0, 1.0]; 3]);
    d.attribute("TEXCOORD_0", "VEC2", &[[0.0, 0.0]; 3]);
    d.attribute("COLOR_0", "VEC3", &[[0.25; 3]; 3]);
    let list = |d: &mut Document, kind: &str, values: &[f32]| d.accessor(F32, kind, 3, &bytes_of(values));
    let lift = list(&mut d, "VEC3", &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0]);
    let tilt = list(&mut d, "VEC3", &[[1.0, 0.0, -1.0]; 3].concat());
    let uv = list(&mut d, "VEC2", &[1.0; 6]);
    let color = list(&mut d, "VEC4", &[1.0, 0.5, 0.0, -0.5].repeat(3));
    let sparse = d.json["accessors"].as_array().unwrap().len();
    let (indices, values) = (d.view(&[1]), d.view(&bytes_of(&[4.0, 0.0, 0.0])));
    d.set(
        &format!("/accessors/{sparse}"),
        json!({ "componentType": F32, "type": "VEC3", "count": 3, "sparse": { "count": 1,
        "indices": { "bufferView": indices, "componentType": U8 }, "values": { "bufferView": values } } }),
    );
    d.set(&format!("/accessors/{}", sparse + 1), json!({ "componentType": F32, "type": "VEC3", "count": 3 }));
    d.set("/meshes/0/primitives/0/targets", json!([
        { "POSITION": lift, "NORMAL": tilt, "TEXCOORD_0": uv, "COLOR_0": color }, { "POSITION": sparse, "NORMAL": sparse + 1 }]));
    d
}

#[test]
fn morph_targets_displace_by_their_weights() {
    let base = morphed().read_mesh();
    assert_eq!(base.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    let mut d = morphed();
    d.set("/meshes/0/weights", json!([0.5, 0.25]));
    let m = d.read_mesh();
    assert_eq!(m.positions, [Vec3::ZERO, 2.0 * Vec3::X, Vec3::new(0.0, 1.0, 1.0)]);
    assert!(m.normals[0].abs_diff_eq(Vec3::new(0.5, 0.0, 0.5).normalize(), 1e-6), "{}", m.normals[0]);
    assert_eq!(m.uv[0], [Vec2::splat(0.5); 3]);
    // 0.25 + ½ (1, ½, 0), the displacement's alpha with the base's of 1.
    assert_eq!(m.colors, [Vec4::new(0.75, 0.5, 0.25, 0.75); 3]);

    // The node's weights count before the mesh's; each set of weights is a shape.
    d.set("/nodes", json!([{ "mesh": 0 }, { "mesh": 0, "weights": [1, 0] }, { "mesh": 0, "weights": [0.5, 0.25] }]));
    d.set("/scenes/0/nodes", json!([0, 1, 2]));
    let scene = d.read().unwrap();
    assert_eq!(scene.objects.iter().map(|o| o.shape).collect::<Vec<_>>(), [0, 1, 0]);
    assert_eq!(mesh(&scene, 1).positions[2], Vec3::new(0.0, 1.0, 2.0));
}

#[test]
fn weights_are_animated() {
    let mut d = morphed();
    animate(&mut d, node("weights"), "LINEAR", &[0.0, 2.0], 1, &[0.0, 0.0, 1.0, 0.5]);
    let m = mesh(&at(&d, 1.0).unwrap(), 0).clone();
    assert_eq!(m.positions, [Vec3::ZERO, 2.0 * Vec3::X, Vec3::new(0.0, 1.0, 1.0)]);
    // One of them through a pointer, beside the other of the mesh.
    let mut d = morphed();
    d.set("/meshes/0/weights", json!([0.0, 0.25]));
    animate(&mut d, pointer("/nodes/0/weights/0"), "STEP", &[0.0], 1, &[0.5]);
    assert_eq!(mesh(&at(&d, 0.0).unwrap(), 0).positions, m.positions);
}

#[test]
fn targets_that_are_wrong() {
    let place = "/meshes/0/primitives/0/targets/0/POSITION";
    let mut d = morphed();
    d.set("/meshes/0/weights", json!([1.0]));
    let short = d.accessor(F32, "VEC3", 2, &[0; 24]);
    let huge = d.accessor(F32, "VEC3", 3, &bytes_of(&[3e38; 9]));
    d.clone().set(place, json!(short)).fails(place, "has 2 elements; expected 3");
    d.clone().set(place, json!(99)).fails(place, "refers to accessor 99");
    d.clone()
        .set("/meshes/0/weights", json!([10.0]))
        .set(place, json!(huge))
        .fails("/meshes/0/primitives/0/targets", "expected finite numbers");
    d.clone().set("/nodes/0/weights", json!([1e39])).fails("/nodes/0/weights", "element 0 is inf");
    let color = "/meshes/0/primitives/0/targets/0/COLOR_0";
    d.clone().set(color, json!("x")).fails(color, "expected the index of an accessor");
}

#[test]
fn animations_that_are_wrong() {
    let mut good = Document::triangle();
    animate(&mut good, node("translation"), "LINEAR", &[0.0, 1.0, 2.0], 3, &[0.0; 9]);
    let sampler = "/animations/0/samplers/0";
    for (pointer, value, place, says) in [
        ("/animations", json!({}), "", ""),
        ("/animations", json!([7]), "/animations/0", "invalid type"),
        ("/animations/0/channels/0/sampler", json!(3), "/animations/0/channels/0/sampler", "sampler 3"),
        ("/animations/0/channels/0/target/path", json!("colour"), "/animations/0/channels/0/target", "\"colour\""),
        (
            "/animations/0/channels/0/target/path",
            json!("pointer"),
            "/animations/0/channels/0/target",
            "KHR_animation_pointer/pointer",
        ),
        ("/animations/0/channels/0/target/path", json!("rotation"), "/animations/0/samplers/0/output", "expected VEC4"),
        ("/animations/0/samplers/0/input", json!(9), "/animations/0/samplers/0/input", "accessor 9"),
        ("/animations/0/samplers/0/output", json!(1), "/animations/0/samplers/0/output", "expected VEC3"),
        (
            "/animations/0/samplers/0/interpolation",
            json!("CUBICSPLINE"),
            "/animations/0/samplers/0/output",
            "3 elements for 3 times",
        ),
        ("/animations/0/samplers/0/interpolation", json!("SINE"), "/animations/0", "SINE"),
        ("/accessors/2/count", json!(2), "/animations/0/samplers/0/output", "2 elements for 3 times"),
    ] {
        let mut d = good.clone();
        d.set(pointer, value);
        match at(&d, 0.5) {
            Err(e) => assert!(e.place == place && e.message.contains(says), "{pointer}: {e}"),
            Ok(_) => assert!(place.is_empty(), "{pointer}"),
        }
    }
    let mut d = Document::triangle();
    animate(&mut d, node("translation"), "LINEAR", &[0.0, 0.0], 3, &[0.0; 6]);
    let e = at(&d, 0.5).unwrap_err();
    assert!(e.place == format!("{sampler}/input") && e.message.contains("times that increase"), "{e}");
    // A file that is not asked for a time does not care.
    assert!(parse(&d.glb()).is_ok());
}
