//! Real files: every one is read, or ends with the error that names what it requires.

use radianza::desc::{ErrorKind, Model, Scene, Shape, gltf};
use radianza::glam::{Affine2, Vec2, Vec3};
use radianza::texture::Textures;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// What is required, and not honoured, by which file.
const REFUSED: &[(&str, &str)] = &[];

/// What is used and noted by which file.
const NOTED: &[(&str, &str)] = &[];

#[test]
fn every_file_is_read_or_refused_for_what_it_requires() {
    for path in assets() {
        let name = path.file_name().unwrap().to_str().unwrap();
        let json = document(&path);
        let required = json["extensionsRequired"].as_array().cloned().unwrap_or_default();
        let refused: Vec<_> = required.iter().filter_map(Value::as_str).filter(|e| !gltf::honoured(e)).collect();
        match gltf::read(&path) {
            Err(e) => {
                assert_eq!(e.kind, ErrorKind::Unsupported, "{e}");
                assert!(!refused.is_empty() && refused.iter().all(|r| e.message.contains(&format!("`{r}`"))), "{e}");
                if let Some((_, extension)) = REFUSED.iter().find(|(file, _)| *file == name) {
                    assert!(e.message.contains(extension), "{e}");
                }
                println!("{name}: {}", e.message);
            }
            Ok(scene) => {
                assert!(refused.is_empty() && REFUSED.iter().all(|(file, _)| *file != name), "{name} was not refused");
                compare(name, &scene, &json);
                for (_, words) in NOTED.iter().filter(|(file, _)| *file == name) {
                    assert!(scene.notes.iter().any(|n| n.contains(words)), "{name}: {:?}", scene.notes);
                }
                println!("{name}: {} objects, {} shapes", scene.objects.len(), scene.shapes.len());
            }
        }
    }
}

/// The tangents of a file that has them, made again without them.
#[test]
fn missing_tangents_are_those_that_an_exporter_writes() {
    for path in assets().iter().filter(|p| p.ends_with("SheenCloth.gltf")) {
        let own = gltf::read(path).unwrap();
        let mut json = document(path);
        let attributes = &mut json["meshes"][0]["primitives"][0]["attributes"];
        attributes.as_object_mut().unwrap().remove("TANGENT").expect("the file has tangents");
        // Its exporter made them for UV as stored, not as mirrored by the map's transform.
        json["materials"][0]["normalTexture"].as_object_mut().unwrap().remove("extensions").expect("a transform");
        let folder = path.parent().unwrap();
        let resolve = |name: &str, _: &str| Ok(std::fs::read(folder.join(name)).unwrap());
        let made = gltf::parse(&serde_json::to_vec(&json).unwrap(), path, &resolve).unwrap();
        let (Shape::Mesh(own), Shape::Mesh(made)) = (&own.shapes[0], &made.shapes[0]) else { panic!("no meshes") };
        assert_eq!(own.indices.len(), made.indices.len());
        let corners = own.indices.iter().flatten().zip(made.indices.iter().flatten());
        let (mut close, mut signs, mut all) = (0, 0, 0);
        for (a, b) in corners {
            let (a, b) = (own.tangents[*a as usize], made.tangents[*b as usize]);
            close += usize::from(a.truncate().dot(b.truncate()) > 0.99);
            signs += usize::from(a.w == b.w);
            all += 1;
        }
        println!("{close} tangents and {signs} signs of {all} agree");
        assert!(close as f64 > 0.99 * all as f64 && signs as f64 > 0.99 * all as f64, "{close}, {signs} of {all}");
    }
}

/// The test asset shows one picture three times: moved, turned and scaled by KHR_texture_transform on TEXCOORD_0 and on
/// TEXCOORD_1, and as it is. Every kind of texture must come out alike, point by point.
#[test]
fn transformed_textures_are_their_samples() {
    for path in assets().iter().filter(|p| p.ends_with("TextureTransformMultiTest.glb")) {
        let scene = gltf::read(path).unwrap();
        let textures = Textures::new(&scene);
        for kind in ["BaseColor", "Emission", "Normal", "MetalRough", "Unlit"] {
            let at = |which: &str, triangle: usize, b: Vec3, ignore: bool| {
                let name = format!("{kind}{which}");
                let object = scene.objects.iter().find(|o| o.name.contains(&name)).expect("an object of this name");
                let Shape::Mesh(mesh) = &scene.shapes[object.shape] else { panic!("no mesh") };
                let corners = mesh.indices[triangle].map(|i| i as usize);
                let p: Vec3 = (0..3).map(|i| b[i] * mesh.positions[corners[i]]).sum();
                let uv = [0, 1].map(|set| {
                    let uv = &mesh.uv[set];
                    (0..3).map(|i| if uv.is_empty() { Vec2::ZERO } else { b[i] * uv[corners[i]] }).sum()
                });
                let m = &scene.materials[object.material];
                let pbr = match &m.model {
                    Model::MetallicRoughness(pbr) => pbr.base_color.texture.or(pbr.roughness.texture.map(|t| t.0)),
                    _ => None,
                };
                let texture = pbr.or(m.normal_map.map(|n| n.texture)).or(m.emission.and_then(|e| e.radiance.texture));
                let mut texture = texture.expect("a texture");
                if ignore {
                    texture.transform = Affine2::IDENTITY;
                }
                (p, textures.lookup(&texture, &uv))
            };
            let mut off = [0.0; 4];
            for i in 0..400 {
                let (u, v) = (((i % 20) as f32 + 0.5) / 20.0, ((i / 20) as f32 + 0.5) / 20.0);
                let b =
                    if u + v < 1.0 { Vec3::new(u, v, 1.0 - u - v) } else { Vec3::new(1.0 - u, 1.0 - v, u + v - 1.0) };
                let triangle = usize::from(u + v >= 1.0);
                let (p, expected) = at("Sample", triangle, b, false);
                for (k, (which, ignore)) in
                    [("UV0", false), ("UV1", false), ("UV0", true), ("UV1", true)].into_iter().enumerate()
                {
                    let (q, found) = at(which, triangle, b, ignore);
                    assert!(p.abs_diff_eq(q, 1e-4), "{kind}: the meshes differ: {p}, {q}");
                    off[k] += (found - expected).truncate().abs().max_element() / 400.0;
                }
            }
            // Edges differ by the resolution of the pictures.
            println!("{kind}: mean difference {off:.4?}; the last two without the transform");
            let [a, b, c, d] = off;
            assert!(3.0 * a.max(b) < c.min(d), "{kind}: {off:?}");
        }
    }
}

