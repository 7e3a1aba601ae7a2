//! `verify::scene`: healthy files pass, and each defect is found where it is.

use radianza::desc::{self, Shape, complete, toml};
use radianza::glam::Vec3;
use radianza::scene::Scene;
use radianza::verify::{self, Report, Size, Task};
use std::path::Path;
use std::sync::Arc;

fn read(text: &str) -> desc::Scene {
    let mut scene = toml::parse(text, Path::new("test.toml")).unwrap_or_else(|e| panic!("{e}"));
    complete(&mut scene);
    scene
}

/// Runs the tasks whose names contain one of `only`.
fn verify(scene: desc::Scene, only: &[&str]) -> Report {
    let compiled = Scene::compile(&scene).unwrap_or_else(|e| panic!("{e}"));
    let only: Vec<String> = only.iter().map(|s| s.to_string()).collect();
    let mut tasks = verify::scene::tasks(&Arc::new(scene), &Arc::new(compiled));
    tasks.retain(|task: &Task| task.matches(&only));
    verify::run(&tasks, Size::Default, 1, 1e-4, &|_| {})
}

/// Topics with a failing check, each once.
fn failing(report: &Report) -> Vec<&'static str> {
    let mut topics: Vec<&str> = report.failures().map(|(section, _)| section.topic.id).collect();
    topics.dedup();
    topics
}

/// Whether some sentence of the report holds all of `parts`.
#[track_caller]
fn says(report: &Report, parts: &[&str]) {
    let words: Vec<&String> = report.sections.iter().flat_map(|s| &s.words).collect();
    assert!(words.iter().any(|w| parts.iter().all(|p| w.contains(p))), "nothing says {parts:?}: {words:#?}");
}

/// A tetrahedron with a material `grey`; `indices` are its triangles.
fn tetrahedron(indices: &str, keys: &str) -> String {
    format!(
        r#"
        [material.grey]
        type = "diffuse"
        reflectance = 0.5
        [[shape]]
        name = "tent"
        type = "mesh"
        material = "grey"
        positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        indices = {indices}
        {keys}
        "#
    )
}

const CLOSED: &str = "[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]";

#[test]
fn a_healthy_scene_passes() {
    let text = r#"
        [material.gold]
        type = "conductor"
        metal = "Au"
        roughness = 0.8
        [material.glass]
        type = "dielectric"
        ior = 1.5
        roughness = 0.3
        [[shape]]
        name = "ball"
        type = "sphere"
        material = "gold"
        [[shape]]
        name = "brick"
        type = "box"
        material = "glass"
        closed = true
        min = [2, 0, 0]
        max = [3, 1, 1]
        [[light]]
        type = "point"
        position = [0, 5, 0]
        intensity = 20
    "#;
    let report = verify(read(text), &["data", "normals", "leaks", "material"]);
    assert!(report.passes(), "{:#?}", report.failures().collect::<Vec<_>>());
    says(&report, &["`brick`", "rays from inside, none got out"]);
    says(&report, &["`gold`: sends on at most", "cos"]);
    says(&report, &["`gold`: made white it sends on all"]);
    let topics: Vec<&str> = report.sections.iter().map(|s| s.topic.id).collect();
    assert_eq!(topics, ["data", "normals", "leaks", "material", "material"]);
}

#[test]
fn the_image_of_a_healthy_scene_passes() {
    let report = verify(read(&tetrahedron(CLOSED, "")), &["furnace", "census", "agreement"]);
    assert!(report.passes(), "{:#?}", report.failures().collect::<Vec<_>>());
    assert_eq!(report.sections.len(), 5);
    says(&report, &["samples: none is NaN"]);
    says(&report, &["Uniform (finds", "Light (finds"]);
}

#[test]
fn a_hole_in_what_is_declared_closed_is_a_leak() {
    let whole = verify(read(&tetrahedron(CLOSED, "closed = true")), &["leaks"]);
    assert!(whole.passes());
    let holed = verify(read(&tetrahedron("[[0, 2, 1], [0, 1, 3], [1, 2, 3]]", "closed = true")), &["leaks"]);
    assert_eq!(holed.failures().count(), 2, "{:#?}", holed.sections);
    says(&holed, &["`tent` is declared closed, but 3 of 6 edges are open"]);
    says(&holed, &["rays from inside got out; the first at"]);
    let silent = verify(read(&tetrahedron("[[0, 2, 1], [0, 1, 3], [1, 2, 3]]", "")), &["leaks"]);
    assert!(silent.passes(), "an open mesh is no defect unless it is declared closed");
    says(&silent, &["`tent` (3 of 6 edges)", "are open"]);
}

