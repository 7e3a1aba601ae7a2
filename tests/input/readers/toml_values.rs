//! What is written arrives in the scene.

use super::{EVERYTHING, folder, png};
use radianza::desc::toml::{parse, read};
use radianza::desc::*;
use radianza::glam::{Mat4, Vec2, Vec3, Vec4};
use std::f32::consts::PI;
use std::path::Path;

/// The scene that a text describes.
fn scene(text: &str) -> Scene {
    parse(text, Path::new("scene.toml")).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn close(a: Vec3, b: Vec3) -> bool {
    (a - b).length() <= 1e-5 * (1.0 + b.length())
}

#[test]
fn the_documented_example_is_read() {
    let source = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/src/desc/toml/mod.rs"));
    let docs = source.lines().map_while(|l| l.strip_prefix("//!")).map(|l| l.strip_prefix(' ').unwrap_or(l));
    let example: Vec<_> = docs.skip_while(|l| *l != "```toml").skip(1).take_while(|l| *l != "```").collect();
    let scene = scene(&example.join("\n"));
    assert_eq!(scene.name, "A ball in a room");
    assert_eq!((scene.objects.len(), scene.lights.len(), scene.render.spp), (2, 1, Some(64)));
}

#[test]
fn an_empty_text_is_an_empty_scene_named_after_the_file() {
    let scene = scene("");
    assert_eq!(scene.name, "scene");
    assert_eq!(scene.source.as_deref(), Some(Path::new("scene.toml")));
    assert!(scene.objects.is_empty() && scene.cameras.is_empty() && scene.environment.is_none());
}

#[test]
fn cameras() {
    let s = scene(EVERYTHING);
    let [main, ortho, sphere] = &s.cameras[..] else { panic!("{} cameras", s.cameras.len()) };
    assert_eq!(main.name, "main");
    assert_eq!(main.projection, Projection::Perspective { fov: Fov::Horizontal(60.0f32.to_radians()) });
    assert_eq!(main.resolution, Some([320, 200]));
    assert_eq!(main.lens, Some(Lens { radius: 0.1, focus_distance: 7.5 }));
    assert_eq!(main.to_world, Mat4::from_translation(Vec3::new(1.0, 2.0, 10.0)));
    assert_eq!(ortho.projection, Projection::Orthographic { half_height: 2.0 });
    assert!(close(ortho.to_world.transform_vector3(Vec3::NEG_Z), Vec3::NEG_Y));
    assert!(close(ortho.to_world.transform_vector3(Vec3::Y), Vec3::NEG_Z));
    assert_eq!(sphere.projection, Projection::Equirectangular);
    assert!(close(sphere.to_world.transform_vector3(Vec3::NEG_Z), Vec3::X));
    assert!(close(sphere.to_world.transform_vector3(Vec3::X), Vec3::Z));
}

#[test]
fn camera_defaults() {
    let s = scene("[camera]\nposition = [0, 0, 2]\ntarget = [0, 0, 0]\nlens_radius = 0.5\n");
    assert_eq!(s.cameras[0].projection, Projection::Perspective { fov: Fov::Vertical(45.0f32.to_radians()) });
    assert_eq!(s.cameras[0].lens, Some(Lens { radius: 0.5, focus_distance: 2.0 }));
    assert_eq!(s.cameras[0].resolution, None);
}

/// A material by its name.
fn material<'a>(s: &'a Scene, name: &str) -> &'a Material {
    s.materials.iter().find(|m| m.name == name).unwrap()
}

