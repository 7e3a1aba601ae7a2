//! The architecture as a test: a module uses only modules of its own layer or below, and no file grows without end.

use std::fs;
use std::path::{Path, PathBuf};

/// Module → layer. The table of `lib.rs`, with the command line of the binary on top.
const LAYERS: &[(&str, u32)] = &[
    ("math", 0),
    ("spectrum", 1),
    ("sampler", 1),
    ("warp", 1),
    ("stats", 1),
    ("bsdf", 2),
    ("medium", 2),
    ("texture", 2),
    ("shape", 2),
    ("desc", 2),
    ("film", 2),
    ("material", 3),
    ("bvh", 3),
    ("light", 3),
    ("camera", 3),
    ("scene", 4),
    ("integrator", 5),
    ("render", 6),
    ("verify", 7),
    ("cli", 8),
];

/// Most lines of a source file.
const MAX_LINES: usize = 400;

fn layer(module: &str) -> Option<u32> {
    LAYERS.iter().find(|(name, _)| *name == module).map(|(_, layer)| *layer)
}

/// What is wrong with one file: `modules` is its path from the crate's root, `["film", "exr"]` for `src/film/exr.rs`.
fn faults(modules: &[&str], source: &str) -> Vec<String> {
    let mut faults = Vec::new();
    let lines = source.lines().count();
    if lines > MAX_LINES {
        faults.push(format!("has {lines} lines, more than {MAX_LINES}"));
    }
    // lib.rs and main.rs stand above all layers.
    let Some(module) = modules.first() else { return faults };
    let Some(own) = layer(module) else {
        faults.push(format!("module `{module}` is not in the table of tests/layers.rs"));
        return faults;
    };
    for (line, used) in uses(modules.len(), source) {
        match layer(&used.name) {
            Some(other) if other > own => {
                faults.push(format!("line {line}: `{module}` (layer {own}) uses `{}` (layer {other})", used.name));
            }
            None if used.absolute => faults.push(format!("line {line}: `crate::{}` is not in the table", used.name)),
            _ => {}
        }
    }
    faults
}

/// A name that code takes from the crate's root.
#[derive(Debug, PartialEq)]
struct Used {
    name: String,
    /// Reached by `crate::`, not by climbing, where inline modules make the root uncertain.
    absolute: bool,
}

/// Names behind `crate::` and behind as many `super::` as lead out of a file `depth` modules deep, with their lines.
fn uses(depth: usize, source: &str) -> Vec<(usize, Used)> {
    let code: Vec<&str> = source.lines().map(|line| line.split("//").next().unwrap_or("")).collect();
    let text = code.join("\n");
    let line = |at: usize| text[..at].matches('\n').count() + 1;
    let starts_word = |at: usize| !text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '$');
    let mut found = Vec::new();
    for (at, root) in text.match_indices("crate::").filter(|(at, _)| starts_word(*at)) {
        let names = names(&text[at + root.len()..]);
        found.extend(names.into_iter().map(|name| (line(at), Used { name, absolute: true })));
    }
    for (at, _) in text.match_indices("super::").filter(|(at, _)| starts_word(*at)) {
        // Only from the first of a chain.
        if text[..at].ends_with("::") {
            continue;
        }
        let rest = text[at..].trim_start_matches("super::");
        let climbed = (text.len() - at - rest.len()) / "super::".len();
        if climbed >= depth {
            let names = names(rest);
            found.extend(names.into_iter().map(|name| (line(at), Used { name, absolute: false })));
        }
    }
    found
}

/// First segments of the path or of the paths in braces at the start of `text`; macros and items of the root are none.
fn names(text: &str) -> Vec<String> {
    let ident = |text: &str| -> String {
        let path = text.trim_start();
        path.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    };
    let Some(group) = text.trim_start().strip_prefix('{') else { return vec![ident(text)] };
    let (mut depth, mut start, mut names) = (0, 0, Vec::new());
    for (i, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth > 0 => depth -= 1,
            ',' | '}' if depth == 0 => {
                names.push(ident(&group[start..i]));
                start = i + 1;
                if c == '}' {
                    break;
                }
            }
            _ => {}
        }
    }
    names.retain(|name| !name.is_empty());
    names
}