/// Counts of the scene against those of the JSON, and its vertices against the bounds that the accessors state.
fn compare(name: &str, scene: &Scene, json: &Value) {
    let mut roots: Vec<usize> = indices(&json["scenes"][json["scene"].as_u64().unwrap_or(0) as usize]["nodes"]);
    let (mut objects, mut cameras, mut triangles) = (0, 0, 0);
    while let Some(node) = roots.pop() {
        let node = &json["nodes"][node];
        roots.extend(indices(&node["children"]));
        cameras += usize::from(!node["camera"].is_null());
        let Some(mesh) = node["mesh"].as_u64() else { continue };
        for primitive in json["meshes"][mesh as usize]["primitives"].as_array().unwrap() {
            let counted = if primitive["indices"].is_null() {
                &primitive["attributes"]["POSITION"]
            } else {
                &primitive["indices"]
            };
            let placed = &node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"];
            let instances = placed.as_u64().map_or(1, |a| json["accessors"][a as usize]["count"].as_u64().unwrap());
            objects += instances as usize;
            triangles +=
                instances * json["accessors"][counted.as_u64().unwrap() as usize]["count"].as_u64().unwrap() / 3;
        }
    }
    assert_eq!((scene.objects.len(), scene.cameras.len()), (objects, cameras), "{name}");

    // Only triangles without area may be lacking, and they are noted.
    let mesh = |shape: &Shape| match shape {
        Shape::Mesh(m) => m.clone(),
        other => panic!("{other:?}"),
    };
    let found: u64 = scene.objects.iter().map(|o| mesh(&scene.shapes[o.shape]).indices.len() as u64).sum();
    let dropped = scene.notes.iter().any(|n| n.contains("without area are dropped"));
    assert!(found == triangles || dropped && found < triangles, "{name}: {found} of {triangles} triangles");

    // Every mesh has the bounds of one of the POSITION accessors.
    let bounds: Vec<[Vec<f32>; 2]> = json["meshes"]
        .as_array()
        .unwrap()
        .iter()
        .flat_map(|m| m["primitives"].as_array().unwrap())
        .map(|p| {
            let a = &json["accessors"][p["attributes"]["POSITION"].as_u64().unwrap() as usize];
            ["min", "max"].map(|k| a[k].as_array().unwrap().iter().map(|x| x.as_f64().unwrap() as f32).collect())
        })
        .collect();
    for shape in &scene.shapes {
        let m = mesh(shape);
        let [low, high] =
            [m.positions.iter().copied().reduce(|a, b| a.min(b)), m.positions.iter().copied().reduce(|a, b| a.max(b))];
        let (low, high) = (low.unwrap().to_array(), high.unwrap().to_array());
        // Draco rounds to a grid, and exporters state the bounds from before.
        let rounding = if name.contains("draco") { 1e-3 } else { 1e-5 };
        let near = |a: &[f32], b: &[f32]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= rounding * (1.0 + b.abs()));
        assert!(bounds.iter().any(|[min, max]| near(&low, min) && near(&high, max)), "{name}: {low:?} {high:?}");
    }
}

fn indices(list: &Value) -> Vec<usize> {
    list.as_array().into_iter().flatten().map(|i| i.as_u64().unwrap() as usize).collect()
}

/// The JSON of a `.gltf` or `.glb` file.
fn document(path: &Path) -> Value {
    let bytes = std::fs::read(path).unwrap();
    let json = match bytes.starts_with(b"glTF") {
        true => &bytes[20..][..u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize],
        false => &bytes[..],
    };
    serde_json::from_slice(json).unwrap()
}

/// All glTF files of `$RADIANZA_ASSETS/gltf`, if this machine has it.
fn assets() -> Vec<PathBuf> {
    let folder = std::env::var_os("RADIANZA_ASSETS").map(|root| Path::new(&root).join("gltf"));
    let Some(folder) = folder.filter(|f| f.is_dir()) else {
        crate::skip::skip("RADIANZA_ASSETS names no folder that has `gltf`");
        return Vec::new();
    };
    let (mut files, mut folders) = (Vec::new(), vec![folder]);
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(&folder).unwrap().flatten().map(|entry| entry.path()) {
            match path.extension().and_then(|e| e.to_str()) {
                _ if path.is_dir() => folders.push(path),
                Some("glb" | "gltf") => files.push(path),
                _ => {}
            }
        }
    }
    files.sort();
    files
}
