//! Films and the classic lobes as scene files have them.

use radianza::desc::toml::parse;
use radianza::desc::{ColorParam, Fresnel, Iridescence, Model, Roughness, ScalarParam};
use std::path::Path;

fn model(keys: &str) -> Result<Model, String> {
    let text = format!("[material.m]\n{keys}\n[[shape]]\ntype = \"sphere\"\nradius = 1\nmaterial = \"m\"\n");
    let scene = parse(&text, Path::new("scene.toml")).map_err(|e| e.to_string())?;
    Ok(scene.materials[0].model.clone())
}

#[test]
fn lobes_are_read() {
    let grey = ColorParam { vertex_color: true, ..ColorParam::constant([0.5; 3]) };
    assert_eq!(model("type = \"diffuse\"\nreflectance = 0.5"), Ok(Model::Diffuse { reflectance: grey }));
    let roughness = ScalarParam::constant(0.3);
    let rough = Model::RoughDiffuse { reflectance: grey, roughness };
    assert_eq!(model("type = \"diffuse\"\nreflectance = 0.5\nroughness = 0.3"), Ok(rough));
    let phong = Model::Phong { reflectance: grey, exponent: 30.0 };
    assert_eq!(model("type = \"phong\"\nreflectance = 0.5\nexponent = 30"), Ok(phong));
    let fresnel = Fresnel::Complex { eta: [1.5; 3], k: [0.0; 3] };
    let glossy = Model::CookTorrance { fresnel, roughness: Roughness::Alpha([0.2, 0.4]) };
    assert_eq!(model("type = \"cook-torrance\"\nior = 1.5\nalpha = [0.2, 0.4]"), Ok(glossy));
    let gold = model("type = \"cook-torrance\"\nmetal = \"Au\"\nroughness = 0.3").unwrap();
    assert!(matches!(
        gold,
        Model::CookTorrance { fresnel: Fresnel::Complex { .. }, roughness: Roughness::Perceptual(_) }
    ));
    let filmed = model("type = \"metallic-roughness\"\nfilm = { thickness = 300, share = 0.5 }");
    let Ok(Model::MetallicRoughness(m)) = filmed else { panic!("{filmed:?}") };
    let factor = ScalarParam::constant(0.5);
    let film = Iridescence { factor, ior: 1.3, thickness: [300.0; 2], thickness_texture: None };
    assert_eq!(m.iridescence, Some(film));
}

#[test]
fn what_is_wrong_is_named() {
    for (keys, words) in [
        ("type = \"phong\"\nreflectance = 0.5\nexponent = -1", "`exponent`"),
        ("type = \"phong\"\nreflectance = 0.5", "missing key `exponent`"),
        ("type = \"diffuse\"\nreflectance = 0.5\nroughness = 2", "`roughness`"),
        ("type = \"cook-torrance\"", "`metal`"),
        ("type = \"cook-torrance\"\nior = 1.5\nmetal = \"Au\"", "`ior` is given beside"),
        ("type = \"metallic-roughness\"\nfilm = { thickness = 300, ior = 0.5 }", "`ior` is 0.5"),
    ] {
        let error = model(keys).expect_err(keys);
        assert!(error.contains(words), "{keys}: {error}");
    }
}