#[test]
fn interiors() {
    let s = scene(
        "[material.wine]\ntype = 'dielectric'\nattenuation_color = [1, 0.5, 0.25]\nattenuation_distance = 2\npriority = -1
        [material.flint]\ntype = 'dielectric'\nabsorption = 3\nabbe = 40
        [material.curve]\ntype = 'dielectric'\ncauchy = [1.5, 0.01]
        [material.plastic]\ntype = 'metallic-roughness'\ntransmission = 1\nthin = false\nabsorption = [1, 2, 3]",
    );
    let Interior { absorption: [r, g, b], priority, dispersion } = material(&s, "wine").interior;
    assert!(r == 0.0 && (g - 0.5 * 2f32.ln()).abs() < 1e-7 && (b - 2f32.ln()).abs() < 1e-7);
    assert_eq!((priority, dispersion), (-1, Dispersion::None));
    let flint = material(&s, "flint").interior;
    assert_eq!((flint.absorption, flint.dispersion), ([3.0; 3], Dispersion::InverseAbbe(1.0 / 40.0)));
    let curve = material(&s, "curve");
    assert_eq!(curve.interior.dispersion, Dispersion::Cauchy([1.5, 0.01]));
    let Model::Dielectric { ior, .. } = curve.model else { panic!() };
    assert!((ior - 1.528_966).abs() < 1e-5, "{ior}");
    assert_eq!(material(&s, "plastic").interior.absorption, [1.0, 2.0, 3.0]);
}

#[test]
fn materials() {
    let s = scene(EVERYTHING);
    let white = ColorParam { vertex_color: true, ..ColorParam::constant([0.7, 0.6, 0.5]) };
    assert_eq!(material(&s, "white").model, Model::Diffuse { reflectance: white });

    let tiles = material(&s, "tiles");
    let Model::Diffuse { reflectance } = tiles.model else { panic!("{tiles:?}") };
    assert_eq!(reflectance.factor, [0.5; 3]);
    let used = reflectance.texture.unwrap();
    // Scale, then rotation by 90°, then shift: (1, 0) → (2, 0) → (0, 2) → (0.5, 2).
    assert!((used.transform.transform_point2(Vec2::X) - Vec2::new(0.5, 2.0)).length() < 1e-6);
    let checker = Texture::Checker { even: [0.9; 3], odd: [0.1, 0.2, 0.3], scale: [4.0, 2.0] };
    assert_eq!(s.textures[used.texture], checker);
    let Alpha::Mask { coverage, cutoff } = tiles.alpha else { panic!("{tiles:?}") };
    assert_eq!((coverage.texture.unwrap().1, cutoff), (1, 0.25));
    assert_eq!(tiles.normal_map.unwrap().scale, 2.0);

    assert_eq!(material(&s, "mirror").model, Model::Mirror { reflectance: ColorParam::constant([1.0; 3]) });
    let Model::Dielectric { ior, roughness, tint } = material(&s, "glass").model else { panic!() };
    assert_eq!((ior, roughness), (1.33, Roughness::Alpha([0.1, 0.2])));
    // sRGB 128/255 is 0.21586 linear.
    assert!((tint.factor[0] - 0.215_861).abs() < 1e-6 && tint.factor[1..] == [1.0, 0.0]);
    let Model::Conductor { fresnel: Fresnel::Complex { eta, k }, roughness } = material(&s, "gold").model else {
        panic!()
    };
    assert!(eta[0] < eta[2] && k[0] > k[2], "gold reflects red more than blue");
    assert_eq!(roughness, Roughness::Perceptual(ScalarParam::constant(0.3)));
    let plastic = material(&s, "plastic");
    let Model::MetallicRoughness(m) = &plastic.model else { panic!() };
    assert_eq!((m.metallic, m.ior), (ScalarParam::constant(0.0), 1.5));
    assert_eq!(m.transmission, Some(Transmission { factor: ScalarParam::constant(0.5), thin: false }));
    let emission = Emission { radiance: ColorParam::constant([2.0; 3]), sides: Sides::Both, coat: None };
    assert_eq!(plastic.emission, Some(emission));
    let Model::Mix(parts) = &material(&s, "blend").model else { panic!() };
    assert_eq!((parts[0].0, parts[1].0), (0.25, 0.5));
    assert_eq!(parts[1].1, material(&s, "mirror").model);
}

