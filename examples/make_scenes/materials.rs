//! A small scene for each glTF extension that shows in the picture: balls between two lamps on a chequered floor.

use super::Result;
use super::glb::Builder;
use super::lathe::{Mesh, cuboid, lathe};
use super::textures;
use glam::{Vec3, vec3};
use image::{Rgb, RgbImage};
use serde_json::{Value, json};
use std::f32::consts::{FRAC_PI_2, PI};

/// Names and files.
pub(super) fn all() -> Result<Vec<(&'static str, Vec<u8>)>> {
    let plain = |name: &'static str, extension: Value| (name, plain(name, extension));
    let scenes: Vec<(&'static str, Result<Vec<u8>>)> = vec![
        ("anisotropy", {
            let metal = |rotation: f32| {
                json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.9, 0.75, 0.6, 1], "roughnessFactor": 0.35 },
                    "extensions": { "KHR_materials_anisotropy": {
                        "anisotropyStrength": 0.9, "anisotropyRotation": rotation } } })
            };
            pair("anisotropy", metal(0.0), metal(FRAC_PI_2))
        }),
        ("clearcoat", clearcoat()),
        ("diffuse-transmission", diffuse_transmission()),
        ("dispersion", dispersion()),
        plain("emissive-strength", json!({ "KHR_materials_emissive_strength": { "emissiveStrength": 4 } })),
        plain("ior", json!({ "KHR_materials_ior": { "ior": 2.2 } })),
        ("iridescence", {
            let film = json!({ "KHR_materials_iridescence": { "iridescenceFactor": 1, "iridescenceIor": 1.8,
                "iridescenceThicknessMinimum": 200, "iridescenceThicknessMaximum": 420 } });
            let steel = json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.6, 0.6, 0.6, 1], "roughnessFactor": 0.2 },
                "extensions": film.clone() });
            let paint = json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.05, 0.05, 0.06, 1],
                "metallicFactor": 0, "roughnessFactor": 0.1 }, "extensions": film });
            pair("iridescence", steel, paint)
        }),
        ("lights-punctual", lamps()),
        ("sheen", {
            let cloth = |roughness: f32| {
                json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.15, 0.02, 0.03, 1], "metallicFactor": 0,
                        "roughnessFactor": 0.9 }, "extensions": { "KHR_materials_sheen": {
                        "sheenColorFactor": [0.9, 0.7, 0.6], "sheenRoughnessFactor": roughness } } })
            };
            pair("sheen", cloth(0.3), cloth(0.7))
        }),
        plain(
            "specular",
            json!({ "KHR_materials_specular": {
            "specularFactor": 0.9, "specularColorFactor": [8, 2, 0.5] } }),
        ),
        ("specular-glossiness", {
            let model = json!({ "KHR_materials_pbrSpecularGlossiness": { "diffuseFactor": [0.1, 0.3, 0.1, 1],
                "specularFactor": [0.6, 0.4, 0.1], "glossinessFactor": 0.7 } });
            pair("specular-glossiness", json!({ "extensions": model }), white())
        }),
        ("texture-transform", moved_texture()),
        ("transmission", {
            let sheet = |roughness: f32| {
                json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.6, 0.9, 0.7, 1], "metallicFactor": 0,
                        "roughnessFactor": roughness },
                    "extensions": { "KHR_materials_transmission": { "transmissionFactor": 0.9 } } })
            };
            pair("transmission", sheet(0.0), sheet(0.4))
        }),
        plain("unlit", json!({ "KHR_materials_unlit": {} })),
        ("variants", variants()),
        ("volume", {
            let glass = |distance: f32| {
                json!({ "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0 }, "extensions": {
                    "KHR_materials_transmission": { "transmissionFactor": 1 }, "KHR_materials_ior": { "ior": 1.3 },
                    "KHR_materials_volume": { "thicknessFactor": 1, "attenuationDistance": distance,
                        "attenuationColor": [0.9, 0.4, 0.1] } } })
            };
            pair("volume", glass(1.0), glass(0.25))
        }),
    ];
    scenes.into_iter().map(|(name, file)| Ok((name, file?))).collect()
}

