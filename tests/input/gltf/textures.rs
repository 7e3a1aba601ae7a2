//! Textures, samplers, images, KHR_texture_transform.

use super::document::{Document, mesh, noted, parse};
use radianza::desc::{ErrorKind, Model, Pixels, Scene, Texture, TextureRef, Wrap};
use radianza::glam::Vec2;
use serde_json::{Value, json};

const RED: [u8; 4] = [255, 0, 0, 255];
const SEE: [u8; 4] = [1, 2, 3, 4];

fn textured(info: Value) -> Document {
    let mut d = Document::material(json!({ "pbrMetallicRoughness": { "baseColorTexture": info } }));
    d.texture([2, 1], &[RED, SEE]);
    d
}

fn base(scene: &Scene) -> Option<TextureRef> {
    match &scene.materials[0].model {
        Model::MetallicRoughness(p) => p.base_color.texture,
        other => panic!("{other:?}"),
    }
}

#[test]
fn png_pixels_arrive_as_stored() {
    let scene = textured(json!({ "index": 0 })).read().unwrap();
    assert_eq!(scene.images[0].size, [2, 1]);
    assert_eq!(scene.images[0].pixels, Pixels::Rgba8(vec![RED, SEE]));
    let default = Texture::Image { image: 0, srgb: true, wrap: [Wrap::Repeat; 2], nearest: false };
    assert_eq!(scene.textures, [default]);
}

#[test]
fn jpeg_and_data_uris() {
    let mut jpeg = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_pixel(8, 4, image::Rgb([200, 100, 50]))
        .write_to(&mut jpeg, image::ImageFormat::Jpeg)
        .unwrap();
    let mut d = textured(json!({ "index": 0 }));
    let encoded = base64::Engine::encode(&base64::prelude::BASE64_STANDARD, jpeg.into_inner());
    d.set("/images/0", json!({ "uri": format!("data:image/jpeg;base64,{encoded}") }));
    let scene = d.read().unwrap();
    assert_eq!(scene.images[0].size, [8, 4]);
    let Pixels::Rgba8(pixels) = &scene.images[0].pixels else { panic!("floats") };
    for (found, expected) in pixels[0].iter().zip([200u8, 100, 50, 255]) {
        assert!(found.abs_diff(expected) <= 3, "{:?}", pixels[0]);
    }
}

#[test]
fn samplers() {
    let with = |sampler: Value| {
        let mut d = textured(json!({ "index": 0 }));
        d.set("/samplers", json!([sampler])).set("/textures/0/sampler", json!(0));
        d
    };
    let texture = |sampler| with(sampler).read().unwrap().textures[0].clone();
    let of = |wrap, nearest| Texture::Image { image: 0, srgb: true, wrap, nearest };
    assert_eq!(texture(json!({})), of([Wrap::Repeat; 2], false));
    assert_eq!(
        texture(json!({ "wrapS": 33071, "wrapT": 33648, "magFilter": 9728 })),
        of([Wrap::Clamp, Wrap::Mirror], true)
    );
    assert_eq!(texture(json!({ "wrapS": 10497, "magFilter": 9729, "minFilter": 9987 })), of([Wrap::Repeat; 2], false));
    with(json!({ "wrapT": 5 })).fails("/samplers/0/wrapT", "no wrap mode");
    with(json!({ "magFilter": 9987 })).fails("/samplers/0/magFilter", "no filter");
    textured(json!({ "index": 0 }))
        .set("/textures/0/sampler", json!(3))
        .fails("/textures/0/sampler", "refers to sampler 3");
}

#[test]
fn transforms_per_slot() {
    let transform =
        json!({ "offset": [0.25, 0.5], "rotation": std::f32::consts::FRAC_PI_2, "scale": [2, 3], "texCoord": 1 });
    let mut d = textured(json!({ "index": 0, "texCoord": 0, "extensions": { "KHR_texture_transform": transform } }));
    d.set("/extensionsRequired", json!(["KHR_texture_transform"]));
    d.set(
        "/materials/0/normalTexture",
        json!({ "index": 0, "extensions": { "KHR_texture_transform": { "scale": [4, 5] } } }),
    );
    d.attribute("TEXCOORD_1", "VEC2", &[[0.0; 2]; 3]);
    let scene = d.read().unwrap();
    let t = base(&scene).unwrap();
    assert_eq!(t.uv_set, 1);
    // T R S (1, 1) = T R (2, 3) = T (3, −2): a turn against the clock where v points down.
    assert!(t.transform.transform_point2(Vec2::ONE).abs_diff_eq(Vec2::new(3.25, -1.5), 1e-5), "{}", t.transform);
    let n = scene.materials[0].normal_map.unwrap().texture;
    assert_eq!((n.uv_set, n.transform.transform_point2(Vec2::ONE)), (0, Vec2::new(4.0, 5.0)));
}

