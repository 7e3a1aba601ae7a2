//! The scene files of the crate, held in the binary: what `scenes/` has wherever the repository is not.

use crate::desc::files::{Folder, Held};
use crate::desc::{self, Error, complete, toml};
use std::path::Path;

/// All of them with the images they refer to.
static FILES: Held = include!(concat!(env!("OUT_DIR"), "/scenes.rs"));

/// Names of the scenes: `cornell-box.toml`, `verify/f1-diffuse.toml`, in alphabetical order.
pub fn names() -> impl Iterator<Item = &'static str> {
    FILES.iter().map(|(name, _)| *name).filter(|name| name.ends_with(".toml"))
}

/// Reads a scene by its name.
pub fn load(name: &str) -> Result<desc::Scene, Error> {
    let path = Path::new(name);
    let found = FILES.iter().find(|(held, _)| *held == name);
    let (_, bytes) = found.ok_or_else(|| Error::missing(path, "", "is not among the scenes of the crate"))?;
    let text = std::str::from_utf8(bytes).map_err(|e| Error::invalid(path, "", format!("is not UTF-8 text: {e}")))?;
    let mut scene = toml::parse_in(text, path, Folder::held(path, FILES))?;
    complete(&mut scene);
    Ok(scene)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_without_files_of_geometry_is_read() {
        for name in names().filter(|&name| name != "outdoor.toml") {
            assert!(load(name).is_ok_and(|scene| !scene.objects.is_empty()), "{name}: {:?}", load(name));
        }
        let error = load("outdoor.toml").map(|_| ()).expect_err("a file of geometry");
        assert!(error.to_string().contains("pavilion.glb"), "{error}");
        assert!(load("verify/no-such.toml").is_err());
    }
}
