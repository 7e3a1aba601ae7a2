//! KHR_materials_iridescence and KHR_materials_pbrSpecularGlossiness.

use super::document::Document;
use radianza::desc::{Alpha, ColorParam, Iridescence, Model, ScalarParam, Scene, SpecularGlossiness};
use serde_json::{Value, json};

/// The triangle with these extensions, two textures beside it.
fn document(extensions: Value, mode: &str) -> Document {
    let mut d = Document::material(json!({ "extensions": extensions, "alphaMode": mode,
        "pbrMetallicRoughness": { "baseColorFactor": [0.1, 0.1, 0.1, 0.9] } }));
    for _ in 0..2 {
        d.texture([1, 1], &[[255; 4]]);
    }
    d.attribute("TEXCOORD_0", "VEC2", &[[0.0; 2]; 3]);
    d
}

fn film(value: Value) -> Result<Option<Iridescence>, String> {
    let scene = document(json!({ "KHR_materials_iridescence": value }), "OPAQUE").read().map_err(|e| e.to_string())?;
    match &scene.materials[0].model {
        Model::MetallicRoughness(m) => Ok(m.iridescence),
        other => panic!("{other:?}"),
    }
}

fn gloss(scene: &Scene) -> &SpecularGlossiness {
    match &scene.materials[0].model {
        Model::SpecularGlossiness(m) => m,
        other => panic!("{other:?}"),
    }
}

#[test]
fn films_have_the_defaults_of_the_extension() {
    let factor = ScalarParam::constant(0.5);
    let film_of = |ior, thickness| Iridescence { factor, ior, thickness, thickness_texture: None };
    assert_eq!(film(json!({ "iridescenceFactor": 0.5 })), Ok(Some(film_of(1.3, [100.0, 400.0]))));
    assert_eq!(film(json!({})), Ok(None), "the factor's default is 0");
    let all = json!({ "iridescenceFactor": 0.5, "iridescenceIor": 1.8, "iridescenceThicknessMinimum": 500,
        "iridescenceThicknessMaximum": 200 });
    assert_eq!(film(all), Ok(Some(film_of(1.8, [500.0, 200.0]))));
}

#[test]
fn films_have_textures() {
    let f = film(json!({ "iridescenceFactor": 1, "iridescenceTexture": { "index": 0 },
        "iridescenceThicknessTexture": { "index": 1, "extensions": { "KHR_texture_transform": { "offset": [0.5, 0] } } } }));
    let f = f.unwrap().unwrap();
    let ((share, r), (thickness, g)) = (f.factor.texture.unwrap(), f.thickness_texture.unwrap());
    assert_eq!((r, g), (0, 1));
    assert!(share.texture != thickness.texture && thickness.transform.translation.x == 0.5);
}

#[test]
fn what_is_no_film_is_named() {
    for (value, place) in [
        (json!(3), "/materials/0/extensions/KHR_materials_iridescence"),
        (json!({ "iridescenceFactor": "much" }), "/KHR_materials_iridescence/iridescenceFactor"),
        (json!({ "iridescenceFactor": 1, "iridescenceIor": [] }), "/KHR_materials_iridescence/iridescenceIor"),
        (json!({ "iridescenceFactor": 1, "iridescenceTexture": { "index": 9 } }), "iridescenceTexture/index"),
    ] {
        assert!(film(value.clone()).is_err_and(|e| e.contains(place)), "{value}: {:?}", film(value.clone()));
    }
    let odd = film(json!({ "iridescenceFactor": 1e9, "iridescenceIor": 0, "iridescenceThicknessMaximum": -1 }));
    let odd = odd.unwrap().unwrap();
    assert_eq!((odd.factor.factor, odd.ior, odd.thickness), (1.0, 1.0, [100.0, 0.0]), "clamped");
}

#[test]
fn gloss_stands_before_metal() {
    let extension = json!({ "KHR_materials_pbrSpecularGlossiness": { "diffuseFactor": [0.1, 0.2, 0.3, 0.4],
        "specularFactor": [0.5, 0.6, 0.7], "glossinessFactor": 0.8, "diffuseTexture": { "index": 0 },
        "specularGlossinessTexture": { "index": 1 } } });
    let scene = document(extension, "BLEND").read().unwrap();
    let m = gloss(&scene);
    let (diffuse, specular) = (m.diffuse.texture.unwrap(), m.specular.texture.unwrap());
    assert_eq!((m.diffuse.factor, m.specular.factor), ([0.1, 0.2, 0.3], [0.5, 0.6, 0.7]));
    assert_eq!(m.glossiness, ScalarParam { factor: 0.8, texture: Some((specular, 3)) });
    // Coverage is the base's.
    let coverage = ScalarParam { factor: 0.4, texture: Some((diffuse, 3)) };
    assert_eq!(scene.materials[0].alpha, Alpha::Blend { coverage });
}

#[test]
fn gloss_has_the_defaults_of_the_extension() {
    let scene = document(json!({ "KHR_materials_pbrSpecularGlossiness": {} }), "OPAQUE").read().unwrap();
    let white = |vertex_color| ColorParam { vertex_color, ..ColorParam::constant([1.0; 3]) };
    let m = gloss(&scene);
    assert_eq!((m.specular, m.glossiness), (white(false), ScalarParam::constant(1.0)));
    assert_eq!((m.diffuse.factor, m.diffuse.texture), ([1.0; 3], None));
    let wrong = document(json!({ "KHR_materials_pbrSpecularGlossiness": { "diffuseFactor": [1, 1, 1] } }), "OPAQUE");
    assert!(wrong.read().is_err_and(|e| e.to_string().contains("diffuseFactor")));
}