/// Every slot has a transform and a set of its own, those inside extensions too.
#[test]
fn every_slot_is_transformed() {
    let slot = |i: u32| {
        let transform = json!({ "offset": [i, 0], "texCoord": i % 2 });
        json!({ "index": 0, "texCoord": (i + 1) % 2, "extensions": { "KHR_texture_transform": transform } })
    };
    let mut d = Document::material(json!({
        "pbrMetallicRoughness": { "baseColorTexture": slot(1), "metallicRoughnessTexture": slot(2) },
        "normalTexture": slot(3),
        "emissiveTexture": slot(4),
        "emissiveFactor": [1, 1, 1],
        "extensions": {
            "KHR_materials_specular": { "specularTexture": slot(5), "specularColorTexture": slot(6) },
            "KHR_materials_transmission": { "transmissionFactor": 1, "transmissionTexture": slot(7) },
        },
    }));
    d.texture([1, 1], &[RED]);
    d.attribute("TEXCOORD_1", "VEC2", &[[0.0; 2]; 3]);
    let scene = d.read().unwrap();
    let m = &scene.materials[0];
    let Model::MetallicRoughness(p) = &m.model else { panic!("{m:?}") };
    let found = [
        p.base_color.texture,
        p.roughness.texture.map(|t| t.0),
        m.normal_map.map(|n| n.texture),
        m.emission.and_then(|e| e.radiance.texture),
        p.specular.texture.map(|t| t.0),
        p.specular_color.texture,
        p.transmission.as_ref().and_then(|t| t.factor.texture).map(|t| t.0),
    ];
    for (i, t) in (1u8..).zip(found) {
        let t = t.unwrap_or_else(|| panic!("no texture in slot {i}"));
        assert_eq!((t.transform.translation.x, t.uv_set), (f32::from(i), usize::from(i % 2)), "slot {i}");
    }
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
}

/// Any two sets reach the mesh, each where its textures look.
#[test]
fn two_uv_sets_of_any_number() {
    let set = |n: usize| (0..3).map(|i| [n as f32, i as f32]).collect::<Vec<_>>();
    let with = |base: u32, normal: u32| {
        let mut d = textured(json!({ "index": 0, "texCoord": base }));
        d.set("/materials/0/normalTexture", json!({ "index": 0, "texCoord": normal }));
        for n in 1..7 {
            d.attribute(&format!("TEXCOORD_{n}"), "VEC2", &set(n));
        }
        d
    };
    for (b, n) in [(0, 1), (1, 0), (5, 0), (0, 5), (5, 1), (6, 5), (5, 5)] {
        let scene = with(b, n).read().unwrap();
        let uv = &mesh(&scene, 0).uv;
        let found = |t: TextureRef| uv[t.uv_set][2];
        let expected = |n: u32| if n == 0 { Vec2::new(0.0, 1.0) } else { Vec2::new(n as f32, 2.0) };
        let normal = scene.materials[0].normal_map.unwrap().texture;
        assert_eq!((found(base(&scene).unwrap()), found(normal)), (expected(b), expected(n)), "{b}, {n}");
        assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    }

    // Two materials see one mesh differently.
    let mut d = with(5, 6);
    d.set("/materials/1", json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0, "texCoord": 3 } } }));
    let mut second = d.json["meshes"][0]["primitives"][0].clone();
    second["material"] = json!(1);
    d.set("/meshes/0/primitives/1", second);
    let scene = d.read().unwrap();
    assert_eq!(scene.shapes.len(), 2);
    assert!(mesh(&scene, 1).uv.iter().any(|uv| uv[2] == Vec2::new(3.0, 2.0)));

    // A third set, one that is missing, one of another length.
    let mut d = with(5, 6);
    d.set("/materials/0/emissiveFactor", json!([1, 1, 1]));
    d.set("/materials/0/emissiveTexture", json!({ "index": 0, "texCoord": 0 }));
    let scene = d.read().unwrap();
    assert!(noted(&scene, "more than two UV sets") && noted(&scene, "/materials/0/normalTexture"));
    assert!(scene.materials[0].normal_map.is_none() && scene.materials[0].emission.unwrap().radiance.texture.is_some());
    assert!(noted(&with(5, 9).read().unwrap(), "TEXCOORD_9, which is missing"));
    let mut d = with(5, 0);
    d.attribute("TEXCOORD_5", "VEC2", &[[0.0; 2]; 2]);
    d.fails("/meshes/0/primitives/0/attributes/TEXCOORD_5", "has 2 elements; expected 3");
}

#[test]
fn broken_references_and_images() {
    textured(json!({ "index": 7 }))
        .fails("/materials/0/pbrMetallicRoughness/baseColorTexture/index", "texture 7; the file has 1");
    textured(json!({ "index": 0 }))
        .set("/textures/0/source", json!(2))
        .fails("/textures/0/source", "refers to image 2");
    textured(json!({ "index": 0 })).set("/images/0", json!({})).fails("/images/0", "uri and bufferView");
    textured(json!({ "index": 0 }))
        .set("/images/0/bufferView", json!(99))
        .fails("/images/0/bufferView", "buffer view 99");
    textured(json!({ "index": 0 }))
        .set("/images/0", json!({ "uri": "data:image/png;base64,AAAA" }))
        .fails("/images/0", "");
    textured(json!({ "index": 0 }))
        .set("/images/0", json!({ "uri": "data:image/png" }))
        .fails("/images/0/uri", "no comma");
    textured(json!({ "index": 0 }))
        .set("/images/0", json!({ "uri": "https://x.y/z.png" }))
        .fails("/images/0/uri", "scheme");
    let missing = textured(json!({ "index": 0 })).set("/images/0", json!({ "uri": "a%20b.png" })).read().unwrap_err();
    assert_eq!((missing.kind, missing.place.as_str()), (ErrorKind::Missing, "/images/0/uri"));
    assert!(missing.message.contains("`a b.png`"), "{missing}");
}

#[test]
fn textures_that_nothing_uses_are_not_read() {
    let mut d = Document::triangle();
    d.set("/images", json!([{ "uri": "missing.png" }])).set("/textures", json!([{ "source": 0 }]));
    d.set("/materials", json!([{ "normalTexture": { "index": 0 } }]));
    assert!(parse(&d.glb()).unwrap().images.is_empty());
}
