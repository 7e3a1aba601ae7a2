//! The copy of the tree in which faults are planted.

use crate::patch::{Patch, Result};
use std::collections::BTreeMap;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

/// Top-level entries that no program is built from.
const LEFT_OUT: [&str; 6] = ["target", "out", "reference", "examples", "tests", "README.md"];

/// Files by their path from the root.
type Files = BTreeMap<PathBuf, Vec<u8>>;

/// The original, in memory, and where its copy stands. A file of the copy is written only where it differs, so that
/// cargo builds no more than what a fault changes.
pub(crate) struct Tree {
    original: Files,
    /// Where the copy stands.
    pub(crate) copy: PathBuf,
}

impl Tree {
    /// Copies `root` to `copy`, and takes away what is only there.
    pub(crate) fn new(root: &Path, copy: PathBuf) -> Result<Self> {
        let mut original = Files::new();
        for entry in entries(root)? {
            let name = entry.file_name().unwrap_or_default().to_string_lossy();
            if !name.starts_with('.') && !LEFT_OUT.contains(&&*name) {
                read(root, &entry, &mut original)?;
            }
        }
        let tree = Self { original, copy };
        let mut old = Files::new();
        if tree.copy.exists() {
            read(&tree.copy, &tree.copy, &mut old)?;
        }
        for path in old.keys().filter(|path| !tree.original.contains_key(*path)) {
            fs::remove_file(tree.copy.join(path)).map_err(|e| format!("{}: {e}", path.display()))?;
        }
        tree.restore()?;
        Ok(tree)
    }

    /// Makes the copy equal to the original.
    pub(crate) fn restore(&self) -> Result<()> {
        self.original.iter().try_for_each(|(path, bytes)| self.write(path, bytes))
    }

    /// Plants a fault in the copy.
    pub(crate) fn plant(&self, patch: &Patch) -> Result<()> {
        self.planted(patch)?.iter().try_for_each(|(path, bytes)| self.write(path, bytes))
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

    /// The files that a fault changes, as it leaves them.
    fn planted(&self, patch: &Patch) -> Result<Files> {
        let one = |file: &crate::patch::FilePatch| {
            let path = PathBuf::from(&file.path);
            let bytes = self.original.get(&path).ok_or_else(|| format!("{} is not there", file.path))?;
            let text = std::str::from_utf8(bytes).map_err(|e| format!("{}: {e}", file.path))?;
            Ok((path, file.apply(text)?.into_bytes()))
        };
        patch.files.iter().map(one).collect()
    }

    fn write(&self, path: &Path, bytes: &[u8]) -> Result<()> {
        let to = self.copy.join(path);
        if fs::read(&to).is_ok_and(|old| old == bytes) {
            return Ok(());
        }
        let folder = to.parent().unwrap_or(&self.copy);
        fs::create_dir_all(folder).and_then(|()| fs::write(&to, bytes)).map_err(|e| format!("{}: {e}", to.display()))
    }
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
