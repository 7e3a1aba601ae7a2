//! Anisotropy, sheen and clear coat.

use super::document::Document;
use radianza::desc::{Layers, Model, NormalMap, ScalarParam, Scene};
use serde_json::{Value, json};

const ONE: [u8; 4] = [255; 4];

fn layers(scene: &Scene) -> Layers {
    match &scene.materials[0].model {
        Model::MetallicRoughness(m) => m.layers.clone(),
        other => panic!("{other:?}"),
    }
}

/// The triangle with this extension and four textures.
fn with(name: &str, extension: Value) -> Document {
    let mut d = Document::material(json!({ "extensions": { name: extension } }));
    (0..4).for_each(|_| {
        d.texture([1, 1], &[ONE]);
    });
    d
}

#[test]
fn nothing_is_laid_over_a_material_that_says_nothing() {
    assert!(layers(&Document::triangle().read().unwrap()).is_empty());
    for name in ["KHR_materials_anisotropy", "KHR_materials_sheen", "KHR_materials_clearcoat"] {
        assert!(layers(&with(name, json!({})).read().unwrap()).is_empty(), "{name}");
        with(name, json!(3)).fails(&format!("/materials/0/extensions/{name}"), "is a number; expected an object");
    }
}

#[test]
fn anisotropy_has_strength_rotation_and_directions() {
    let d = with(
        "KHR_materials_anisotropy",
        json!({ "anisotropyStrength": 0.6, "anisotropyRotation": 1.5, "anisotropyTexture": { "index": 2 } }),
    );
    let scene = d.read().unwrap();
    let a = layers(&scene).anisotropy.unwrap();
    let (texture, channel) = a.strength.texture.unwrap();
    assert_eq!((a.strength.factor, a.rotation, channel, a.direction), (0.6, 1.5, 2, Some(texture)));
    // Tangents are made for it.
    let radianza::desc::Shape::Mesh(mesh) = &scene.shapes[0] else { panic!("a mesh") };
    assert_eq!(mesh.tangents.len(), mesh.positions.len());
    with("KHR_materials_anisotropy", json!({ "anisotropyStrength": "strong" }))
        .fails("/materials/0/extensions/KHR_materials_anisotropy/anisotropyStrength", "expected a number");
}

#[test]
fn sheen_has_a_colour_and_a_roughness() {
    let d = with(
        "KHR_materials_sheen",
        json!({ "sheenColorFactor": [0.1, 0.2, 0.3], "sheenColorTexture": { "index": 0 },
            "sheenRoughnessFactor": 0.4, "sheenRoughnessTexture": { "index": 1 } }),
    );
    let sheen = layers(&d.read().unwrap()).sheen.unwrap();
    assert_eq!((sheen.color.factor, sheen.roughness.factor), ([0.1, 0.2, 0.3], 0.4));
    let (roughness, channel) = sheen.roughness.texture.unwrap();
    assert_eq!(channel, 3);
    assert_ne!(sheen.color.texture.unwrap().texture, roughness.texture);
    with("KHR_materials_sheen", json!({ "sheenColorFactor": [1, 2] }))
        .fails("/materials/0/extensions/KHR_materials_sheen/sheenColorFactor", "list of 3 numbers");
}

#[test]
fn coats_have_a_share_a_roughness_and_normals() {
    let mut d = with(
        "KHR_materials_clearcoat",
        json!({ "clearcoatFactor": 0.9, "clearcoatTexture": { "index": 0 }, "clearcoatRoughnessFactor": 0.2,
            "clearcoatRoughnessTexture": { "index": 1 }, "clearcoatNormalTexture": { "index": 2, "scale": 0.5 } }),
    );
    d.set("/materials/0/emissiveFactor", json!([1, 1, 1]));
    let scene = d.read().unwrap();
    let coat = layers(&scene).clearcoat.unwrap();
    let channel = |p: ScalarParam| (p.factor, p.texture.map(|(_, channel)| channel));
    assert_eq!((channel(coat.factor), channel(coat.roughness)), ((0.9, Some(0)), (0.2, Some(1))));
    assert!(matches!(coat.normal_map, Some(NormalMap { scale: 0.5, .. })));
    // What the base emits passes the coat.
    assert_eq!(scene.materials[0].emission.unwrap().coat, Some(coat.factor));
    d.set("/materials/0/extensions/KHR_materials_clearcoat/clearcoatNormalTexture", json!({ "index": 9 }));
    d.fails("/materials/0/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/index", "texture 9");
}

/// Two models in one TOML scene: whatever the second looks up is its own, its layers included.
#[test]
fn models_in_a_scene_keep_their_textures() {
    let texture = |index: usize| json!({ "index": index });
    let extensions = json!({
        "KHR_materials_sheen": { "sheenColorFactor": [1, 1, 1], "sheenColorTexture": texture(0), "sheenRoughnessFactor": 1, "sheenRoughnessTexture": texture(1) },
        "KHR_materials_clearcoat": { "clearcoatFactor": 1, "clearcoatTexture": texture(2), "clearcoatNormalTexture": texture(3) },
        "KHR_materials_anisotropy": { "anisotropyStrength": 1, "anisotropyTexture": texture(0) },
        "KHR_materials_iridescence": { "iridescenceFactor": 1, "iridescenceTexture": texture(1), "iridescenceThicknessTexture": texture(2) },
        "KHR_materials_transmission": { "transmissionFactor": 1, "transmissionTexture": texture(3) },
    });
    let mut d = Document::material(json!({ "emissiveFactor": [1, 1, 1], "extensions": extensions }));
    (0..4).for_each(|_| {
        d.texture([1, 1], &[ONE]);
    });
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.glb", "b.glb"] {
        std::fs::write(folder.path().join(name), d.glb()).unwrap();
    }
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, "[[shape]]\ntype = 'file'\nfile = 'a.glb'\n[[shape]]\ntype = 'file'\nfile = 'b.glb'\n")
        .unwrap();
    let scene = radianza::desc::load(&path).unwrap();
    let [first, second] = &scene.materials[..] else { panic!("{:?}", scene.materials) };
    let looked_up = |m: &radianza::desc::Material| m.textures().iter().map(|t| t.texture).collect::<Vec<_>>();
    let (first, second) = (looked_up(first), looked_up(second));
    // The coat dims the emission, by the same texture.
    assert_eq!(first.len(), 10);
    let shift = scene.textures.len() / 2;
    assert_eq!(second, first.iter().map(|t| t + shift).collect::<Vec<_>>());
}
