//! Skins and instances.

use super::document::{Document, F32, U8, U16, bytes_of, mesh, noted};
use super::pose::at;
use glam::{Mat4, Quat, Vec3};
use radianza::glam;
use serde_json::json;
use std::f32::consts::FRAC_1_SQRT_2;

/// An arm along y of two bones, the elbow at y = 1, bent by a quarter turn about z; the mesh hangs on a node far away.
/// Vertices: shoulder, elbow (half and half), hand, and a finger.
fn arm() -> Document {
    let mut d = Document::mesh(&[[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 2.0, 0.0], [1.0, 2.0, 0.0]]);
    d.attribute("NORMAL", "VEC3", &[[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    d.indices(U8, &[0, 3, 1, 1, 3, 2]);
    let joints = d.accessor(U8, "VEC4", 4, &[0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]);
    let weights: Vec<f32> =
        [[1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]].concat();
    let weights = d.accessor(F32, "VEC4", 4, &bytes_of(&weights));
    let bind = [Mat4::IDENTITY, Mat4::from_translation(-Vec3::Y)].map(|m| m.to_cols_array()).concat();
    let bind = d.accessor(F32, "MAT4", 2, &bytes_of(&bind));
    d.set("/meshes/0/primitives/0/attributes/JOINTS_0", json!(joints));
    d.set("/meshes/0/primitives/0/attributes/WEIGHTS_0", json!(weights));
    d.set("/skins", json!([{ "joints": [1, 2], "inverseBindMatrices": bind }]));
    d.set(
        "/nodes",
        json!([{ "mesh": 0, "skin": 0, "translation": [50, 60, 70] }, { "children": [2] },
        { "translation": [0, 1, 0], "rotation": [0, 0, FRAC_1_SQRT_2, FRAC_1_SQRT_2] }]),
    );
    d.set("/scenes/0/nodes", json!([0, 1]));
    d
}

#[test]
fn two_bones_bend_to_known_places() {
    let scene = arm().read().unwrap();
    let m = mesh(&scene, 0);
    assert_eq!(scene.objects[0].to_world, Mat4::IDENTITY);
    for (found, expected) in
        m.positions.iter().zip([Vec3::ZERO, Vec3::Y, Vec3::new(-1.0, 1.0, 0.0), Vec3::new(-1.0, 2.0, 0.0)])
    {
        assert!(found.abs_diff_eq(expected, 1e-6), "{found} {expected}");
    }
    // The elbow's matrix is the mean of identity and quarter turn; its inverse transpose takes x to (1, 1)/√2.
    for (found, expected) in m.normals.iter().zip([Vec3::X, Vec3::new(1.0, 1.0, 0.0).normalize(), Vec3::Y, -Vec3::X]) {
        assert!(found.abs_diff_eq(expected, 1e-6), "{found} {expected}");
    }
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
}

#[test]
fn a_stretched_bone_turns_normals_by_the_inverse_transpose() {
    let mut d = arm();
    d.set("/nodes/2/rotation", json!([0, 0, 0, 1])).set("/nodes/2/scale", json!([2, 1, 1]));
    d.attribute("NORMAL", "VEC3", &[[0.6, 0.8, 0.0]; 4]);
    let m = d.read_mesh();
    assert!(m.normals[0].abs_diff_eq(Vec3::new(0.6, 0.8, 0.0), 1e-6));
    assert!(m.normals[2].abs_diff_eq(Vec3::new(0.3, 0.8, 0.0).normalize(), 1e-6), "{}", m.normals[2]);
}

#[test]
fn mirrored_bones_keep_the_outside_outside() {
    let mut d = arm();
    d.set("/nodes/1/scale", json!([-1, 1, 1])).set("/nodes/2/rotation", json!([0, 0, 0, 1]));
    let (m, twin) = (d.read_mesh(), arm().set("/nodes/2/rotation", json!([0, 0, 0, 1])).read_mesh());
    let normal = |m: &radianza::desc::Mesh, t: usize| {
        let [a, b, c] = m.indices[t].map(|i| m.positions[i as usize]);
        (b - a).cross(c - a)
    };
    for t in 0..2 {
        assert!(normal(&m, t).dot(normal(&twin, t)) > 0.0);
    }
    assert!(m.normals[0].abs_diff_eq(-Vec3::X, 1e-6));
}

#[test]
fn bones_are_animated_and_weights_may_be_integers() {
    let mut d = arm();
    let input = d.accessor(F32, "SCALAR", 2, &bytes_of(&[0.0, 1.0]));
    let turn = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2).to_array();
    let output = d.accessor(F32, "VEC4", 2, &bytes_of(&[[0.0, 0.0, 0.0, 1.0], turn].concat()));
    d.set(
        "/animations",
        json!([{ "channels": [{ "sampler": 0, "target": { "node": 2, "path": "rotation" } }],
        "samplers": [{ "input": input, "output": output }] }]),
    );
    let hand = |time| mesh(&at(&d, time).unwrap(), 0).positions[2];
    assert!(hand(0.0).abs_diff_eq(2.0 * Vec3::Y, 1e-6));
    assert!(hand(0.5).abs_diff_eq(Vec3::new(-FRAC_1_SQRT_2, 1.0 + FRAC_1_SQRT_2, 0.0), 1e-6), "{}", hand(0.5));

    let mut d = arm();
    let joints =
        d.accessor(U16, "VEC4", 4, &[0u16, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0].map(u16::to_le_bytes).concat());
    let weights = d.accessor(U8, "VEC4", 4, &[255, 0, 0, 0, 128, 127, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0]);
    d.set(&format!("/accessors/{weights}/normalized"), json!(true));
    d.set("/meshes/0/primitives/0/attributes/JOINTS_0", json!(joints));
    d.set("/meshes/0/primitives/0/attributes/WEIGHTS_0", json!(weights));
    let scene = d.read().unwrap();
    let m = mesh(&scene, 0);
    assert!(m.positions[2].abs_diff_eq(Vec3::new(-1.0, 1.0, 0.0), 1e-6));
    assert!(m.positions[3].abs_diff_eq(Vec3::new(-1.0, 2.0, 0.0), 1e-6) && noted(&scene, "vertices without weights"));
}

#[test]
fn a_second_set_of_joints_counts_too() {
    let mut d = arm();
    let weights = d.accessor(F32, "VEC4", 4, &bytes_of(&[1.0, 0.0, 0.0, 0.0].repeat(4)));
    let joints = d.accessor(U8, "VEC4", 4, &[0; 16]);
    d.set("/meshes/0/primitives/0/attributes/JOINTS_1", json!(joints));
    d.set("/meshes/0/primitives/0/attributes/WEIGHTS_1", json!(weights));
    let scene = d.read().unwrap();
    // Half the hand stays where it is.
    assert!(mesh(&scene, 0).positions[2].abs_diff_eq(Vec3::new(-0.5, 1.5, 0.0), 1e-6));
    assert!(noted(&scene, "scaled to do so"));
}

#[test]
fn skins_that_are_wrong() {
    let joints = "/meshes/0/primitives/0/attributes/JOINTS_0";
    let mut d = arm();
    let far = d.accessor(U8, "VEC4", 4, &[9; 16]);
    let floats = d.accessor(F32, "VEC4", 4, &[0; 64]);
    let negative = d.accessor(F32, "VEC4", 4, &bytes_of(&[-1.0; 16]));
    let few = d.accessor(F32, "MAT4", 1, &[0; 64]);
    d.clone().set(joints, json!(far)).fails(joints, "vertex 0 has the joint 9; the skin has 2");
    d.clone().set(joints, json!(floats)).fails(joints, "VEC4 of f32; expected VEC4 of u8");
    let weights = "/meshes/0/primitives/0/attributes/WEIGHTS_0";
    d.clone().set(weights, json!(negative)).fails(weights, "none below 0");
    d.clone().set("/skins/0/inverseBindMatrices", json!(few)).fails("/skins/0/inverseBindMatrices", "has 1 elements");
    d.clone().set("/skins/0/joints/1", json!(9)).fails("/skins/0/joints/1", "node 9");
    d.clone().set("/scenes/0/nodes", json!([0])).fails("/skins/0/joints/0", "not in the scene");
    d.clone().set("/nodes/0/skin", json!(4)).fails("/nodes/0/skin", "refers to skin 4");
    d.remove(joints);
    assert!(noted(&d.read().unwrap(), "do not follow their skin"));
}

/// Two instances of the triangle.
fn instanced() -> Document {
    let mut d = Document::triangle();
    let translation = d.accessor(F32, "VEC3", 2, &bytes_of(&[1.0, 0.0, 0.0, 0.0, 5.0, 0.0]));
    let rotation = d.accessor(5122, "VEC4", 2, &[0i16, 0, 0, 32767, 0, 0, 32767, 0].map(i16::to_le_bytes).concat());
    let scale = d.accessor(F32, "VEC3", 2, &bytes_of(&[1.0, 2.0, 3.0, -1.0, 1.0, 1.0]));
    d.set(&format!("/accessors/{rotation}/normalized"), json!(true));
    d.set(
        "/nodes/0",
        json!({ "mesh": 0, "translation": [0, 0, 9], "extensions": { "EXT_mesh_gpu_instancing": {
        "attributes": { "TRANSLATION": translation, "ROTATION": rotation, "SCALE": scale } } } }),
    );
    d
}

/// The arm moves by morph targets and bones; two instances of it without a skin hang on the hand.
pub(crate) fn moving() -> Document {
    let mut d = arm();
    let times = d.accessor(F32, "SCALAR", 2, &bytes_of(&[0.0, 1.0]));
    let turn = d.accessor(F32, "VEC4", 2, &bytes_of(&[0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]));
    let weights = d.accessor(F32, "SCALAR", 6, &bytes_of(&[0.0, 0.0, 1.0, 1.0, 1.0, 0.0]));
    let lift = d.accessor(F32, "VEC3", 4, &bytes_of(&[0.1; 12]));
    let places = d.accessor(F32, "VEC3", 2, &bytes_of(&[1.0, 0.0, 0.0, 0.0, 5.0, 0.0]));
    d.set("/meshes/0/primitives/0/targets", json!([{ "POSITION": lift, "NORMAL": lift }]));
    d.set("/meshes/0/weights", json!([0.5]));
    d.set("/nodes/2/children", json!([3]));
    d.set(
        "/nodes/3",
        json!({ "mesh": 0, "extensions": { "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } } }),
    );
    let pointer = json!({ "KHR_animation_pointer": { "pointer": "/nodes/2/rotation" } });
    d.set("/animations", json!([{
        "channels": [{ "sampler": 0, "target": { "path": "pointer", "extensions": pointer } },
            { "sampler": 1, "target": { "node": 0, "path": "weights" } }],
        "samplers": [{ "input": times, "output": turn }, { "input": times, "output": weights, "interpolation": "CUBICSPLINE" }] }]));
    d
}

#[test]
fn instances_stand_where_they_say() {
    let scene = instanced().read().unwrap();
    assert_eq!((scene.shapes.len(), scene.objects.len()), (1, 2));
    let [a, b] = [0, 1].map(|i| scene.objects[i].to_world);
    let expected = Mat4::from_translation(Vec3::new(1.0, 0.0, 9.0)) * Mat4::from_scale(Vec3::new(1.0, 2.0, 3.0));
    assert!(a.abs_diff_eq(expected, 1e-6), "{a}");
    let half = Mat4::from_rotation_z(std::f32::consts::PI) * Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    assert!(b.abs_diff_eq(Mat4::from_translation(Vec3::new(0.0, 5.0, 9.0)) * half, 1e-6), "{b}");
}

#[test]
fn instances_that_are_wrong() {
    let place = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes";
    let mut d = instanced();
    let one = d.accessor(F32, "VEC3", 1, &[0; 12]);
    let zero = d.accessor(F32, "VEC4", 2, &[0; 32]);
    d.clone().set(&format!("{place}/SCALE"), json!(one)).fails(place, "have 2 and 1 elements");
    d.clone().set(&format!("{place}/ROTATION"), json!(zero)).fails(&format!("{place}/ROTATION"), "unit quaternion");
    d.clone().set(&format!("{place}/SCALE"), json!(77)).fails(&format!("{place}/SCALE"), "accessor 77");
    d.clone().set(&format!("{place}/SCALE"), json!(zero)).fails(&format!("{place}/SCALE"), "expected VEC3");
    d.clone().set(place, json!({})).fails(place, "has none of");
    d.clone().set("/nodes/0/name", json!("x".repeat(1 << 20))).read().unwrap();
    d.set(&format!("{place}/_ID"), json!(0));
    assert!(noted(&d.read().unwrap(), "that do not place them"));
}
