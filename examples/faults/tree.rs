//! The copies of the tree in which faults are planted.

use super::patch::{FilePatch, Patch, Result};
use std::collections::BTreeMap;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// Top-level entries that no program is built from.
const LEFT_OUT: [&str; 6] = ["target", "out", "reference", "examples", "tests", "README.md"];

/// Files by their path from the root.
pub(crate) type Files = BTreeMap<PathBuf, Vec<u8>>;

/// The original, in memory.
pub(crate) struct Tree {
    original: Files,
}

impl Tree {
    /// Reads what the program below `root` is built from.
    pub(crate) fn new(root: &Path) -> Result<Self> {
        let mut original = Files::new();
        for entry in entries(root)? {
            let name = entry.file_name().unwrap_or_default().to_string_lossy();
            if !name.starts_with('.') && !LEFT_OUT.contains(&&*name) {
                read(root, &entry, &mut original)?;
            }
        }
        Ok(Self { original })
    }

    /// Makes the folder `copy` equal to the original but for the files of `changed`. A file is written only where it
    /// differs, so that cargo builds no more than what has changed; what belongs to neither is taken away.
    pub(crate) fn copy(&self, copy: &Path, changed: &Files) -> Result<()> {
        let mut old = Files::new();
        if copy.exists() {
            read(copy, copy, &mut old)?;
        }
        for path in old.keys().filter(|path| !self.original.contains_key(*path)) {
            fs::remove_file(copy.join(path)).map_err(|e| format!("{}: {e}", path.display()))?;
        }
        for (path, bytes) in &self.original {
            let bytes = changed.get(path).unwrap_or(bytes);
            if old.get(path) != Some(bytes) {
                write(&copy.join(path), bytes)?;
            }
        }
        Ok(())
    }

    /// A number that tells trees apart: of the original, or with a fault in it.
    pub(crate) fn hash(&self, patch: Option<&Patch>) -> Result<u64> {
        let planted = patch.map(|patch| self.planted(patch)).transpose()?.unwrap_or_default();
        let mut hasher = DefaultHasher::new();
        for (path, bytes) in &self.original {
            (path, planted.get(path).unwrap_or(bytes)).hash(&mut hasher);
        }
        Ok(hasher.finish())
    }

    /// The text of a file.
    pub(crate) fn text(&self, path: &Path) -> Result<&str> {
        let bytes = self.original.get(path).ok_or_else(|| format!("{} is not there", path.display()))?;
        std::str::from_utf8(bytes).map_err(|e| format!("{}: {e}", path.display()))
    }

    /// The files that a fault changes, as it leaves them.
    pub(crate) fn planted(&self, patch: &Patch) -> Result<Files> {
        let one = |file: &FilePatch| {
            let path = PathBuf::from(&file.path);
            let text = file.apply(self.text(&path)?)?;
            Ok((path, text.into_bytes()))
        };
        patch.files.iter().map(one).collect()
    }
}

fn write(to: &Path, bytes: &[u8]) -> Result<()> {
    let folder = to.parent().unwrap_or(to);
    fs::create_dir_all(folder).and_then(|()| fs::write(to, bytes)).map_err(|e| format!("{}: {e}", to.display()))
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>> {
    let list = fs::read_dir(folder).and_then(|list| list.map(|entry| Ok(entry?.path())).collect());
    list.map_err(|e| format!("{}: {e}", folder.display()))
}

/// Reads a file, or a folder with all that is in it.
fn read(root: &Path, path: &Path, files: &mut Files) -> Result<()> {
    if path.is_dir() {
        return entries(path)?.iter().try_for_each(|entry| read(root, entry, files));
    }
    let name = path.strip_prefix(root).map_err(|e| e.to_string())?.to_owned();
    files.insert(name, fs::read(path).map_err(|e| format!("{}: {e}", path.display()))?);
    Ok(())
}