#[test]
fn a_gltf_node_declares_a_surface_closed() {
    let gltf = |extras: &str| {
        // One triangle: 3 × 12 bytes of positions.
        let bytes: Vec<u8> = [0f32, 0., 0., 1., 0., 0., 0., 1., 0.].iter().flat_map(|x| x.to_le_bytes()).collect();
        let json = format!(
            r#"{{"asset": {{"version": "2.0"}}, "nodes": [{{"mesh": 0, "name": "n"{extras}}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
            "buffers": [{{"uri": "b.bin", "byteLength": 36}}]}}"#
        );
        let scene = desc::gltf::parse(json.as_bytes(), Path::new("t.gltf"), &|_, _| Ok(bytes.clone()));
        scene.unwrap_or_else(|e| panic!("{e}")).objects[0].closed
    };
    assert!(gltf(r#", "extras": {"closed": true}"#));
    assert!(!gltf(r#", "extras": {"closed": false}"#) && !gltf(""));
}

#[test]
fn inverted_normals_are_told_and_survived() {
    let outward = "normals = [[-1, -1, -1], [3, -1, -1], [-1, 3, -1], [-1, -1, 3]]";
    let inverted = "normals = [[1, 1, 1], [-3, 1, 1], [1, -3, 1], [1, 1, -3]]";
    let good = verify(read(&tetrahedron(CLOSED, outward)), &["normals"]);
    says(&good, &["1 mesh: every triangle has an area"]);
    let bad = verify(read(&tetrahedron(CLOSED, inverted)), &["normals", "data"]);
    assert!(bad.passes());
    says(&bad, &["`tent`", "of 4 triangles run clockwise", "first: triangle"]);
}

#[test]
fn broken_numbers_fail_and_odd_ones_are_told() {
    let mut scene = read(&tetrahedron(CLOSED, ""));
    let Shape::Mesh(mesh) = &mut scene.shapes[0] else { panic!("a mesh") };
    let mesh = std::sync::Arc::make_mut(mesh);
    mesh.normals = vec![Vec3::Z, Vec3::NAN, Vec3::Z * 3.0, Vec3::NAN];
    scene.materials[0].model = desc::Model::Diffuse { reflectance: desc::ColorParam::constant([0.5, 1.2, 0.5]) };
    let report = verify(scene, &["data", "normals"]);
    assert_eq!(failing(&report), ["data"], "frames survive what data does not");
    says(&report, &["`tent`: 2 normals not finite (first: vertex 1)"]);
    says(&report, &["`tent`: 1 normal not of unit length (first: vertex 2)"]);
    says(&report, &["`grey`: reflectance is 1.2"]);
}

#[test]
fn glass_that_is_not_closed_shines_in_a_furnace() {
    let text = r#"
        [material.glass]
        type = "dielectric"
        ior = 1.5
        [[shape]]
        name = "pane"
        type = "quad"
        material = "glass"
        corner = [-1, -1, 0]
        edge_v = [2, 0, 0]
        edge_u = [0, 2, 0]
        [[camera]]
        position = [0, 0, 3]
        target = [0, 0, 0]
        view_angle = 30
    "#;
    let report = verify(read(text), &["furnace/as", "leaks"]);
    assert_eq!(failing(&report), ["furnace"], "{:#?}", report.sections);
    says(&report, &["energy comes out of nothing: pixel (", "the back of `glass` is seen"]);
    says(&report, &["`glass` on `pane`", "refract but are not closed"]);
}

#[test]
fn answers_in_the_file_are_compared() {
    let text = |answer: f64| {
        format!(
            r#"
            [environment]
            radiance = 2
            [material.white]
            type = "diffuse"
            reflectance = 0.5
            [[shape]]
            type = "sphere"
            material = "white"
            [[camera]]
            position = [0, 0, 1.5]
            target = [0, 0, 0]
            view_angle = 20
            resolution = [4, 4]
            [[expect]]
            radiance = {answer}
            formula = "rho L"
            strategies = ["mis"]
            samplers = ["sobol"]
            "#
        )
    };
    assert!(verify(read(&text(1.0)), &["expect"]).passes());
    let wrong = verify(read(&text(1.02)), &["expect"]);
    assert_eq!(failing(&wrong), ["expect"]);
}

#[test]
fn an_empty_scene_and_one_without_surfaces_end() {
    let mut empty = desc::Scene::default();
    complete(&mut empty);
    assert!(verify(empty, &[]).passes());
    let mut dark = read("[material.m]\ntype = \"diffuse\"\nreflectance = 0.5");
    dark.cameras.clear();
    assert!(verify(dark, &["data", "normals", "leaks", "material", "furnace", "agreement", "expect"]).passes());
}

/// Channels of a thin film have noise of their own: the brightest channel of each pixel, chosen by that noise, is brighter
/// than any channel on average.
#[test]
fn noise_of_single_channels_is_no_energy() {
    let constant = desc::ScalarParam::constant;
    let film =
        desc::Iridescence { factor: constant(1.0), ior: 1.3, thickness: [100.0, 400.0], thickness_texture: None };
    let glass = desc::MetallicRoughness {
        base_color: desc::ColorParam::constant([1.0; 3]),
        metallic: constant(0.0),
        roughness: constant(0.0),
        ior: 1.5,
        specular: constant(1.0),
        specular_color: desc::ColorParam::constant([1.0; 3]),
        transmission: Some(desc::Transmission { factor: constant(1.0), thin: false }),
        layers: desc::Layers::default(),
        diffuse_transmission: None,
        iridescence: Some(film),
    };
    let mut scene = desc::Scene::default();
    scene.materials.push(desc::Material::new("film", desc::Model::MetallicRoughness(Box::new(glass))));
    scene.shapes.push(Shape::Sphere { radius: 1.0 });
    scene.objects.push(desc::Object::new(0, 0));
    complete(&mut scene);
    let report = verify(scene, &["furnace/as written"]);
    assert!(report.passes(), "{:#?}", report.failures().collect::<Vec<_>>());
    let channels = report.checks().filter(|(_, check)| check.name.ends_with("B: `film` ≤ 1")).count();
    assert!(channels > 0, "the blue channel is tested by itself: {:#?}", report.sections);
}
