//! Emissive surfaces: however light is sampled, the image is one.

use crate::common::{film, settings};
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
            "[material.lamp]\ntype = 'diffuse'\nreflectance = 0.4\n{keys}\n[[shape]]\nmaterial = 'lamp'\n\
             emission = [4, 2, 1]\nemission_sides = 'both'\n{shape}"
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

/// A view of nothing but what is at the origin, of about 1 m.
fn close_up(shapes: &str) -> String {
    format!(
        r#"
        [camera]
        position = [4, 5, 6]
        target = [0, 0, 0]
        view_angle = 4
        resolution = [8, 8]
        [material.metal]
        type = "conductor"
        reflectance = 1
        roughness = 0.4
        [material.white]
        type = "diffuse"
        reflectance = 1
        {shapes}
        "#
    )
}

/// Nothing of a convex body is seen from it: it has the radiance that it emits, to the last bit, whatever it reflects and
/// however light is sampled.
#[test]
fn convex_lamps_do_not_light_themselves() {
    let mut scenes = Vec::new();
    for material in ["metal", "white"] {
        for shape in [
            "type = 'box'\nmin = [-1, -1, -1]\nmax = [1, 1, 1]",
            "type = 'sphere'",
            "type = 'disk'\nnormal = [1, 2, 3]",
            "type = 'cylinder'\nfrom = [1, 0, -1]\nto = [-1, 0, 1]",
            "type = 'quad'\ncorner = [-1, -1, 0.1]\nedge_u = [2, 0.2, 0]\nedge_v = [0, 2, 0.1]",
        ] {
            for sides in ["front", "both"] {
                let text =
                    format!("[[shape]]\n{shape}\nmaterial = '{material}'\nemission = 4\nemission_sides = '{sides}'");
                scenes.push((format!("{material} {shape}, {sides}"), parse(&close_up(&text))));
            }
        }
        // Meshes: flat triangles, and normals that make them round.
        for round in [false, true] {
            let text =
                format!("[[shape]]\ntype = 'sphere'\nmaterial = '{material}'\nemission = 4\nemission_sides = 'both'");
            let mut scene = parse(&close_up(&text));
            let (positions, indices) = crate::common::closed_mesh(12, 1.0, glam::Vec3::ZERO);
            let normals = if round { positions.clone() } else { Vec::new() };
            let mesh = desc::Mesh { positions, indices, normals, ..desc::Mesh::default() };
            scene.shapes[0] = desc::Shape::Mesh(mesh.into());
            scenes.push((format!("{material} mesh, round: {round}"), scene));
        }
    }
    for (name, desc) in scenes {
        let scene = Scene::compile(&desc).unwrap_or_else(|e| panic!("{e}"));
        for strategy in [Strategy::Bsdf, Strategy::Light, Strategy::Mis, Strategy::Cosine] {
            let image = film(&scene, &Settings { spp: 16, replicate: 4, strategy, ..settings([8, 8]) });
            for [x, y] in image.pixels() {
                assert_eq!(image.mean(x, y), [4.0; 3], "{name}, {strategy:?}, pixel {x}, {y}");
            }
        }
    }
}

/// A lamp over a point of the floor, a thousand kilometres from the origin, where neighbours in f32 are 6 cm apart.
fn far_away(shapes: &str) -> String {
    format!(
        r#"
        [camera]
        position = [1000003, 1000004, 1000001]
        target = [1000000, 1000000, 1000000]
        view_angle = 4
        resolution = [16, 16]
        [material.floor]
        type = "diffuse"
        reflectance = 0.5
        [[shape]]
        type = "quad"
        corner = [999990, 1000000, 1000010]
        edge_u = [20, 0, 0]
        edge_v = [0, 0, -20]
        material = "floor"
        [material.black]
        type = "absorb"
        {shapes}
        "#
    )
}

/// Lamps about 10 m above the floor.
const FAR_LAMPS: [&str; 4] = [
    "type = 'quad'\ncorner = [999990, 1000010, 999990]\nedge_u = [20, 0, 0]\nedge_v = [0, 0, 20]",
    "type = 'quad'\ncorner = [999990, 1000010, 999990]\nedge_u = [20, 2, 0]\nedge_v = [-2, 1, 20]",
    "type = 'disk'\ncenter = [1000000, 1000010, 1000000]\nnormal = [0, -1, 0]\nradius = 10",
    "type = 'sphere'\ncenter = [1000000, 1000015, 1000000]\nradius = 5",
];

/// Shadow rays reach as far as the lamp: a sheet one metre before it leaves nothing of it.
#[test]
fn what_is_right_before_a_lamp_shadows() {
    let sheet = "[[shape]]\ntype = 'quad'\ncorner = [999985, 1000009, 1000015]\nedge_u = [30, 0, 0]\nedge_v = [0, 0, -30]\n\
                 material = 'black'\n";
    for lamp in FAR_LAMPS {
        let text = far_away(&format!("[[shape]]\n{lamp}\nemission = 4\n{sheet}"));
        let scene = Scene::compile(&parse(&text)).unwrap_or_else(|e| panic!("{e}"));
        for strategy in [Strategy::Bsdf, Strategy::Light, Strategy::Mis] {
            let image = film(&scene, &Settings { spp: 64, strategy, ..settings([8, 8]) });
            let lit = image.pixels().filter(|&[x, y]| image.mean(x, y) != [0.0; 3]).count();
            assert_eq!(lit, 0, "{lamp}, {strategy:?}");
        }
    }
}

