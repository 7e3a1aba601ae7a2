//! Scenes in our own format.

use super::{ExportError, Written};
use crate::desc::{Scene, toml};
use crate::film::file::{check_writable, write_atomic};
use std::io::Write;
use std::path::Path;

/// Writes everything that `scene` has to the TOML file `path`, large meshes and images into the folder `NAME-toml` beside it.
/// The scene file comes last, so that it never names what is not there.
pub fn write_toml(scene: &Scene, path: &Path) -> Result<Written, ExportError> {
    let folder = format!("{}-toml", path.file_stem().unwrap_or_default().to_string_lossy());
    let written = toml::write(scene, &folder);
    let put = |path: &Path, bytes: &[u8]| {
        let done = check_writable(path).and_then(|()| write_atomic(path, |file| file.write_all(bytes)));
        done.map_err(|e| ExportError::Output(path.into(), e))
    };
    check_writable(path).map_err(|e| ExportError::Output(path.into(), e))?;
    for (name, bytes) in &written.files {
        put(&path.with_file_name(name), bytes)?;
    }
    put(path, written.text.as_bytes())?;
    Ok(Written { files: written.files.len(), notes: Vec::new() })
}
