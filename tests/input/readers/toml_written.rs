//! What is written in our own format reads as the same scene.

use super::EVERYTHING;
use radianza::desc::toml::{parse, read, to_text, write};
use radianza::desc::*;
use radianza::glam::{Mat3, Vec3};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Everything that an image depends on.
fn assert_same(a: &Scene, b: &Scene, what: &str) {
    assert_eq!(a.name, b.name, "{what}");
    assert_eq!(a.cameras, b.cameras, "{what}");
    assert_eq!(a.objects, b.objects, "{what}");
    assert_eq!(a.materials, b.materials, "{what}");
    assert_eq!(a.textures, b.textures, "{what}");
    assert_eq!(a.lights, b.lights, "{what}");
    assert_eq!(a.environment, b.environment, "{what}");
    assert_eq!(a.render, b.render, "{what}");
    assert_eq!(a.expect, b.expect, "{what}");
    assert_eq!(a.shapes.len(), b.shapes.len(), "{what}");
    assert!(a.shapes == b.shapes, "{what}: other shapes");
    assert_eq!(a.images.len(), b.images.len(), "{what}");
    for (a, b) in a.images.iter().zip(&b.images) {
        assert_eq!((&a.name, a.size), (&b.name, b.size), "{what}");
        assert!(a.pixels == b.pixels, "{what}: other pixels of `{}`", a.name);
    }
}