/// White paint.
fn white() -> Value {
    json!({ "name": "white", "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0.5 } })
}

/// A ball of paint with this extension, and one without.
fn plain(name: &str, extension: Value) -> Result<Vec<u8>> {
    let paint = |extensions: Value| {
        json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.2, 0.25, 0.6, 1], "metallicFactor": 0,
                "roughnessFactor": 0.25 }, "emissiveFactor": [0.05, 0.02, 0.1], "extensions": extensions })
    };
    pair(name, paint(json!({})), paint(extension))
}

/// Two balls side by side.
fn pair(name: &str, left: Value, right: Value) -> Result<Vec<u8>> {
    let (mut file, mut roots) = studio(json!({ "scale": [3, 3] }))?;
    let ball = ball(0.55);
    for (side, (label, mut material)) in [(-0.6, ("left", left)), (0.6, ("right", right))] {
        material["name"] = json!(format!("{name}, {label}"));
        let material = file.material(material);
        let mesh = file.mesh(label, &ball, material);
        roots.push(file.node(json!({ "mesh": mesh, "translation": [side, 0.55, 0] })));
    }
    finish(file, &roots, json!({}))
}

/// A floor, two lamps, a camera.
fn studio(transform: Value) -> Result<(Builder, Vec<usize>)> {
    let mut file = Builder::default();
    let square = |x: u32, y: u32| Rgb(if (x / 8 + y / 8).is_multiple_of(2) { [210; 3] } else { [90, 95, 100] });
    let squares = RgbImage::from_fn(64, 64, square);
    let squares = file.texture(&squares)?;
    let floor = file.material(json!({ "name": "floor", "pbrMetallicRoughness": {
        "baseColorTexture": { "index": squares, "extensions": { "KHR_texture_transform": transform } },
        "metallicFactor": 0, "roughnessFactor": 0.8 } }));
    let lamp = |strength: f32, color: [f32; 3]| {
        json!({ "name": "lamp", "emissiveFactor": color, "pbrMetallicRoughness": { "baseColorFactor": [0, 0, 0, 1],
            "metallicFactor": 0 }, "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": strength } } })
    };
    let (key, fill) = (file.material(lamp(6.0, [1.0, 0.95, 0.85])), file.material(lamp(2.0, [0.6, 0.75, 1.0])));
    let floor = file.mesh("floor", &cuboid(vec3(-4.0, -0.1, -4.0), vec3(4.0, 0.0, 4.0)), floor);
    let key = file.mesh("key", &cuboid(vec3(-1.0, 3.0, 0.0), vec3(1.0, 3.1, 2.0)), key);
    let fill = file.mesh("fill", &cuboid(vec3(-3.4, 0.4, -1.5), vec3(-3.3, 2.4, 1.5)), fill);
    let mut roots: Vec<usize> = [floor, key, fill].map(|mesh| file.node(json!({ "mesh": mesh }))).into();
    let tilt = glam::Quat::from_rotation_x(-0.24).to_array();
    roots.push(file.node(json!({ "camera": 0, "name": "front", "translation": [0, 1.55, 4.2], "rotation": tilt })));
    Ok((file, roots))
}

fn finish(file: Builder, roots: &[usize], extensions: Value) -> Result<Vec<u8>> {
    file.finish(roots, &json!({ "yfov": 0.46, "aspectRatio": 4.0 / 3.0, "znear": 0.1 }), extensions)
}

/// A sphere about the origin.
fn ball(radius: f32) -> Mesh {
    const PIECES: u16 = 16;
    let profile: Vec<[f32; 2]> = (0..=PIECES)
        .map(|i| {
            let (sin, cos) = (PI * f32::from(i) / f32::from(PIECES)).sin_cos();
            [if i % PIECES == 0 { 0.0 } else { radius * sin }, -radius * cos]
        })
        .collect();
    lathe(&profile, 28, 0.0)
}

