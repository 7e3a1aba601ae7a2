//! Nodes, scenes, cameras, lights.

use super::document::{Document, noted};
use glam::{Mat4, Quat, Vec3};
use radianza::desc::{Fov, Light, Projection};
use radianza::glam;
use serde_json::json;
use std::f32::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

/// A quarter turn about y as the document writes it: −z becomes −x.
const TURN: [f32; 4] = [0.0, FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2];

#[test]
fn transforms_multiply_along_the_path() {
    let mut d = Document::triangle();
    let matrix = Mat4::from_rotation_x(0.5).to_cols_array();
    d.set("/nodes", json!([{ "name": "leaf", "mesh": 0, "scale": [1, 2, -3] },
        { "children": [0], "matrix": matrix }, { "children": [1], "translation": [5, 6, 7], "rotation": TURN, "scale": [2, 2, 2] }]));
    d.set("/scenes/0/nodes", json!([2]));
    let scene = d.read().unwrap();
    let root =
        Mat4::from_scale_rotation_translation(Vec3::splat(2.0), Quat::from_array(TURN), Vec3::new(5.0, 6.0, 7.0));
    let expected = root * Mat4::from_rotation_x(0.5) * Mat4::from_scale(Vec3::new(1.0, 2.0, -3.0));
    let o = &scene.objects[0];
    assert!(o.to_world.abs_diff_eq(expected, 1e-5), "{}", o.to_world);
    assert_eq!((o.name.as_str(), o.reversed, o.emission), ("leaf", false, None));
}

#[test]
fn the_default_scene_the_first_or_all_roots() {
    let mut d = Document::triangle();
    d.set(
        "/nodes",
        json!([{ "mesh": 0, "name": "a" }, { "mesh": 0, "name": "b", "children": [2] }, { "mesh": 0, "name": "c" }]),
    );
    d.set("/scenes", json!([{ "nodes": [0] }, { "nodes": [1] }]));
    let names = |d: &Document| d.read().unwrap().objects.iter().map(|o| o.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&d), ["a"]);
    assert!(noted(&d.read().unwrap(), "of 2 scenes, number 0 is read"));
    d.set("/scene", json!(1));
    assert_eq!(names(&d), ["b", "c"]);
    d.remove("/scene");
    assert_eq!(names(&d), ["a"]);
    d.remove("/scenes");
    assert_eq!(names(&d), ["a", "b", "c"]);
}

#[test]
fn objects_take_their_name_from_node_mesh_or_number() {
    let mut d = Document::triangle();
    assert_eq!(d.read().unwrap().objects[0].name, "node 0");
    d.set("/meshes/0/name", json!("mesh"));
    assert_eq!(d.read().unwrap().objects[0].name, "mesh");
    d.set("/nodes/0/name", json!("node"));
    assert_eq!(d.read().unwrap().objects[0].name, "node");
}

#[test]
fn what_is_scaled_to_nothing_is_left_out() {
    let mut d = Document::triangle();
    d.set("/nodes/0/scale", json!([0, 0, 0]));
    d.set("/nodes/0/camera", json!(0));
    d.set("/cameras", json!([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 1 } }]));
    let scene = d.read().unwrap();
    assert!(scene.objects.is_empty() && scene.cameras.is_empty());
    assert!(noted(&scene, "objects that are scaled to nothing") && noted(&scene, "cameras that are scaled to nothing"));
}

#[test]
fn cameras_lose_their_scale() {
    let mut d = Document::triangle();
    d.set(
        "/cameras",
        json!([
        { "type": "perspective", "perspective": { "yfov": 0.8, "aspectRatio": 1.5, "znear": 0.1 }, "name": "lens" },
        { "type": "orthographic", "orthographic": { "xmag": 4, "ymag": 2, "znear": 0, "zfar": 9 } }]),
    );
    d.set(
        "/nodes",
        json!([{ "camera": 0, "translation": [1, 2, 3], "rotation": TURN, "scale": [2, 3, 4] },
        { "camera": 1, "name": "flat" }, { "camera": 0, "scale": [-1, 1, 1] }]),
    );
    d.set("/scenes/0/nodes", json!([0, 1, 2]));
    let scene = d.read().unwrap();
    let [a, b, c] = &scene.cameras[..] else { panic!("{:?}", scene.cameras) };
    let expected = Mat4::from_rotation_translation(Quat::from_array(TURN), Vec3::new(1.0, 2.0, 3.0));
    assert!(a.to_world.abs_diff_eq(expected, 1e-6), "{}", a.to_world);
    assert!(a.to_world.transform_vector3(-Vec3::Z).abs_diff_eq(-Vec3::X, 1e-6));
    assert_eq!(a.projection, Projection::Perspective { fov: Fov::Vertical(0.8) });
    assert_eq!((a.aspect, a.resolution, a.lens, a.name.as_str()), (Some(1.5), None, None, "lens"));
    assert_eq!(b.projection, Projection::Orthographic { half_height: 2.0 });
    assert_eq!((b.aspect, b.name.as_str(), b.to_world), (Some(2.0), "flat", Mat4::IDENTITY));
    assert!(c.to_world.abs_diff_eq(Mat4::IDENTITY, 1e-6), "{}", c.to_world);
    assert!(noted(&scene, "not mirrored"));
}