/// Writes, reads and compares; by files and, where `inline`, as one text. Equal texts say that signs of zeros agree too.
fn round_trip(scene: &Scene, inline: bool) {
    let what = scene.source.as_deref().unwrap_or(Path::new("scene")).display().to_string();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("written.toml");
    let written = write(scene, "beside");
    std::fs::create_dir(folder.path().join("beside")).unwrap();
    std::fs::write(&path, &written.text).unwrap();
    for (name, bytes) in &written.files {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let back = read(&path).unwrap_or_else(|e| panic!("{what}: {e}"));
    assert_same(scene, &back, &what);
    assert!(write(&back, "beside") == written, "{what}: another text");

    if inline {
        let text = to_text(scene);
        let back = parse(&text, Path::new("nowhere/written.toml")).unwrap_or_else(|e| panic!("{what}: {e}\n{text}"));
        assert_same(scene, &back, &what);
        assert_eq!(to_text(&back), text);
    }
}

/// Scene files of a folder of the repository.
fn scenes(below: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(below);
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = files.filter(|p| p.is_file() && p.extension().is_some_and(|e| e != "rs")).collect();
    files.sort();
    files
}

#[test]
fn shipped_scenes_are_read_as_they_were() {
    let mut count = 0;
    for below in ["scenes", "scenes/materials", "scenes/verify"] {
        for path in scenes(below) {
            let scene = load(&path).unwrap_or_else(|e| panic!("{e}"));
            round_trip(&scene, below == "scenes/verify");
            count += 1;
        }
    }
    assert!(count > 90, "{count}");
}

#[test]
fn every_key_is_written() {
    round_trip(&parse(EVERYTHING, Path::new("everything.toml")).unwrap(), true);
}

/// A use of the texture with everything that a use may say.
fn textured(texture: usize, uv_set: usize) -> TextureRef {
    let transform = radianza::glam::Affine2::from_cols_array(&[0.1, -0.2, 0.3, 1e-7, 1e20, -0.0]);
    TextureRef { texture, uv_set, transform }
}

fn scalar(factor: f32) -> ScalarParam {
    ScalarParam { factor, texture: Some((textured(1, 1), 3)) }
}

fn color(factor: f32) -> ColorParam {
    ColorParam { factor: [factor, 1.0 / 3.0, 0.0], texture: Some(textured(0, 0)), vertex_color: true }
}

/// All fields of all models set to something that is no default.
fn models() -> Vec<Model> {
    let complex = Fresnel::Complex { eta: [0.1, 0.2, 1.0 / 3.0], k: [0.0, 1.5, 2.7] };
    let schlick = Fresnel::Schlick { f0: color(0.9) };
    let stretched = Roughness::Stretched { roughness: scalar(0.5), strength: scalar(0.25) };
    let film = Iridescence {
        factor: scalar(0.7),
        ior: 1.37,
        thickness: [100.0, 431.7],
        thickness_texture: Some((textured(1, 1), 1)),
    };
    let layers = Layers {
        anisotropy: Some(Anisotropy { strength: scalar(0.6), rotation: 0.123_456_7, direction: Some(textured(1, 1)) }),
        sheen: Some(Sheen { color: color(0.3), roughness: scalar(0.35) }),
        clearcoat: Some(Clearcoat {
            factor: scalar(0.9),
            roughness: scalar(0.01),
            normal_map: Some(NormalMap { texture: textured(1, 0), scale: -0.4 }),
        }),
    };
    let metallic = MetallicRoughness {
        base_color: ColorParam { vertex_color: false, ..color(0.8) },
        metallic: scalar(0.2),
        roughness: scalar(0.4),
        ior: 1.7,
        specular: scalar(0.5),
        specular_color: color(2.5),
        transmission: Some(Transmission { factor: scalar(0.5), thin: true }),
        layers,
        diffuse_transmission: Some(DiffuseTransmission { factor: scalar(0.45), color: color(0.55), thin: false }),
        iridescence: Some(film),
    };
    let mirror = Model::Mirror { reflectance: color(1.0) };
    let gloss = SpecularGlossiness { diffuse: color(0.5), specular: color(0.25), glossiness: scalar(0.75) };
    let rough = Model::RoughDiffuse { reflectance: ColorParam::constant([0.5; 3]), roughness: scalar(1.0) };
    vec![
        Model::Diffuse { reflectance: color(0.5) },
        Model::Diffuse { reflectance: ColorParam::constant([0.1, 0.2, 0.3]) },
        Model::RoughDiffuse { reflectance: color(0.5), roughness: ScalarParam::constant(0.0) },
        rough.clone(),
        Model::Phong { reflectance: color(0.5), exponent: 17.25 },
        mirror.clone(),
        Model::Dielectric { ior: 1.0 / 1.5, roughness: Roughness::Glossiness(scalar(0.9)), tint: color(0.9) },
        Model::Conductor { fresnel: complex.clone(), roughness: Roughness::Alpha([0.1, 0.3]) },
        Model::Conductor { fresnel: schlick.clone(), roughness: stretched },
        Model::CookTorrance { fresnel: complex, roughness: Roughness::Perceptual(scalar(0.3)) },
        Model::CookTorrance { fresnel: schlick, roughness: Roughness::Perceptual(ScalarParam::constant(0.0)) },
        Model::Mix(vec![(0.25, Model::Mix(vec![(0.5, mirror), (0.5, Model::Absorb)])), (0.75, rough)]),
        Model::MetallicRoughness(Box::new(metallic)),
        Model::SpecularGlossiness(Box::new(gloss)),
        Model::Absorb,
    ]
}

/// A scene of everything that a description can hold.
fn full() -> Scene {
    let toml = parse(EVERYTHING, Path::new("full.toml")).unwrap();
    let mut scene = Scene { cameras: toml.cameras.clone(), lights: toml.lights.clone(), ..Scene::default() };
    scene.name = "quotes \" \\ and \u{7} \u{e4}".into();
    scene.cameras[1].aspect = Some(4.0 / 3.0);
    let pixels = |x: f32| Pixels::Rgba32F(vec![[x, 1e-20, 3e20, 0.3], [0.0, 1.0 / 3.0, 0.7, 1.0]]);
    for (i, pixels) in [
        Pixels::Rgba8(vec![[0, 1, 2, 255], [7, 128, 250, 3]]),
        Pixels::Rgba16(vec![[0, 1, 65_535, 512], [9, 300, 40_000, 1]]),
        pixels(-1.5),
        pixels(0.1),
    ]
    .into_iter()
    .enumerate()
    {
        scene.images.push(Arc::new(Image { name: format!("picture {i}"), size: [2, 1], pixels }));
    }
    scene.textures = vec![
        Texture::Image { image: 0, srgb: true, wrap: [Wrap::Mirror, Wrap::Clamp], nearest: true },
        Texture::Image { image: 1, srgb: false, wrap: [Wrap::Repeat; 2], nearest: false },
        Texture::Checker { even: [0.1, 0.2, 0.3], odd: [1.0 / 3.0; 3], scale: [3.0, 0.7] },
        Texture::Image { image: 2, srgb: false, wrap: [Wrap::Clamp; 2], nearest: false },
    ];
    scene.environment = Some(Environment {
        radiance: [0.5, 1.0 / 3.0, 2.0],
        image: Some(3),
        to_world: Mat3::from_rotation_z(0.3) * Mat3::from_rotation_x(1.1),
    });
    scene.shapes = toml.shapes.clone();
    let mut mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(0.1, 0.2, 1.0 / 3.0)],
        indices: vec![[0, 1, 2], [3, 1, 0]],
        normals: vec![Vec3::new(1.0, 2.0, 3.0).normalize(); 4],
        tangents: vec![radianza::glam::Vec4::new(1.0, 0.0, 0.0, -1.0); 4],
        ..Mesh::default()
    };
    mesh.uv = [0.1, 0.7].map(|x| mesh.positions.iter().map(|p| p.truncate() * x).collect());
    mesh.colors = mesh.positions.iter().map(|p| p.extend(0.3).abs()).collect();
    scene.shapes.push(Shape::Mesh(mesh.into()));
    let emission = Emission { radiance: color(3.0), sides: Sides::Both, coat: Some(scalar(0.5)) };
    for (i, model) in models().into_iter().enumerate() {
        let mut material = Material::new(["", "twice", "twice"][i % 3], model);
        material.double_sided = i % 2 == 0;
        material.alpha = match i % 3 {
            0 => Alpha::Opaque,
            1 => Alpha::Blend { coverage: scalar(0.5) },
            _ => Alpha::Mask { coverage: scalar(1.0), cutoff: 1.5 },
        };
        material.emission = (i % 4 == 1).then_some(emission);
        material.normal_map = (i % 2 == 1).then_some(NormalMap { texture: textured(3, 1), scale: 0.25 });
        let dispersion = [Dispersion::None, Dispersion::InverseAbbe(1.0 / 58.7)][i % 2];
        if matches!(material.model, Model::Dielectric { .. } | Model::MetallicRoughness(_) | Model::Mix(_)) {
            material.interior = Interior { absorption: [0.1, 0.0, f32::MAX], priority: -3, dispersion };
        }
        scene.materials.push(material);
        let mut object = Object::new(i * 5 % scene.shapes.len(), i);
        object.to_world = toml.objects[i % toml.objects.len()].to_world;
        object.emission = (i % 3 == 2).then_some(emission);
        (object.reversed, object.closed) = (i % 2 == 1, i % 3 == 1);
        object.name = format!("object {}", i / 2);
        scene.objects.push(object);
    }
    for i in 0..scene.shapes.len() {
        scene.objects.push(Object::new(i, 0));
    }
    let profile = ies::Profile {
        kind: ies::Photometry::C,
        vertical: vec![0.0, 33.3, 90.0],
        horizontal: vec![0.0],
        candela: vec![100.0, 1.0 / 3.0, 0.0],
        tilt: Some(ies::Tilt { angles: vec![0.0, 90.0], factors: vec![1.0, 1.0 / 3.0] }),
    };
    let (position, range) = (Vec3::new(0.1, 0.2, 0.3), 7.7);
    let direction = Vec3::new(1.0, 2.0, 3.0).normalize();
    let (inner, outer) = (0.123_456_7, 0.987_654_3);
    scene.lights.extend([
        Light::Point { position, intensity: [1.0, 0.1, 1e-9], range },
        Light::Spot { position, direction, intensity: [1.0 / 3.0; 3], inner, outer, range },
        Light::Sun { direction, irradiance: [1.0; 3], diameter: 0.1 },
        Light::Profile {
            position,
            to_world: Mat3::from_rotation_y(0.7),
            intensity: [2.0; 3],
            profile: Arc::new(profile),
        },
    ]);
    scene
}

