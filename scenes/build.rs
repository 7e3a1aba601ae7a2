//! Writes a list of the files of this folder into the build: `radianza verify` checks the renderer with them wherever it is
//! installed. Cargo runs it again when a file is added or changed.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo:rerun-if-changed=scenes");
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").ok_or(io::ErrorKind::NotFound)?).join("scenes");
    let mut files = Vec::new();
    list(&root, &root, &mut files)?;
    files.sort();
    let mut text = String::from("&[\n");
    for (name, path) in files {
        text += &format!("    ({name:?}, include_bytes!({path:?})),\n");
    }
    text += "]\n";
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or(io::ErrorKind::NotFound)?).join("scenes.rs");
    fs::write(out, text)
}

/// Name with `/` between parts, and path, of all scenes and of what they refer to.
fn list(root: &Path, folder: &Path, files: &mut Vec<(String, PathBuf)>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            list(root, &path, files)?;
        } else if path.extension().is_some_and(|e| ["toml", "png", "hdr", "ies"].iter().any(|known| e == *known)) {
            let parts = path.strip_prefix(root).map_err(io::Error::other)?.iter().map(|part| part.to_string_lossy());
            files.push((parts.collect::<Vec<_>>().join("/"), path.clone()));
        }
    }
    Ok(())
}
