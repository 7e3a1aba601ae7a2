//! `scenes/materials/`: a scene for each glTF extension that shows. Its picture is the one in `reference/materials/`, within
//! the errors that both images carry; and it is another one where the extension is ignored.
//!
//! References are made by
//! ```text
//! radianza render scenes/materials/NAME.glb --size 48x36 --spp 1024 --replicate 16 --seed 1 --layers beauty,stderr \
//!     -o reference/materials/NAME.exr
//! ```

use radianza::desc::{self, Filter, Integrator, Options, SamplerKind, Strategy};
use radianza::film::Image;
use radianza::film::exr::read_exr;
use radianza::render::{Settings, render};
use radianza::scene::Scene;
use radianza::stats::Family;
use radianza::verify::agreement::{Estimated, agreement};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Replicates of a reference.
const REPLICATES: u32 = 64;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The scenes, with the extension that each is about.
fn scenes() -> Vec<(PathBuf, String)> {
    let list = std::fs::read_dir(root().join("scenes/materials")).unwrap().map(|entry| entry.unwrap().path());
    let mut scenes: Vec<(PathBuf, String)> = list
        .map(|path| {
            let name = path.file_stem().unwrap().to_str().unwrap().replace('-', "_");
            let extension = match name.as_str() {
                "specular_glossiness" => "KHR_materials_pbrSpecularGlossiness".to_owned(),
                "lights_punctual" | "texture_transform" => format!("KHR_{name}"),
                _ => format!("KHR_materials_{name}"),
            };
            (path, extension)
        })
        .collect();
    scenes.sort();
    assert!(scenes.len() >= 16, "{scenes:?}");
    scenes
}

/// Takes an extension out of a value, wherever it stands.
fn strip(value: &mut Value, extension: &str) {
    match value {
        Value::Object(map) => {
            if let Some(Value::Object(extensions)) = map.get_mut("extensions") {
                extensions.remove(extension);
            }
            map.values_mut().for_each(|value| strip(value, extension));
        }
        Value::Array(list) => list.iter_mut().for_each(|value| strip(value, extension)),
        _ => {}
    }
}

/// A binary glTF file without an extension.
fn without(bytes: &[u8], extension: &str) -> Vec<u8> {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let (json, rest) = bytes[20..].split_at(word(12) as usize);
    let mut document: Value = serde_json::from_slice(json).unwrap();
    strip(&mut document, extension);
    let mut text = serde_json::to_vec(&document).unwrap();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut file = bytes[..8].to_vec();
    file.extend(((20 + text.len() + rest.len()) as u32).to_le_bytes());
    file.extend((text.len() as u32).to_le_bytes());
    file.extend(&bytes[16..20]);
    file.extend(&text);
    file.extend(rest);
    file
}

/// The picture of a file, in a variant of it.
fn picture(bytes: &[u8], path: &Path, variant: Option<&str>) -> Estimated {
    let nothing = |name: &str, _: &str| -> Result<Vec<u8>, desc::Error> { panic!("{name} is not in the file") };
    let options = Options { variant: variant.map(str::to_owned), ..Options::default() };
    let mut scene = desc::gltf::parse_with(bytes, path, &nothing, &options).unwrap_or_else(|e| panic!("{e}"));
    desc::complete(&mut scene);
    let settings = Settings {
        size: [48, 36],
        crop: [0, 0, 48, 36],
        camera: 0,
        spp: 64,
        time: None,
        replicate: 4,
        integrator: Integrator::Path,
        strategy: Strategy::Mis,
        sampler: SamplerKind::Lattice,
        seed: 7,
        max_depth: None,
        filter: Filter::BlackmanHarris,
        transport: false,
        threads: 0,
        tile: 16,
    };
    let output = render(&Scene::compile(&scene).unwrap(), &settings, &AtomicBool::new(false), &|_| {}).unwrap();
    assert_eq!(output.bad_count, 0, "{}: {:?}", path.display(), output.bad);
    (&output.film).into()
}

/// A stored picture with its errors.
fn stored(path: &Path) -> Estimated {
    let image = read_exr(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let layer = |name: &str| -> Vec<[f64; 3]> {
        let [r, g, b] = image.rgb(name).unwrap_or_else(|| panic!("{} has no {name}", path.display()));
        (0..r.len()).map(|i| [r[i], g[i], b[i]].map(f64::from)).collect()
    };
    Estimated::new(image.window_size(), &layer(Image::BEAUTY), &layer("stderr"), REPLICATES)
}

/// Mean of min(z², 25) over pixels and channels: about 1.1 for two pictures of one thing, whose errors come from few
/// replicates and rare paths.
fn distance(a: &Estimated, b: &Estimated) -> f64 {
    let pixels = a.pixels.iter().zip(&b.pixels);
    let differences = pixels.flat_map(|(a, b)| (0..3).map(|c| a[c].minus(b[c]))).filter(|d| d.mean != 0.0);
    let z2: Vec<f64> = differences.map(|d| (d.mean / d.se).powi(2).min(25.0)).collect();
    z2.iter().sum::<f64>() / z2.len() as f64
}

/// Distance beyond which two pictures are of two things.
const APART: f64 = 2.6;

#[test]
fn pictures_are_those_of_the_reference() {
    let mut checks = Family::new("scenes/materials");
    for (path, _) in scenes() {
        let name = path.file_stem().unwrap().to_str().unwrap();
        let reference = stored(&root().join(format!("reference/materials/{name}.exr")));
        let picture = picture(&std::fs::read(&path).unwrap(), &path, None);
        agreement(&mut checks, name, &picture, &reference);
        let distance = distance(&picture, &reference);
        println!("{name}: {distance:.2} from its reference");
        assert!(distance < APART, "{name} is {distance} away from its reference");
    }
    checks.assert();
}

#[test]
fn an_extension_that_is_ignored_shows() {
    for (path, extension) in scenes() {
        let name = path.file_stem().unwrap().to_str().unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let plain = without(&bytes, &extension);
        assert_ne!(plain, bytes, "{name} does not use {extension}");
        // Variants are asked for by name; the others show by themselves.
        let other =
            if name == "variants" { picture(&bytes, &path, Some("green")) } else { picture(&plain, &path, None) };
        let reference = stored(&root().join(format!("reference/materials/{name}.exr")));
        let mut checks = Family::new(name);
        agreement(&mut checks, name, &other, &reference);
        let distance = distance(&other, &reference);
        println!("{name}: {distance:.2} away without {extension}");
        assert!(!checks.passes() || distance > APART, "{name} looks the same without {extension}");
    }
}
