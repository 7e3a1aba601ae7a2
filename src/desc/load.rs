//! One door for all formats.

use super::{Error, Scene};
use std::path::Path;

/// Reads a scene file of any known format, by its extension: `.toml`, `.gltf`, `.glb`, `.obj`, `.ply`.
pub fn load(path: &Path) -> Result<Scene, Error> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
    match extension.as_str() {
        other => {
            let message = format!("extension `.{other}` is not known; expected .toml, .gltf, .glb, .obj or .ply");
            Err(Error::unsupported(path, "", message))
        }
    }
}