#[test]
fn everything_that_a_description_holds_is_written() {
    round_trip(&full(), true);
}

/// Every model, and every extension of glTF's alone and with all others.
#[test]
fn every_specimen_is_written() {
    let mut all = MetallicRoughness::default();
    let extended = specimens::EXTENSIONS.iter().map(|extension| {
        let mut one = MetallicRoughness::default();
        (extension.add)(&mut one);
        (extension.add)(&mut all);
        one
    });
    let mut models: Vec<_> = extended.map(|m| Model::MetallicRoughness(Box::new(m))).collect();
    models.push(Model::MetallicRoughness(Box::new(all)));
    models.extend(specimens::models());
    let sphere = Shape::Sphere { radius: 1.0 };
    let mut scene = Scene { name: "specimens".into(), shapes: vec![sphere], ..Scene::default() };
    for model in models {
        scene.objects.push(Object::new(0, scene.materials.len()));
        scene.materials.push(Material::new("specimen", model));
    }
    round_trip(&scene, true);
}

/// Pixels and vertices in files are those in the scene.
#[test]
fn files_beside_lose_nothing() {
    let mut scene = full();
    let images = scene.images.iter_mut().zip([1u32, 2, 3, 5]);
    for (image, k) in images {
        let image = Arc::make_mut(image);
        image.size = [16, 16];
        let code = |i: usize, c: usize| ((i as u32).wrapping_mul(2_654_435_761) >> (c as u32 + k)) as u16;
        let float = |i: usize, c: usize| if c == 3 { 1.0 } else { f32::from(code(i, c)) * 0.037 };
        image.pixels = match image.pixels {
            Pixels::Rgba8(_) => Pixels::Rgba8((0..256).map(|i| [0, 1, 2, 3].map(|c| code(i, c) as u8)).collect()),
            Pixels::Rgba16(_) => Pixels::Rgba16((0..256).map(|i| [0, 1, 2, 3].map(|c| code(i, c))).collect()),
            Pixels::Rgba32F(_) => Pixels::Rgba32F((0..256).map(|i| [0, 1, 2, 3].map(|c| float(i, c))).collect()),
        };
    }
    let Some(Shape::Mesh(mesh)) = scene.shapes.last_mut() else { panic!() };
    let mesh = Arc::make_mut(mesh);
    mesh.indices = mesh.indices.repeat(40);
    assert_eq!(write(&scene, "beside").files.len(), 5);
    round_trip(&scene, true);
}

#[test]
fn short_numbers_are_short() {
    let text = to_text(&parse(EVERYTHING, Path::new("everything.toml")).unwrap());
    for part in ["horizontal_view_angle = 60\n", "radius = 0.1\n", "type = \"sphere\"\n", "exposure = -1.5\n"] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
    assert!(text.lines().all(|line| line.chars().count() < 400), "{text}");
}
