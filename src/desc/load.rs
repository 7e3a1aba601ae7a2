//! One door for all formats.

use super::{Error, Scene, complete, gltf, obj, ply, toml};
use std::path::Path;

/// Reads a scene file of any known format, by its extension: `.toml`, `.gltf`, `.glb`, `.obj`, `.ply`. A scene
/// without a camera is framed, one without a light gets one; its notes say so.
pub fn load(path: &Path) -> Result<Scene, Error> {
    let mut scene = match extension(path).as_str() {
        "toml" => toml::read(path)?,
        _ => read_model(path)?,
    };
    complete(&mut scene);
    Ok(scene)
}

/// Reads a file of geometry as it is, without adding a camera or a light.
pub(super) fn read_model(path: &Path) -> Result<Scene, Error> {
    match extension(path).as_str() {
        "gltf" | "glb" => gltf::read(path),
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