#[test]
fn metals_reflect_as_measured() {
    // Reflectance at normal incidence ((η − 1)² + κ²)/((η + 1)² + κ²) in green.
    for (symbol, expected) in [("Ag", 0.98), ("Al", 0.92), ("Au", 0.79), ("Cu", 0.62), ("Fe", 0.51)] {
        let s = scene(&format!("[material.m]\ntype = 'conductor'\nmetal = '{symbol}'"));
        let Model::Conductor { fresnel: Fresnel::Complex { eta, k }, .. } = s.materials[0].model else { panic!() };
        let r = ((eta[1] - 1.0).powi(2) + k[1].powi(2)) / ((eta[1] + 1.0).powi(2) + k[1].powi(2));
        assert!((r - expected).abs() < 0.01, "{symbol}: {r}");
    }
}

#[test]
fn shapes() {
    let s = scene(EVERYTHING);
    let [ball, disk, cylinder, quad, cuboid, mesh, ..] = &s.objects[..] else { panic!() };
    assert_eq!((ball.name.as_str(), &s.shapes[ball.shape]), ("ball", &Shape::Sphere { radius: 2.0 }));
    // Centre (1, 0, 0), scaled by 2, shifted by (0, 3, 0).
    assert!(close(ball.to_world.transform_point3(Vec3::ZERO), Vec3::new(2.0, 3.0, 0.0)));
    assert!(close(ball.to_world.transform_point3(Vec3::Y), Vec3::new(2.0, 5.0, 0.0)));

    assert_eq!(s.shapes[disk.shape], Shape::Disk { radius: 1.0 });
    assert!(close(disk.to_world.transform_vector3(Vec3::Z), Vec3::Y));
    let emission = Emission { radiance: ColorParam::constant([17.0, 12.0, 4.0]), sides: Sides::Both, coat: None };
    assert_eq!(disk.emission, Some(emission));
    assert_eq!(s.materials[disk.material].model, Model::Absorb);

    assert_eq!(s.shapes[cylinder.shape], Shape::Cylinder { radius: 0.5, height: 5.0 });
    assert!(close(cylinder.to_world.transform_point3(Vec3::Z * 5.0), Vec3::new(0.0, 3.0, 4.0)));
    assert!(cylinder.reversed && !disk.reversed);

    let Shape::Mesh(m) = &s.shapes[quad.shape] else { panic!() };
    assert_eq!(m.positions[2], Vec3::new(1.0, 2.0, 0.0));
    assert_eq!((m.indices.len(), m.uv[0].len()), (2, 4));

    // A quarter turn about y takes +x to −z.
    assert!(close(cuboid.to_world.transform_vector3(Vec3::X), Vec3::NEG_Z));
    let Shape::Mesh(m) = &s.shapes[cuboid.shape] else { panic!() };
    assert_eq!(m.indices.len(), 12);

    let Shape::Mesh(m) = &s.shapes[mesh.shape] else { panic!() };
    assert_eq!(m.indices, [[0, 1, 2]]);
    assert_eq!(m.normals, [Vec3::Z; 3], "normals are unit, and that of length 0 is the triangle's");
    assert_eq!(m.colors[1], Vec4::new(0.0, 1.0, 0.0, 1.0));
    // Scale (1, 2, 3), shift by 5 along x, then (x, −z, y).
    assert!(close(mesh.to_world.transform_point3(Vec3::ONE), Vec3::new(6.0, -3.0, 2.0)));
    assert!(s.notes.iter().any(|n| n.contains("1 triangles without area were left out")), "{:?}", s.notes);
}

#[test]
fn quads_by_edges() {
    let s = scene(
        "[material.a]\ntype = 'absorb'\n[[shape]]\ntype = 'quad'\ncorner = [1, 0, 0]\nedge_u = [0, 2, 0]\nedge_v = [0, 0, 3]\nmaterial = 'a'",
    );
    let Shape::Mesh(m) = &s.shapes[0] else { panic!() };
    assert_eq!(**m, primitives::quad(Vec3::X, Vec3::Y * 2.0, Vec3::Z * 3.0));
}