/// A bumpy base under a smooth coat, and the other way round.
fn clearcoat() -> Result<Vec<u8>> {
    let (mut file, mut roots) = studio(json!({ "scale": [3, 3] }))?;
    let bumps = file.texture(&textures::plaster_normals(64))?;
    let map = json!({ "index": bumps, "scale": 1.5, "extensions": { "KHR_texture_transform": { "scale": [6, 3] } } });
    let base = json!({ "baseColorFactor": [0.6, 0.04, 0.03, 1], "metallicFactor": 0.4, "roughnessFactor": 0.5 });
    let smooth = json!({ "name": "bumpy base", "pbrMetallicRoughness": base, "normalTexture": map,
        "extensions": { "KHR_materials_clearcoat": { "clearcoatFactor": 1 } } });
    let bumpy = json!({ "name": "bumpy coat", "pbrMetallicRoughness": base,
        "extensions": { "KHR_materials_clearcoat": {
            "clearcoatFactor": 0.9, "clearcoatRoughnessFactor": 0.1, "clearcoatNormalTexture": map } } });
    for (side, material) in [(-0.6, smooth), (0.6, bumpy)] {
        let material = file.material(material);
        let mesh = file.mesh("ball", &ball(0.55), material);
        roots.push(file.node(json!({ "mesh": mesh, "translation": [side, 0.55, 0] })));
    }
    finish(file, &roots, json!({}))
}

/// Clear and dispersive glass before shining stripes.
fn dispersion() -> Result<Vec<u8>> {
    let (mut file, mut roots) = studio(json!({ "scale": [3, 3] }))?;
    let stripe = |x: u32, _: u32| Rgb([if (x / 4).is_multiple_of(2) { 230 } else { 10 }; 3]);
    let stripes = file.texture(&RgbImage::from_fn(64, 8, stripe))?;
    let wall = file.material(json!({ "name": "stripes", "pbrMetallicRoughness": {
        "baseColorTexture": { "index": stripes } }, "extensions": { "KHR_materials_unlit": {} } }));
    let wall = file.mesh("wall", &cuboid(vec3(-2.4, 0.0, -1.5), vec3(2.4, 2.4, -1.4)), wall);
    roots.push(file.node(json!({ "mesh": wall })));
    for (side, dispersion) in [(-0.6, 0.0), (0.6, 8.0)] {
        let glass = file.material(json!({ "name": format!("glass, dispersion {dispersion}"),
            "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0 }, "extensions": {
                "KHR_materials_transmission": { "transmissionFactor": 1 },
                "KHR_materials_volume": { "thicknessFactor": 1 }, "KHR_materials_ior": { "ior": 1.6 },
                "KHR_materials_dispersion": { "dispersion": dispersion } } }));
        let mesh = file.mesh("ball", &ball(0.55), glass);
        roots.push(file.node(json!({ "mesh": mesh, "translation": [side, 0.55, 0] })));
    }
    finish(file, &roots, json!({}))
}

