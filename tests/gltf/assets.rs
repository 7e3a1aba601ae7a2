//! Real files: every one is read, or ends with the error that names what it requires.

use radianza::desc::{ErrorKind, Scene, Shape, gltf};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// What is required, and not honoured, by which file.
const REFUSED: [(&str, &str); 4] = [
    ("AnimatedMorphCube.gltf", "KHR_mesh_quantization"),
    ("ChessBoard-draco.glb", "KHR_draco_mesh_compression"),
    ("DreamApartment-meshopt.glb", "EXT_meshopt_compression"),
    ("StainedGlassLamp.gltf", "KHR_texture_basisu"),
];

/// What is used and noted by which file.
const NOTED: [(&str, &str); 5] = [
    ("AnisotropyStrengthTest.glb", "KHR_materials_anisotropy"),
    ("AttenuationTest.glb", "attenuation is not honoured yet"),
    ("ClearCoatTest.glb", "KHR_materials_clearcoat"),
    ("SheenCloth.gltf", "KHR_materials_sheen"),
    ("SimpleInstancing.glb", "EXT_mesh_gpu_instancing"),
];

#[test]
fn every_file_is_read_or_refused_for_what_it_requires() {
    for path in assets() {
        let name = path.file_name().unwrap().to_str().unwrap();
        let json = document(&path);
        let required = json["extensionsRequired"].as_array().cloned().unwrap_or_default();
        let refused: Vec<_> =
            required.iter().filter_map(Value::as_str).filter(|e| !gltf::HONOURED.contains(e)).collect();
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
            objects += 1;
            triangles += json["accessors"][counted.as_u64().unwrap() as usize]["count"].as_u64().unwrap() / 3;
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
        let near = |a: &[f32], b: &[f32]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-5 * (1.0 + b.abs()));
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
        println!("skipped: RADIANZA_ASSETS names no folder that has `gltf`");
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