#[test]
fn groups_share_their_shapes() {
    let s = scene(EVERYTHING);
    let placed = &s.objects[6..];
    assert_eq!((s.shapes.len(), placed.len()), (6 + 2, 6));
    assert_eq!(placed[0].shape, placed[2].shape);
    assert_eq!(placed[3].name, "four/pair");
    // The second pair's second sphere: 3 along x, 5 along z, 100 up.
    assert!(close(placed[3].to_world.transform_point3(Vec3::ZERO), Vec3::new(3.0, 100.0, 5.0)));
    assert_eq!(s.materials[placed[1].material].name, "mirror");
    assert!(placed[4..].iter().all(|o| s.materials[o.material].name == "gold"));
    assert!(close(placed[5].to_world.transform_point3(Vec3::X), Vec3::new(8.0, 0.0, 0.0)));
    let point = Light::Point { position: Vec3::new(0.0, 101.0, 5.0), intensity: [3.0; 3], range: f32::INFINITY };
    assert_eq!(s.lights[1], point);
    assert_eq!(
        s.lights[2],
        Light::Point { position: Vec3::new(0.0, 2.0, 0.0), intensity: [3.0; 3], range: f32::INFINITY }
    );
}

#[test]
fn lights_and_environment() {
    let s = scene(EVERYTHING);
    let [point, spot, sun] = &s.lights[3..] else { panic!("{:?}", s.lights) };
    let Light::Point { intensity, .. } = point else { panic!() };
    assert!((intensity[0] - 1.0).abs() < 1e-6, "4π W are 1 W/sr");
    let (inner, outer) = (10.0f32.to_radians(), 30.0f32.to_radians());
    let (position, direction) = (Vec3::Y * 5.0, Vec3::NEG_Y);
    assert_eq!(
        *spot,
        Light::Spot { position, direction, intensity: [1.0, 2.0, 3.0], inner, outer, range: f32::INFINITY }
    );
    assert_eq!(*sun, Light::Directional { direction: Vec3::NEG_Y, irradiance: [4.0; 3] });
    let environment = s.environment.unwrap();
    assert_eq!((environment.radiance, environment.image), ([2.0, 4.0, 6.0], None));
    // Counter-clockwise from above: what lay towards −z now lies towards −x.
    assert!(close(environment.to_world * Vec3::NEG_Z, Vec3::NEG_X));
}

#[test]
fn settings_and_expectations() {
    let s = scene(EVERYTHING);
    let expected = RenderSettings {
        spp: Some(64),
        integrator: Some(Integrator::Path),
        strategy: Some(Strategy::Mis),
        sampler: Some(SamplerKind::Sobol),
        seed: None,
        max_depth: Some(8),
        filter: Some(Filter::BlackmanHarris),
        tonemap: Some(Tonemap::Reinhard),
        exposure: Some(-1.5),
    };
    assert_eq!(s.render, expected);
    assert_eq!((s.expect[0].radiance, s.expect[0].region), (Some(Value::Grey(0.5)), Some([0, 0, 10, 10])));
    assert_eq!(s.expect[1].layers["DD"], Value::Rgb([1.0, 2.0, 3.0]));
    assert_eq!((s.expect[1].max_depth, s.expect[1].tolerance), (Some(2), 1e-3));
    assert_eq!(scene("[expect]\nradiance = 1").expect.len(), 1);
}

#[test]
fn images_are_linear_or_not_by_use() {
    let text = "[texture.t]\nfile = 'maps/t.png'\nwrap = ['clamp', 'mirror']\nfilter = 'nearest'\n\
                [material.m]\ntype = 'diffuse'\nreflectance = 't'\nnormal_map = 't'\n";
    let files = folder(&[("scene.toml", text.as_bytes()), ("maps/t.png", &png())]);
    let s = read(&files.path().join("scene.toml")).unwrap();
    assert_eq!((s.images.len(), s.images[0].size), (1, [2, 1]));
    let image = |srgb| Texture::Image { image: 0, srgb, wrap: [Wrap::Clamp, Wrap::Mirror], nearest: true };
    let m = &s.materials[0];
    let Model::Diffuse { reflectance } = m.model else { panic!() };
    assert_eq!(s.textures[reflectance.texture.unwrap().texture], image(true));
    assert_eq!(s.textures[m.normal_map.unwrap().texture.texture], image(false));
}