/// Lamps of some hundred metres.
#[test]
fn lamps_far_from_the_origin() {
    for lamp in [
        "type = 'quad'\ncorner = [999000, 1000900, 999000]\nedge_u = [2000, 100, 0]\nedge_v = [-100, 50, 2000]",
        "type = 'disk'\ncenter = [1000000, 1000900, 1000000]\nnormal = [0.1, -1, 0]\nradius = 900",
        "type = 'sphere'\ncenter = [1000000, 1001500, 1000000]\nradius = 600",
        "type = 'cylinder'\nfrom = [999000, 1001500, 1000000]\nto = [1001000, 1001500, 1000000]\nradius = 500",
    ] {
        strategies_agree(lamp, &parse(&far_away(&format!("[[shape]]\n{lamp}\nemission = 4\nemission_sides = 'both'"))));
    }
}

/// The triangles of a lamp that adjoin the one that light is drawn from do not hide it, however coarse the numbers are: many
/// give what two do, alone and in instances.
#[test]
fn neighbours_in_a_lamp_do_not_hide_it() {
    let cells = 32;
    let at = |i: u32| (f64::from(i) / f64::from(cells) * 20.0 - 10.0) as f32;
    let mut many = desc::Mesh::default();
    for k in 0..(cells + 1) * (cells + 1) {
        many.positions.push(glam::Vec3::new(at(k % (cells + 1)), 0.0, at(k / (cells + 1))));
    }
    for k in 0..cells * cells {
        let corner = k / cells * (cells + 1) + k % cells;
        let [a, b, c, d] = [corner, corner + 1, corner + cells + 2, corner + cells + 1];
        many.indices.extend([[a, b, c], [a, c, d]]);
    }
    let edge = |axis: glam::Vec3| axis * 20.0;
    let two = desc::primitives::quad(glam::Vec3::new(-10.0, 0.0, -10.0), edge(glam::Vec3::X), edge(glam::Vec3::Z));
    let text =
        far_away("[[shape]]\ntype = 'quad'\ncorner = [0, 0, 0]\nedge_u = [1, 0, 0]\nedge_v = [0, 0, 1]\nemission = 4");
    for copies in [1, 4] {
        let image = |mesh: &desc::Mesh, seed| {
            let mut desc = parse(&text);
            let object = desc.objects.pop().expect("a lamp");
            desc.shapes[object.shape] = desc::Shape::Mesh(mesh.clone().into());
            for copy in 0..copies {
                let place = glam::Vec3::new(1e6, 1e6 + 10.0, 1e6 + 30.0 * copy as f32);
                let turn =
                    glam::Quat::from_rotation_y(0.3 * copy as f32) * glam::Quat::from_rotation_x(0.1 * copy as f32);
                let to_world = glam::Mat4::from_rotation_translation(turn, place);
                desc.objects.push(desc::Object { to_world, ..object.clone() });
            }
            let scene = Scene::compile(&desc).unwrap_or_else(|e| panic!("{e}"));
            let settings = Settings { spp: 1024, replicate: 32, strategy: Strategy::Light, seed, ..settings([16, 16]) };
            Estimated::from(&film(&scene, &settings))
        };
        let mut checks = Family::new(format!("{copies} lamps"));
        agreement(&mut checks, "many triangles = two", &image(&many, 1), &image(&two, 2));
        checks.assert();
    }
}

/// Quadrics that shine in a few places are drawn there, from outside and inside, under any map.
#[test]
fn lamps_with_bright_spots() {
    use desc::{ColorParam, Emission, Image, Pixels, Sides, Texture, TextureRef, Wrap};
    let pixel =
        |k: u32| if [[5, 1], [2, 4], [7, 6]].contains(&[k % 8, k / 8]) { [9.0, 6.0, 3.0, 1.0] } else { [0.1; 4] };
    let image = Image { name: "spots".into(), size: [8, 8], pixels: Pixels::Rgba32F((0..64).map(pixel).collect()) };
    let texture = Texture::Image { image: 0, srgb: false, wrap: [Wrap::Clamp; 2], nearest: true };
    for (shape, tilt) in [
        ("type = 'sphere'\nradius = 0.6", 0.0),
        ("type = 'sphere'\nradius = 7", 0.0),
        ("type = 'sphere'\nradius = 0.6", 1.0),
        ("type = 'cylinder'\nfrom = [-0.8, 0, 0]\nto = [0.8, 0, 0]\nradius = 0.4", 0.0),
        ("type = 'disk'\nnormal = [0.2, -1, 0.1]\nradius = 0.9", 1.0),
    ] {
        let mut scene = parse(&floor(&format!("[[shape]]\n{shape}\nemission = 1")));
        scene.images.push(std::sync::Arc::new(image.clone()));
        let index = scene.textures.len();
        scene.textures.push(texture.clone());
        let map = TextureRef { texture: index, uv_set: 0, transform: glam::Affine2::IDENTITY };
        let radiance = ColorParam { factor: [1.0; 3], texture: Some(map), vertex_color: false };
        let lamp = scene.objects.last_mut().expect("a lamp");
        lamp.emission = Some(Emission { radiance, sides: Sides::Both, coat: None });
        let stretch = glam::Vec3::new(1.0, 1.0 - 0.5 * tilt, 1.0 + 0.4 * tilt);
        let up = glam::Mat4::from_translation(glam::Vec3::Y);
        lamp.to_world = up * glam::Mat4::from_scale(stretch) * glam::Mat4::from_rotation_z(tilt) * lamp.to_world;
        strategies_agree(&format!("{shape}, tilt {tilt}"), &scene);
    }
}
