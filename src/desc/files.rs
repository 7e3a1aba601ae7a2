//! Reading what a scene file refers to, and nothing outside its folder.

use super::Error;
use std::path::{Path, PathBuf};

/// Largest file that is read \[bytes\].
const MAX_BYTES: u64 = 4 << 30;

/// Reads a whole file.
pub fn read(path: &Path) -> Result<Vec<u8>, Error> {
    let fail = |e: std::io::Error| Error::missing(path, "", format!("cannot be read: {e}"));
    let meta = std::fs::metadata(path).map_err(fail)?;
    if !meta.is_file() {
        return Err(Error::missing(path, "", "is not a file"));
    }
    if meta.len() > MAX_BYTES {
        return Err(Error::invalid(path, "", format!("has {} bytes; at most {MAX_BYTES} are read", meta.len())));
    }
    std::fs::read(path).map_err(fail)
}

/// A file's name as others may write it too, without the parts that change nothing: `a/b` of `./a//b`. What is read once
/// for each name is then read once for each file, links apart.
pub(super) fn plain(name: &str) -> String {
    let mut parts: Vec<&str> = Vec::new();
    for part in name.split('/') {
        match part {
            "" | "." => {}
            ".." if parts.last().is_some_and(|last| *last != "..") => _ = parts.pop(),
            _ => parts.push(part),
        }
    }
    let root = if name.starts_with('/') { "/" } else { "" };
    format!("{root}{}", parts.join("/"))
}

/// Files in memory: names with `/` between parts, and contents.
pub type Held = &'static [(&'static str, &'static [u8])];

/// The folder of the scene file `scene`, in which everything that it refers to must lie.
#[derive(Clone, Debug)]
pub struct Folder {
    scene: PathBuf,
    held: Option<Held>,
}

impl Folder {
    /// The folder of this scene file.
    pub fn of(scene: &Path) -> Self {
        Self { scene: scene.into(), held: None }
    }

    /// The folder of this scene file among files in memory.
    pub fn held(scene: &Path, files: Held) -> Self {
        Self { scene: scene.into(), held: Some(files) }
    }

    /// The file that the scene calls `name` (relative, `/` between parts), or an error that names `place` in the
    /// scene file. Links are followed before the check that it lies inside the folder.
    pub fn resolve(&self, name: &str, place: &str) -> Result<PathBuf, Error> {
        if self.held.is_some() {
            let message = format!("`{name}`: geometry is read from files, not from memory");
            return Err(Error::unsupported(&self.scene, place, message));
        }
        self.identity(name, place)?;
        Ok(self.path().join(name))
    }

    /// The one path of the file that the scene calls `name`, equal for all its names: canonical, without links. Fails
    /// like [`Self::resolve`].
    pub fn identity(&self, name: &str, place: &str) -> Result<PathBuf, Error> {
        let folder = self.path();
        if self.held.is_some() {
            return Ok(folder.join(name));
        }
        let missing = |e: std::io::Error| Error::missing(&self.scene, place, format!("`{name}` cannot be read: {e}"));
        let root = folder.canonicalize().map_err(missing)?;
        let path = root.join(name).canonicalize().map_err(missing)?;
        if !path.starts_with(&root) {
            let message = format!("`{name}` lies outside the scene's folder; copy or link it there");
            return Err(Error::invalid(&self.scene, place, message));
        }
        Ok(path)
    }

    fn path(&self) -> &Path {
        match self.scene.parent() {
            Some(p) if !p.as_os_str().is_empty() => p,
            _ => Path::new("."),
        }
    }

    /// Reads the file that the scene calls `name`.
    pub fn read(&self, name: &str, place: &str) -> Result<Vec<u8>, Error> {
        if let Some(files) = self.held {
            let folder = self.scene.parent().unwrap_or(Path::new(""));
            let found = files.iter().find(|(held, _)| folder.join(name) == Path::new(held));
            let missing = || Error::missing(&self.scene, place, format!("`{name}` is not among the files in memory"));
            return found.map(|(_, bytes)| bytes.to_vec()).ok_or_else(missing);
        }
        let path = self.resolve(name, place)?;
        read(&path).map_err(|e| Error {
            message: format!("`{name}`: {}", e.message),
            file: self.scene.clone(),
            place: place.into(),
            ..e
        })
    }
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn names_of_one_file_are_one() {
        for name in ["a/b.png", "./a/b.png", "a//b.png", "a/./b.png", "c/../a/b.png"] {
            assert_eq!(plain(name), "a/b.png");
        }
        assert_eq!([plain("/a"), plain("../../a"), plain(".")], ["/a", "../../a", ""]);
    }
}
