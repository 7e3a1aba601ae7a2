//! One door for all formats.

use super::{Error, Scene, complete, gltf, obj, ply, toml};
use std::path::Path;

/// What is chosen of a file that holds more than one picture. By default what it states without animations and variants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Time of its animations \[s\]; `None`: the pose that its nodes state, which need not be that at 0 s.
    pub at: Option<f64>,
    /// Name of the variant whose materials it has.
    pub variant: Option<String>,
}

/// Reads a scene file of any known format, by its extension: `.toml`, `.gltf`, `.glb`, `.obj`, `.ply`. A scene
/// without a camera is framed, one without a light gets one; its notes say so.
pub fn load(path: &Path) -> Result<Scene, Error> {
    load_with(path, &Options::default())
}

/// Reads a scene file like [`load`], at a time and in a variant. They hold for all files of a scene, as far as these
/// move and have it; that no file has the variant is an error of kind [`Choice`](super::ErrorKind::Choice).
pub fn load_with(path: &Path, options: &Options) -> Result<Scene, Error> {
    let mut scene = match extension(path).as_str() {
        "toml" => toml::read_with(path, options)?,
        _ => read_model(path, options)?,
    };
    if let Some(variant) = options.variant.as_ref().filter(|name| !scene.variants.contains(name)) {
        let names: Vec<_> = scene.variants.iter().map(|name| format!("`{name}`")).collect();
        let expected = if names.is_empty() { "it has none".into() } else { format!("it has {}", names.join(", ")) };
        return Err(Error::choice(path, format!("has no variant `{variant}`; {expected}")));
    }
    if options.at.is_some() && scene.duration.is_none() {
        scene.notes.push("nothing moves in this scene: it is the same at all times".into());
    }
    complete(&mut scene);
    Ok(scene)
}

/// Reads a file of geometry as it is, without adding a camera or a light.
pub(super) fn read_model(path: &Path, options: &Options) -> Result<Scene, Error> {
    match extension(path).as_str() {
        "gltf" | "glb" => gltf::read_with(path, options),
        "obj" => obj::read(path),
        "ply" => ply::read(path),
        other => {
            let message = format!("extension `.{other}` is not known; expected .toml, .gltf, .glb, .obj or .ply");
            Err(Error::unsupported(path, "", message))
        }
    }
}

fn extension(path: &Path) -> String {
    path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase()
}