/// Leaves, lit from behind.
fn diffuse_transmission() -> Result<Vec<u8>> {
    let (mut file, mut roots) = studio(json!({ "scale": [3, 3] }))?;
    for (side, factor) in [(-0.6, 0.3), (0.6, 0.9)] {
        let leaf = file.material(json!({ "name": format!("leaf {factor}"), "doubleSided": true,
            "pbrMetallicRoughness": { "baseColorFactor": [0.2, 0.35, 0.08, 1], "metallicFactor": 0, "roughnessFactor": 0.6 },
            "extensions": { "KHR_materials_diffuse_transmission": {
                "diffuseTransmissionFactor": factor, "diffuseTransmissionColorFactor": [0.7, 0.9, 0.2] } } }));
        let mesh = file.mesh("leaf", &cuboid(vec3(-0.5, 0.05, -0.01), vec3(0.5, 1.2, 0.01)), leaf);
        roots.push(file.node(json!({ "mesh": mesh, "translation": [side, 0, 0] })));
    }
    let bulb = file.material(json!({ "name": "bulb", "emissiveFactor": [1, 1, 1],
        "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 20 } } }));
    let mesh = file.mesh("bulb", &cuboid(Vec3::splat(-0.15), Vec3::splat(0.15)), bulb);
    roots.push(file.node(json!({ "mesh": mesh, "translation": [0, 0.7, -0.9] })));
    finish(file, &roots, json!({}))
}

/// A spot, a point and parallel light.
fn lamps() -> Result<Vec<u8>> {
    let (mut file, mut roots) = studio(json!({ "scale": [3, 3] }))?;
    let white = file.material(white());
    let mesh = file.mesh("ball", &ball(0.55), white);
    roots.push(file.node(json!({ "mesh": mesh, "translation": [0, 0.55, 0] })));
    let down = glam::Quat::from_rotation_x(-FRAC_PI_2).to_array();
    for (light, at) in [(0, [-1.2, 2.0, 0.3]), (1, [1.2, 1.2, 0.8]), (2, [0.0, 2.0, 0.0])] {
        roots.push(file.node(json!({ "translation": at, "rotation": down,
            "extensions": { "KHR_lights_punctual": { "light": light } } })));
    }
    let lights = json!([
        { "type": "spot", "intensity": 14, "color": [1, 0.3, 0.2], "spot": { "innerConeAngle": 0.2, "outerConeAngle": 0.4 } },
        { "type": "point", "intensity": 2, "color": [0.3, 1, 0.4] },
        { "type": "directional", "intensity": 0.5, "color": [0.4, 0.5, 1] },
    ]);
    finish(file, &roots, json!({ "KHR_lights_punctual": { "lights": lights } }))
}

/// Planks, turned and repeated.
fn moved_texture() -> Result<Vec<u8>> {
    let (mut file, mut roots) = studio(json!({ "scale": [2, 4], "rotation": 0.6, "offset": [0.1, 0.3] }))?;
    let planks = file.texture(&textures::planks(64))?;
    for (side, extension) in
        [(-0.6, json!({})), (0.6, json!({ "KHR_texture_transform": { "scale": [4, 4], "rotation": 0.8 } }))]
    {
        let wood = file.material(json!({ "name": "wood", "pbrMetallicRoughness": {
            "baseColorTexture": { "index": planks, "extensions": extension }, "metallicFactor": 0, "roughnessFactor": 0.5 } }));
        let mesh = file.mesh("cube", &cuboid(vec3(-0.45, 0.0, -0.45), vec3(0.45, 0.9, 0.45)), wood);
        let turn = glam::Quat::from_rotation_y(0.5).to_array();
        roots.push(file.node(json!({ "mesh": mesh, "translation": [side, 0, 0], "rotation": turn })));
    }
    finish(file, &roots, json!({}))
}

/// A ball in red, or green, or blue.
fn variants() -> Result<Vec<u8>> {
    let (mut file, mut roots) = studio(json!({ "scale": [3, 3] }))?;
    let paint = |name: &str, color: [f32; 3]| {
        let [r, g, b] = color;
        json!({ "name": name, "pbrMetallicRoughness": { "baseColorFactor": [r, g, b, 1], "metallicFactor": 0,
            "roughnessFactor": 0.3 } })
    };
    let colors = [("red", [0.6, 0.05, 0.05]), ("green", [0.05, 0.5, 0.1]), ("blue", [0.05, 0.1, 0.7])];
    let materials = colors.map(|(name, color)| file.material(paint(name, color)));
    let mesh = file.mesh("ball", &ball(0.55), materials[0]);
    let mappings: Vec<Value> =
        materials.iter().enumerate().map(|(i, material)| json!({ "material": material, "variants": [i] })).collect();
    file.extend_primitive(mesh, json!({ "KHR_materials_variants": { "mappings": mappings } }));
    roots.push(file.node(json!({ "mesh": mesh, "translation": [0, 0.55, 0] })));
    let names: Vec<Value> = colors.iter().map(|(name, _)| json!({ "name": name })).collect();
    finish(file, &roots, json!({ "KHR_materials_variants": { "variants": names } }))
}
