//! A planted fault: a unified diff under a sentence that says what is wrong and which rows of the battery should notice.
//!
//! ```text
//! Radiance is not scaled where it is refracted.
//! Noticed by: A4 T6
//!
//! --- a/src/bsdf/smooth.rs
//! +++ b/src/bsdf/smooth.rs
//! @@ -54,7 +54,7 @@
//! …
//! ```
//!
//! `git apply` takes such a file too. Applied here it needs no git, and the lines of a hunk must stand in the file as
//! they stand in the patch, though not at the same place.

use std::fs;
use std::path::Path;

/// What went wrong, in words.
pub(crate) type Result<T> = std::result::Result<T, String>;

/// One fault.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    /// The file's name without `.patch`.
    pub(crate) name: String,
    /// What is wrong, a sentence.
    pub(crate) what: String,
    /// The rows that should notice.
    pub(crate) rows: Vec<String>,
    /// The files that it changes.
    pub(crate) files: Vec<FilePatch>,
}

/// The changes of one file.
#[derive(Clone, Debug)]
pub(crate) struct FilePatch {
    /// Path from the root of the tree, with `/`.
    pub(crate) path: String,
    hunks: Vec<Hunk>,
}

#[derive(Clone, Debug)]
struct Hunk {
    /// Line at which it should be, from 1.
    line: usize,
    /// Lines that are there.
    old: Vec<String>,
    /// Lines that come in their place.
    new: Vec<String>,
}

/// All `*.patch` of a folder, by name.
pub(crate) fn load(folder: &Path) -> Result<Vec<Patch>> {
    let entries = fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut patches = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| format!("{}: {e}", folder.display()))?.path();
        if path.extension().is_some_and(|e| e == "patch") {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
            patches.push(Patch::parse(&name, &text)?);
        }
    }
    patches.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(patches)
}

impl Patch {
    /// Reads a patch.
    pub(crate) fn parse(name: &str, text: &str) -> Result<Self> {
        let fail = |what: &str| format!("{name}.patch: {what}");
        let (head, diff) = text.split_once("\n--- a/").ok_or_else(|| fail("no line begins with `--- a/`"))?;
        let (what, rows) = head.split_once("\nNoticed by:").ok_or_else(|| fail("no line begins with `Noticed by:`"))?;
        let what = what.split_whitespace().collect::<Vec<_>>().join(" ");
        let rows: Vec<String> = rows.split_whitespace().map(str::to_owned).collect();
        if what.is_empty() || rows.is_empty() {
            return Err(fail("the header says what is wrong and which rows notice"));
        }
        let files = diff.split("\n--- a/").map(|file| FilePatch::parse(file).map_err(|e| fail(&e)));
        Ok(Self { name: name.to_owned(), what, rows, files: files.collect::<Result<_>>()? })
    }
}

impl FilePatch {
    /// Reads what follows `--- a/`.
    fn parse(text: &str) -> Result<Self> {
        let mut lines = text.lines().peekable();
        let path = lines.next().unwrap_or_default();
        if lines.next() != Some(&format!("+++ b/{path}")) || path.split('/').any(|part| part == ".." || part.is_empty())
        {
            return Err(format!("`{path}` is not followed by itself, or leads out of the tree"));
        }
        let mut hunks = Vec::new();
        while let Some(head) = lines.next() {
            let line = head.strip_prefix("@@ -").and_then(|rest| rest.split([',', ' ']).next()?.parse().ok());
            let line = line.ok_or_else(|| format!("`{head}` is no head of a hunk"))?;
            let (mut old, mut new) = (Vec::new(), Vec::new());
            while let Some(line) = lines.next_if(|line| !line.starts_with("@@")) {
                match line.split_at_checked(1) {
                    None => [&mut old, &mut new].into_iter().for_each(|side| side.push(String::new())),
                    Some((" ", line)) => [&mut old, &mut new].into_iter().for_each(|side| side.push(line.to_owned())),
                    Some(("-", line)) => old.push(line.to_owned()),
                    Some(("+", line)) => new.push(line.to_owned()),
                    _ => return Err(format!("`{line}` is no line of a hunk")),
                }
            }
            if old.is_empty() || old == new {
                return Err(format!("`{head}` changes nothing, or names nothing that is there"));
            }
            hunks.push(Hunk { line, old, new });
        }
        Ok(Self { path: path.to_owned(), hunks })
    }

    /// The file with the fault in it. Each hunk goes where its lines are, the nearest such place to where it was.
    pub(crate) fn apply(&self, text: &str) -> Result<String> {
        let mut lines: Vec<&str> = text.lines().collect();
        let mut drift = 0;
        for hunk in &self.hunks {
            let expected = (hunk.line.saturating_sub(1)).saturating_add_signed(drift);
            let here = |at: &usize| lines[*at..].iter().zip(&hunk.old).all(|(line, old)| line == old);
            let places = (0..(lines.len() + 1).saturating_sub(hunk.old.len())).filter(here);
            let Some(at) = places.min_by_key(|at| at.abs_diff(expected)) else {
                return Err(format!("{}: the lines at {} are no longer there", self.path, hunk.line));
            };
            lines.splice(at..at + hunk.old.len(), hunk.new.iter().map(String::as_str));
            drift += at as isize - expected as isize + hunk.new.len() as isize - hunk.old.len() as isize;
        }
        Ok(lines.join("\n") + "\n")
    }
}
