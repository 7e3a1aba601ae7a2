//! Materials and their extensions.

use super::document::{Document, noted};
use radianza::desc::{
    Alpha, ColorParam, Dispersion, Error, Interior, Material, MetallicRoughness, Model, ScalarParam, Scene, Sides,
    TextureRef,
};
use radianza::glam::Affine2;
use serde_json::{Value, json};

const ONE: [u8; 4] = [255; 4];

/// Reads the triangle with this material.
fn read(material: Value) -> (Scene, Material) {
    let scene = Document::material(material).read().unwrap();
    let material = scene.materials[0].clone();
    (scene, material)
}

fn pbr(material: &Material) -> &MetallicRoughness {
    match &material.model {
        Model::MetallicRoughness(p) => p,
        other => panic!("{other:?}"),
    }
}

#[test]
fn defaults_are_those_of_the_specification() {
    for scene in [Document::triangle().read().unwrap(), read(json!({})).0] {
        let m = &scene.materials[0];
        let p = pbr(m);
        assert_eq!(p.base_color, ColorParam { factor: [1.0; 3], texture: None, vertex_color: true });
        assert_eq!((p.metallic, p.roughness), (ScalarParam::constant(1.0), ScalarParam::constant(1.0)));
        assert_eq!(
            (p.ior, p.specular, p.specular_color),
            (1.5, ScalarParam::constant(1.0), ColorParam::constant([1.0; 3]))
        );
        assert_eq!(p.transmission, None);
        assert_eq!((m.emission, m.normal_map, m.alpha, m.double_sided), (None, None, Alpha::Opaque, false));
    }
}

#[test]
fn textures_reach_their_parameters() {
    let slot = |index: usize, uv: usize| json!({ "index": index, "texCoord": uv });
    let mut d = Document::material(json!({
        "name": "all", "alphaMode": "BLEND", "doubleSided": true,
        "pbrMetallicRoughness": { "baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.6,
            "baseColorTexture": slot(0, 0), "metallicRoughnessTexture": slot(1, 1) },
        "normalTexture": { "index": 2, "scale": 0.7 }, "occlusionTexture": slot(1, 0),
        "emissiveTexture": slot(0, 1), "emissiveFactor": [1, 2, 3],
    }));
    for _ in 0..3 {
        d.texture([1, 1], &[ONE]);
    }
    d.attribute("TEXCOORD_1", "VEC2", &[[0.0; 2]; 3]);
    let scene = d.read().unwrap();
    let m = &scene.materials[0];
    let p = pbr(m);
    let base = p.base_color.texture.unwrap();
    assert_eq!((p.base_color.factor, base.uv_set), ([0.1, 0.2, 0.3], 0));
    assert_eq!(m.alpha, Alpha::Blend { coverage: ScalarParam { factor: 0.4, texture: Some((base, 3)) } });
    let (orm, channel) = p.roughness.texture.unwrap();
    assert_eq!((p.roughness.factor, channel, orm.uv_set), (0.6, 1, 1));
    assert_eq!((p.metallic.factor, p.metallic.texture), (0.5, Some((orm, 2))));
    let e = m.emission.unwrap();
    assert_eq!((e.radiance.factor, e.radiance.vertex_color, e.sides), ([1.0, 2.0, 3.0], false, Sides::Both));
    assert_eq!(e.radiance.texture, Some(TextureRef { uv_set: 1, ..base }));
    let map = m.normal_map.unwrap();
    assert_eq!((map.scale, map.texture.uv_set, map.texture.transform), (0.7, 0, Affine2::IDENTITY));
    assert!(m.double_sided && m.name == "all" && noted(&scene, "occlusion textures are ignored"));

    // Colours are decoded from sRGB; roughness and normals are not.
    let srgb = |t: usize| matches!(scene.textures[t], radianza::desc::Texture::Image { srgb: true, .. });
    assert!(srgb(base.texture) && !srgb(orm.texture) && !srgb(map.texture.texture));
    assert_eq!((scene.textures.len(), scene.images.len()), (3, 3));
}

#[test]
fn one_image_may_be_colour_and_data() {
    let mut d = Document::material(json!({
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "metallicRoughnessTexture": { "index": 0 } } }));
    d.texture([1, 1], &[ONE]);
    let scene = d.read().unwrap();
    assert_eq!((scene.textures.len(), scene.images.len()), (2, 1));
}