#[test]
fn lights_stand_in_the_world() {
    let mut d = Document::triangle();
    d.set(
        "/extensions/KHR_lights_punctual/lights",
        json!([
        { "type": "point", "intensity": 10, "color": [1, 0.5, 0], "range": 7 },
        { "type": "spot", "intensity": 2, "spot": { "innerConeAngle": 0.2, "outerConeAngle": 0.4 } },
        { "type": "directional" },
        { "type": "spot", "spot": {} }]),
    );
    let node = |light: usize| {
        json!({ "extensions": { "KHR_lights_punctual": { "light": light } }, "scale": [3, 3, 3],
        "translation": [1, 2, 3], "rotation": TURN })
    };
    d.set("/nodes", json!([node(0), node(1), node(2), node(3)]));
    d.set("/scenes/0/nodes", json!([0, 1, 2, 3]));
    d.set("/extensionsUsed", json!(["KHR_lights_punctual"]));
    d.set("/extensionsRequired", json!(["KHR_lights_punctual"]));
    let scene = d.read().unwrap();
    let [point, spot, sun, wide] = &scene.lights[..] else { panic!("{:?}", scene.lights) };
    let at = Vec3::new(1.0, 2.0, 3.0);
    assert_eq!(*point, Light::Point { position: at, intensity: [10.0, 5.0, 0.0], range: 7.0 });
    let Light::Spot { position, direction, intensity, inner, outer, range } = *spot else { panic!("{spot:?}") };
    assert_eq!((position, intensity, inner, outer, range), (at, [2.0; 3], 0.2, 0.4, f32::INFINITY));
    assert!(direction.abs_diff_eq(-Vec3::X, 1e-6), "{direction}");
    let Light::Directional { direction, irradiance } = *sun else { panic!("{sun:?}") };
    assert!(direction.abs_diff_eq(-Vec3::X, 1e-6) && irradiance == [1.0; 3]);
    assert!(matches!(wide, Light::Spot { inner: 0.0, outer, .. } if (outer - FRAC_PI_2 / 2.0).abs() < 1e-6));
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    d.set("/extensions/KHR_lights_punctual/lights/0/range", json!(0));
    assert!(noted(&d.read().unwrap(), "ranges that are not positive are ignored"));
}

#[test]
fn cone_angles_are_put_in_order() {
    let mut d = Document::triangle();
    d.set(
        "/extensions/KHR_lights_punctual/lights",
        json!([{ "type": "spot", "spot": { "innerConeAngle": 1, "outerConeAngle": 0.5 } }]),
    );
    d.set("/nodes/0/extensions/KHR_lights_punctual/light", json!(0));
    let scene = d.read().unwrap();
    assert!(
        matches!(scene.lights[0], Light::Spot { inner: 0.5, outer: 0.5, .. }) && noted(&scene, "inner cone angles")
    );
    let spot = "/extensions/KHR_lights_punctual/lights/0/spot";
    d.set(&format!("{spot}/outerConeAngle"), json!(0)).fails(&format!("{spot}/outerConeAngle"), "positive");
    d.remove(spot).fails(spot, "cone angles");
}

#[test]
fn a_deep_chain_of_nodes_is_walked() {
    let mut d = Document::triangle();
    let depth = 50_000;
    let mut nodes: Vec<_> = (1..depth).map(|i| json!({ "children": [i] })).collect();
    nodes.push(json!({ "mesh": 0 }));
    d.set("/nodes", json!(nodes));
    assert_eq!(d.read().unwrap().objects.len(), 1);
}
