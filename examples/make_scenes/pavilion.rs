//! A garden pavilion as binary glTF: meshes that many nodes share, embedded textures, a camera and two lights.

use super::glb::Builder;
use super::lathe::{cuboid, lathe};
use super::{Result, textures};
use glam::{Vec3, vec3};
use serde_json::json;
use std::f32::consts::TAU;

/// Columns of the ring.
const COLUMNS: u32 = 10;

/// The file.
pub(super) fn pavilion() -> Result<Vec<u8>> {
    let mut file = Builder::default();
    let planks = file.texture(&textures::planks(128))?;
    let rug = file.texture(&textures::rug(64))?;
    let worn = file.texture(&textures::scratches(64))?;

    // Materials.
    let stone = file.material(json!({ "name": "stone", "pbrMetallicRoughness": {
        "baseColorFactor": [0.78, 0.74, 0.66, 1], "metallicFactor": 0, "roughnessFactor": 0.7 } }));
    let wood = file.material(json!({ "name": "wood", "pbrMetallicRoughness": {
        "baseColorTexture": { "index": planks }, "metallicFactor": 0, "roughnessFactor": 0.45 } }));
    let tiles = file.material(json!({ "name": "tiles", "pbrMetallicRoughness": {
        "baseColorTexture": { "index": rug, "extensions": { "KHR_texture_transform": { "scale": [6, 2] } } },
        "metallicFactor": 0, "roughnessFactor": 0.3 } }));
    let copper = file.material(json!({ "name": "copper", "pbrMetallicRoughness": {
        "baseColorFactor": [0.93, 0.62, 0.52, 1], "metallicRoughnessTexture": { "index": worn } } }));
    let leaves = file.material(json!({ "name": "leaves", "pbrMetallicRoughness": {
        "baseColorFactor": [0.1, 0.22, 0.06, 1], "metallicFactor": 0, "roughnessFactor": 0.9 } }));
    let glass = file.material(json!({ "name": "glass", "pbrMetallicRoughness": {
        "metallicFactor": 0, "roughnessFactor": 0 },
        "extensions": { "KHR_materials_transmission": { "transmissionFactor": 1 },
                        "KHR_materials_ior": { "ior": 1.5 }, "KHR_materials_volume": { "thicknessFactor": 1 } } }));

    let lantern = file.material(json!({ "name": "lantern", "emissiveFactor": [1, 0.74, 0.45],
        "pbrMetallicRoughness": { "baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0 },
        "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 60 } } }));

    // Meshes.
    let column = [[0.26, 0.0], [0.26, 0.12], [0.2, 0.2], [0.17, 2.6], [0.24, 2.72], [0.24, 2.85]];
    let column = file.mesh("column", &lathe(&column, 40, 10.0), stone);
    let step = file.mesh("step", &lathe(&[[3.4, 0.0], [3.4, 0.15], [0.0, 0.15]], 64, 0.0), stone);
    let floor = file.mesh("floor", &lathe(&[[2.2, 0.0], [0.0, 0.0]], 48, 0.0), tiles);
    let dome: Vec<[f32; 2]> = (0..=12)
        .map(|i| {
            let (sin, cos) = (TAU / 4.0 * i as f32 / 12.0).sin_cos();
            [3.0 * cos, 1.5 * sin]
        })
        .collect();
    let dome = file.mesh("dome", &lathe(&dome, 48, 0.0), copper);
    let ceiling = file.mesh("ceiling", &lathe(&[[0.0, 0.0], [3.0, 0.0]], 48, 0.0), wood);
    let ball: Vec<[f32; 2]> = (0..=24)
        .map(|i| {
            let (sin, cos) = (TAU / 2.0 * i as f32 / 24.0).sin_cos();
            [0.4 * sin, -0.4 * cos]
        })
        .collect();
    let gold = file.mesh("ball", &lathe(&ball, 48, 0.0), copper);
    let light =
        file.mesh("lantern", &lathe(&[[0.0, -0.16], [0.12, -0.05], [0.12, 0.05], [0.0, 0.16]], 16, 0.0), lantern);
    let crystal = file.mesh("crystal", &cuboid(Vec3::splat(-0.3), Vec3::splat(0.3)), glass);
    let bench = file.mesh("bench", &cuboid(vec3(-0.8, 0.0, -0.25), vec3(0.8, 0.45, 0.25)), wood);
    let tree = file.mesh(
        "tree",
        &lathe(&[[0.9, 0.4], [0.5, 1.6], [0.7, 1.6], [0.3, 2.8], [0.4, 2.8], [0.0, 4.2]], 9, 0.0),
        leaves,
    );

    // Nodes: the ring of columns and the trees are one mesh each, placed many times.
    let mut roots = Vec::new();
    for i in 0..COLUMNS {
        let angle = TAU * (i as f32 + 0.5) / COLUMNS as f32;
        let (sin, cos) = angle.sin_cos();
        roots.push(file.node(json!({ "mesh": column, "translation": [2.7 * cos, 0.15, 2.7 * sin] })));
    }
    for i in 0..9 {
        let angle = TAU * i as f32 / 9.0 + 0.2;
        let (distance, size) = (8.0 + 1.7 * (i % 3) as f32, 0.9 + 0.15 * (i % 4) as f32);
        let (sin, cos) = angle.sin_cos();
        // The view stays free.
        if sin < 0.6 {
            let at = [distance * cos, -0.3, distance * sin];
            let (s, c) = (0.35 * i as f32).sin_cos();
            roots.push(file.node(
                json!({ "mesh": tree, "translation": at, "scale": [size, size, size], "rotation": [0, s, 0, c] }),
            ));
        }
    }
    for (mesh, at) in [
        (step, [0.0, 0.0, 0.0]),
        (floor, [0.0, 0.152, 0.0]),
        (dome, [0.0, 3.0, 0.0]),
        (ceiling, [0.0, 3.0, 0.0]),
        (gold, [0.0, 4.85, 0.0]),
        (gold, [-0.7, 0.56, 0.3]),
        (crystal, [0.5, 0.46, 0.7]),
        (light, [0.0, 2.3, 0.0]),
        (bench, [0.0, 0.16, -1.2]),
    ] {
        roots.push(file.node(json!({ "mesh": mesh, "translation": at })));
    }

    // A camera that looks up a little, and a lamp beside the path.
    let camera = json!({ "camera": 0, "name": "path", "translation": [2.4, 1.7, 9.5],
        "rotation": quaternion(0.24, 0.03) });
    roots.push(file.node(camera));
    let lamp = json!({ "name": "lamp", "translation": [-1.6, 0.9, 4.6],
        "extensions": { "KHR_lights_punctual": { "light": 0 } } });
    roots.push(file.node(lamp));
    let lamp = json!({ "type": "point", "color": [1, 0.7, 0.42], "intensity": 5 });
    let view = json!({ "yfov": 0.66, "aspectRatio": 1.5, "znear": 0.1 });
    file.finish(&roots, &view, json!({ "KHR_lights_punctual": { "lights": [lamp] } }))
}

/// Turn about y by `yaw`, then up by `pitch` \[rad\]: x, y, z, w.
fn quaternion(yaw: f32, pitch: f32) -> [f32; 4] {
    (glam::Quat::from_rotation_y(yaw) * glam::Quat::from_rotation_x(pitch)).to_array()
}