#[test]
fn alpha_modes() {
    let factor = json!({ "baseColorFactor": [1, 1, 1, 0.25] });
    let alpha =
        |mode: Value| read(json!({ "pbrMetallicRoughness": factor, "alphaMode": mode, "alphaCutoff": 0.3 })).1.alpha;
    assert_eq!(alpha(json!("OPAQUE")), Alpha::Opaque);
    assert_eq!(alpha(json!("MASK")), Alpha::Mask { coverage: ScalarParam::constant(0.25), cutoff: 0.3 });
    assert_eq!(alpha(json!("BLEND")), Alpha::Blend { coverage: ScalarParam::constant(0.25) });
    assert!(matches!(read(json!({ "alphaMode": "MASK" })).1.alpha, Alpha::Mask { cutoff: 0.5, .. }));
    Document::material(json!({ "alphaMode": "GLOW" })).fails("/materials/0/alphaMode", "expected \"OPAQUE\"");
}

#[test]
fn emission_is_factor_times_strength_on_the_front() {
    let glow = |strength: f32| json!({ "emissiveFactor": [1, 0.5, 0], "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": strength } } });
    let e = read(glow(8.0)).1.emission.unwrap();
    assert_eq!((e.radiance, e.sides), (ColorParam::constant([8.0, 4.0, 0.0]), Sides::Front));
    assert_eq!(read(glow(0.0)).1.emission, None);
    let (scene, material) = read(glow(-1.0));
    assert!(material.emission.is_none() && noted(&scene, "outside [0, ∞) are clamped"));
}

#[test]
fn numbers_out_of_range_are_clamped_and_noted() {
    let (scene, m) = read(
        json!({ "pbrMetallicRoughness": { "baseColorFactor": [2, 0.5, -1, 1], "metallicFactor": 3, "roughnessFactor": -1 } }),
    );
    let p = pbr(&m);
    assert_eq!((p.base_color.factor, p.metallic.factor, p.roughness.factor), ([1.0, 0.5, 0.0], 1.0, 0.0));
    let place = "(first at /materials/0/pbrMetallicRoughness/baseColorFactor; 4 in all)";
    assert_eq!(scene.notes, [format!("numbers outside [0, 1] are clamped {place}")]);
}

#[test]
fn index_of_refraction_and_specular() {
    let ior = |ior: f32| pbr(&read(json!({ "extensions": { "KHR_materials_ior": { "ior": ior } } })).1).ior;
    assert_eq!([ior(1.33), ior(0.0), ior(0.5)], [1.33, 0.0, 1.0]);

    let mut d = Document::material(json!({ "extensions": { "KHR_materials_specular": { "specularFactor": 0.5,
        "specularTexture": { "index": 0 }, "specularColorFactor": [2, 1, 0], "specularColorTexture": { "index": 0 } } } }));
    d.texture([1, 1], &[ONE]);
    let scene = d.read().unwrap();
    let p = pbr(&scene.materials[0]);
    let (texture, channel) = p.specular.texture.unwrap();
    let color = p.specular_color.texture.unwrap();
    assert_eq!((p.specular.factor, channel, p.specular_color.factor), (0.5, 3, [2.0, 1.0, 0.0]));
    let srgb = |t: TextureRef| matches!(scene.textures[t.texture], radianza::desc::Texture::Image { srgb: true, .. });
    assert!(!srgb(texture) && srgb(color) && !p.specular_color.vertex_color);
}