#[test]
fn environment_images_are_made_linear() {
    let files = folder(&[("scene.toml", b"[environment]\nfile = 'sky.png'\nstrength = 3\n"), ("sky.png", &png())]);
    let s = read(&files.path().join("scene.toml")).unwrap();
    assert_eq!(s.environment.as_ref().unwrap().radiance, [3.0; 3]);
    let Pixels::Rgba32F(pixels) = &s.images[s.environment.unwrap().image.unwrap()].pixels else { panic!() };
    assert_eq!(pixels[1][0], 1.0);
    assert!((pixels[1][1] - 0.215_861).abs() < 1e-6);
}

#[test]
fn files_are_placed_and_shared() {
    let obj = "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
    let mtl = "newmtl red\nKd 1 0 0\nmap_Kd t.png\n";
    let text = "[texture.c]\ntype = 'checker'\n[material.own]\ntype = 'diffuse'\nreflectance = 'c'\n\
        [[shape]]\ntype = 'file'\nfile = 't.obj'\ntranslate = [0, 0, 7]\n\
        [[shape]]\ntype = 'file'\nfile = 't.obj'\nmaterial = 'own'\nemission = 1\nname = 'copy'\n";
    let files = folder(&[
        ("scene.toml", text.as_bytes()),
        ("t.obj", obj.as_bytes()),
        ("t.mtl", mtl.as_bytes()),
        ("t.png", &png()),
    ]);
    let s = read(&files.path().join("scene.toml")).unwrap();
    let [first, copy] = &s.objects[..] else { panic!("{:?}", s.objects) };
    assert_eq!((s.shapes.len(), first.shape, copy.shape), (1, 0, 0));
    assert_eq!(first.to_world, Mat4::from_translation(Vec3::Z * 7.0));
    assert_eq!((s.materials[first.material].name.as_str(), s.materials[copy.material].name.as_str()), ("red", "own"));
    let Model::Diffuse { reflectance } = s.materials[first.material].model else { panic!() };
    // The file's texture 0 comes after the scene's own.
    let Texture::Image { image, .. } = s.textures[reflectance.texture.unwrap().texture] else { panic!() };
    assert_eq!(s.images[image].name, "t.png");
    assert!(first.emission.is_none() && copy.emission.is_some());
    assert_eq!(copy.name, "copy");
}

#[test]
fn what_is_missing_is_completed_and_said() {
    let text = "[material.m]\ntype = 'absorb'\n[[shape]]\ntype = 'sphere'\ncenter = [10, 20, 30]\nradius = 5\nmaterial = 'm'\n";
    let files = folder(&[("scene.toml", text.as_bytes())]);
    let s = load(&files.path().join("scene.toml")).unwrap();
    assert_eq!(s.environment.as_ref().unwrap().radiance, [1.0; 3]);
    assert!(
        s.notes.iter().any(|n| n.contains("no camera")) && s.notes.iter().any(|n| n.contains("no light")),
        "{:?}",
        s.notes
    );

    // Every point of the sphere lies inside a square image.
    let camera = &s.cameras[0];
    let Projection::Perspective { fov: Fov::Vertical(angle) } = camera.projection else { panic!() };
    let inverse = camera.to_world.inverse();
    for i in 0..1000 {
        let (z, phi) = (i as f32 / 499.5 - 1.0, i as f32 * 2.4);
        let r = (1.0 - z * z).max(0.0).sqrt();
        let p = Vec3::new(10.0, 20.0, 30.0) + 5.0 * Vec3::new(r * phi.cos(), r * phi.sin(), z);
        let q = inverse.transform_point3(p);
        let edge = (0.5 * angle).tan() * -q.z;
        assert!(q.z < 0.0 && q.x.abs() < edge && q.y.abs() < edge, "{p}");
    }
    assert!(angle < PI);

    let lit = format!("{text}emission = 1\n");
    let mut s = scene(&lit);
    complete(&mut s);
    assert!(s.environment.is_none());
    let dark = format!("{text}emission = 0\n");
    let mut s = scene(&dark);
    complete(&mut s);
    assert!(s.environment.is_some());
}
