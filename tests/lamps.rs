//! Emissive surfaces: however light is sampled, the image is one.

mod common;

use common::{film, settings};
use radianza::desc::{self, Strategy, toml};
use radianza::render::Settings;
use radianza::scene::Scene;
use radianza::stats::Family;
use radianza::verify::agreement::{Estimated, agreement};
use std::path::Path;

fn parse(text: &str) -> desc::Scene {
    toml::parse(text, Path::new("lamps.toml")).unwrap_or_else(|e| panic!("{e}"))
}

/// Directions by the BSDF, points on lights, and both: images of independent numbers, of one mean.
fn strategies_agree(name: &str, desc: &desc::Scene) {
    let scene = Scene::compile(desc).unwrap_or_else(|e| panic!("{e}"));
    let image = |strategy, seed| {
        let settings = Settings { spp: 1024, replicate: 32, strategy, seed, ..settings([16, 16]) };
        Estimated::from(&film(&scene, &settings))
    };
    let reference = image(Strategy::Bsdf, 1);
    let mut checks = Family::new(name);
    for (strategy, seed) in [(Strategy::Light, 2), (Strategy::Mis, 3)] {
        agreement(&mut checks, &format!("{strategy:?} = bsdf"), &image(strategy, seed), &reference);
    }
    checks.assert();
}

/// A floor, seen from above, under lamps.
fn floor(lamps: &str) -> String {
    format!(
        r#"
        [camera]
        position = [0, 1.5, 2]
        target = [0, 0, 0]
        view_angle = 60
        resolution = [16, 16]
        [texture.checker]
        type = "checker"
        even = [1, 1, 1]
        odd = [0.2, 0.2, 0.2]
        scale = [3, 2]
        [material.floor]
        type = "diffuse"
        reflectance = 0.5
        [[shape]]
        type = "quad"
        corner = [-3, 0, 3]
        edge_u = [6, 0, 0]
        edge_v = [0, 0, -6]
        material = "floor"
        {lamps}
        "#
    )
}

/// Light is met with the probability of the coverage, and drawn with its weight.
#[test]
fn lamps_with_holes() {
    let lamp = |shape: &str, keys: &str| {
        floor(&format!(
            "[material.lamp]\ntype = 'diffuse'\nreflectance = 0.4\nemission = [4, 2, 1]\n{keys}\n[[shape]]\nmaterial = 'lamp'\n\
             emission_sides = 'both'\n{shape}"
        ))
    };
    let quad = "type = 'quad'\ncorner = [-0.7, 0.8, -0.6]\nedge_u = [1.5, 0, 0]\nedge_v = [0, 0.3, 1.2]";
    let sphere = "type = 'sphere'\ncenter = [0.2, 0.9, 0]\nradius = 0.5";
    let cylinder = "type = 'cylinder'\nfrom = [-0.6, 0.7, 0]\nto = [0.7, 0.9, 0.1]\nradius = 0.4";
    for (name, shape) in [("quad", quad), ("sphere", sphere), ("cylinder", cylinder)] {
        strategies_agree(&format!("{name}, blended"), &parse(&lamp(shape, "opacity = 0.5")));
        strategies_agree(&format!("{name}, blended by a texture"), &parse(&lamp(shape, "opacity = 'checker'")));
        let cut = "opacity = 'checker'\nopacity_cutoff = 0.5";
        strategies_agree(&format!("{name}, cut"), &parse(&lamp(shape, cut)));
    }
}

/// The vertices' alpha is a coverage too, also where their colours are white, and in instances of one mesh.
#[test]
fn lamps_with_transparent_vertices() {
    let text = floor("[material.lamp]\ntype = 'absorb'\nopacity = 0.9\nemission = [4, 2, 1]");
    let mut scene = parse(&text);
    let mut mesh = desc::primitives::quad(glam::Vec3::ZERO, glam::Vec3::X, glam::Vec3::Z);
    mesh.colors = [0.1, 1.0, 0.6, 0.2].map(|alpha| glam::Vec4::new(1.0, 1.0, 1.0, alpha)).to_vec();
    let shape = scene.shapes.len();
    scene.shapes.push(desc::Shape::Mesh(mesh.into()));
    let material = scene.materials.iter().position(|m| m.name == "lamp").expect("the lamp's material");
    for x in [-1.2, 0.3] {
        let to_world = glam::Mat4::from_translation(glam::Vec3::new(x, 0.8, -0.3));
        let object = desc::Object { shape, material, to_world, ..scene.objects[0].clone() };
        scene.objects.push(object);
    }
    strategies_agree("vertex alpha", &scene);
}