#[test]
fn transmission_is_thin_without_a_volume() {
    let transmission = json!({ "transmissionFactor": 0.8, "transmissionTexture": { "index": 0 } });
    let with = |volume: Value| {
        let mut d = Document::material(json!({ "extensions": { "KHR_materials_transmission": transmission } }));
        d.texture([1, 1], &[ONE]);
        if !volume.is_null() {
            d.set("/materials/0/extensions/KHR_materials_volume", volume);
        }
        let scene = d.read().unwrap();
        let t = pbr(&scene.materials[0]).transmission.clone().unwrap();
        assert_eq!((t.factor.factor, t.factor.texture.unwrap().1), (0.8, 0));
        (scene, t.thin)
    };
    assert!(with(Value::Null).1);
    assert!(with(json!({ "thicknessFactor": 0 })).1);
    let (scene, thin) = with(json!({ "thicknessFactor": 1, "attenuationColor": [0.5, 1, 1] }));
    assert!(!thin && scene.notes.is_empty(), "{:?}", scene.notes);
    let (scene, thin) =
        with(json!({ "thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [0.5, 1, 1] }));
    assert!(!thin && scene.notes.is_empty(), "{:?}", scene.notes);
    let [r, g, b] = scene.materials[0].interior.absorption;
    assert!((r - 0.5 * 2f32.ln()).abs() < 1e-7 && [g, b] == [0.0, 0.0], "{r} {g} {b}");

    let none = read(
        json!({ "extensions": { "KHR_materials_transmission": {}, "KHR_materials_volume": { "thicknessFactor": 1 } } }),
    );
    assert_eq!(pbr(&none.1).transmission, None);
}

#[test]
fn an_interior_is_what_volume_and_dispersion_say() {
    let of = |volume: Value, dispersion: Value| {
        Document::material(json!({ "extensions": {
            "KHR_materials_volume": volume, "KHR_materials_dispersion": dispersion } }))
        .read()
        .map(|scene| scene.materials[0].interior)
    };
    let clear = of(json!({ "thicknessFactor": 1 }), json!({ "dispersion": 0 })).unwrap();
    assert_eq!(clear, Interior::default());
    let flint = of(json!({}), json!({ "dispersion": 0.5 })).unwrap();
    assert_eq!(flint.dispersion, Dispersion::InverseAbbe(0.025));
    let black = of(json!({ "attenuationDistance": 1, "attenuationColor": [0, 0, 0] }), json!({})).unwrap();
    assert_eq!(black.absorption, [f32::MAX; 3]);
    let pointer = |e: Result<Interior, Error>| e.unwrap_err().place;
    let volume = "/materials/0/extensions/KHR_materials_volume/attenuationDistance";
    assert_eq!(pointer(of(json!({ "attenuationDistance": 0 }), json!({}))), volume);
    let dispersion = "/materials/0/extensions/KHR_materials_dispersion/dispersion";
    assert_eq!(pointer(of(json!({}), json!({ "dispersion": "much" }))), dispersion);
}

#[test]
fn diffuse_transmission_is_read_from_the_plain_json() {
    let of = |extension: Value, volume: Value| {
        let mut d = Document::material(json!({ "extensions": {
            "KHR_materials_diffuse_transmission": extension, "KHR_materials_volume": volume } }));
        d.texture([1, 1], &[ONE]);
        d.read().map(|scene| pbr(&scene.materials[0]).diffuse_transmission.clone())
    };
    let all = json!({ "diffuseTransmissionFactor": 0.25, "diffuseTransmissionTexture": { "index": 0 },
        "diffuseTransmissionColorFactor": [1, 0.5, 0.2], "diffuseTransmissionColorTexture": { "index": 0,
        "extensions": { "KHR_texture_transform": { "offset": [0.5, 0] } } } });
    let t = of(all, json!({})).unwrap().unwrap();
    assert_eq!((t.factor.factor, t.factor.texture.unwrap().1, t.thin), (0.25, 3, true));
    assert_eq!(t.color.factor, [1.0, 0.5, 0.2]);
    assert_eq!(t.color.texture.unwrap().transform, Affine2::from_translation([0.5, 0.0].into()));
    let plain = of(json!({ "diffuseTransmissionFactor": 1 }), json!({ "thicknessFactor": 1 })).unwrap().unwrap();
    assert_eq!((plain.color.factor, plain.thin), ([1.0; 3], false));
    assert_eq!(of(json!({}), json!({})).unwrap(), None);
    let wrong = of(json!({ "diffuseTransmissionColorFactor": [1, 2] }), json!({})).unwrap_err();
    assert!(wrong.place.ends_with("KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor"), "{wrong}");
}

#[test]
fn unlit_emits_its_base_colour() {
    let (scene, m) =
        read(json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.1, 0.2, 0.3, 0.5] }, "alphaMode": "BLEND",
        "emissiveFactor": [9, 9, 9], "extensions": { "KHR_materials_unlit": {} } }));
    let e = m.emission.unwrap();
    assert_eq!((m.model, e.sides, e.radiance.vertex_color), (Model::Absorb, Sides::Both, true));
    assert_eq!(e.radiance.factor, [0.1, 0.2, 0.3]);
    assert_eq!(m.alpha, Alpha::Blend { coverage: ScalarParam::constant(0.5) });
    assert!(noted(&scene, "KHR_materials_unlit"));
}

#[test]
fn missing_uv_is_noted() {
    let mut d =
        Document::material(json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0, "texCoord": 1 } } }));
    d.texture([1, 1], &[ONE]);
    assert!(noted(&d.read().unwrap(), "TEXCOORD_1, which is missing"));
}