fn rust_files(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            rust_files(&path, out);
        } else if path.extension().is_some_and(|e| e == "rs") {
            out.push(path);
        }
    }
}

/// `film/exr.rs` → `film`, `exr`; `film/mod.rs` → `film`; `lib.rs` → nothing.
fn module_path(relative: &Path) -> Vec<String> {
    let parts = relative.with_extension("");
    let parts = parts.iter().map(|part| part.to_string_lossy().into_owned());
    parts.filter(|part| !matches!(part.as_str(), "mod" | "lib" | "main")).collect()
}

#[test]
fn modules_use_only_lower_layers() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    rust_files(&src, &mut files);
    files.sort();
    assert!(files.len() > 10, "only {} files found", files.len());
    let mut all = Vec::new();
    for file in files {
        let relative = file.strip_prefix(&src).unwrap();
        let modules = module_path(relative);
        let modules: Vec<&str> = modules.iter().map(String::as_str).collect();
        let source = fs::read_to_string(&file).unwrap();
        all.extend(faults(&modules, &source).into_iter().map(|fault| format!("src/{}: {fault}", relative.display())));
    }
    assert!(all.is_empty(), "\n{}", all.join("\n"));
}

#[test]
fn the_map_in_lib_rs_is_the_table() {
    let lib = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs")).unwrap();
    let rows: Vec<(String, u32)> = lib
        .lines()
        .filter_map(|line| {
            let mut cells = line.strip_prefix("//! |")?.split('|').map(str::trim);
            let layer = cells.next()?.parse().ok()?;
            Some((cells.next()?.trim_matches(['[', ']', '`']).to_string(), layer))
        })
        .collect();
    assert!(rows.len() > 10, "{rows:?}");
    for (module, map) in &rows {
        assert_eq!(layer(module), Some(*map), "`{module}` in the map of lib.rs and in tests/layers.rs");
    }
    for module in lib.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')) {
        assert!(rows.iter().any(|(row, _)| row == module), "`{module}` is missing in the map of lib.rs");
    }
}

#[test]
fn an_upward_use_is_found() {
    let upward = |source: &str| faults(&["bsdf", "ggx"], source);
    assert_eq!(upward("use crate::scene::Scene;").len(), 1);
    assert_eq!(upward("use crate::{math::Frame, integrator, light::{A, B}};").len(), 2);
    assert_eq!(upward("use crate::{\n    math::{Frame, Ray},\n    render,\n};").len(), 1);
    assert_eq!(upward("fn f() { crate::camera::g(); }").len(), 1);
    assert_eq!(upward("use super::super::scene::Scene;").len(), 1);
    assert_eq!(upward("\nuse crate::bvh::Bvh;"), ["line 2: `bsdf` (layer 2) uses `bvh` (layer 3)"]);
    assert_eq!(upward("use crate::unheard::Of;").len(), 1);
    assert_eq!(faults(&["unheard"], "").len(), 1);
    assert_eq!(upward(&"\n".repeat(MAX_LINES + 1)).len(), 1);
}

#[test]
fn a_downward_use_is_free() {
    let fine = |source: &str| assert_eq!(faults(&["bsdf", "ggx"], source), Vec::<String>::new(), "{source}");
    fine("use crate::math::Frame; use crate::{desc, spectrum::Spectrum, warp};");
    fine("use super::Sample; use super::super::shape;");
    fine("/// See [`crate::scene::Scene`].\npub(crate) fn f() {} // crate::render");
    fine("mod tests { use super::super::normal_cdf; use super::*; }");
    assert!(faults(&[], "use crate::render; pub mod scene;").is_empty());
}
