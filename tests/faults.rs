//! The planted faults of `reference/faults/`: each patch still applies to the tree, and the written matrix knows it.
//! What they do to the battery is seen by `cargo run --release --example faults`.

#[path = "../examples/faults/patch.rs"]
mod patch;

use patch::{Patch, load};
use radianza::verify::battery;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn patches() -> Vec<Patch> {
    load(&root().join("reference/faults")).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn every_patch_applies_and_changes_the_code() {
    let patches = patches();
    assert!(patches.len() >= 17, "the list of the specification alone is longer: {}", patches.len());
    for patch in patches {
        assert!(patch.what.ends_with('.'), "{}: the header is a sentence", patch.name);
        for file in &patch.files {
            assert!(file.path.starts_with("src/"), "{}: {} is no code", patch.name, file.path);
            let text = fs::read_to_string(root().join(&file.path)).unwrap();
            let planted = file.apply(&text).unwrap_or_else(|e| panic!("{}: {e}", patch.name));
            assert_ne!(planted, text, "{}", patch.name);
        }
    }
}

#[test]
fn every_row_is_named_by_a_patch_and_every_named_row_is_there() {
    let rows: BTreeSet<String> = battery::tasks().iter().map(|task| task.topic.id.to_owned()).collect();
    let named: BTreeSet<String> = patches().into_iter().flat_map(|patch| patch.rows).collect();
    assert_eq!(
        named, rows,
        "a row that is shown to notice no fault, or a fault that is promised to a row that is none"
    );
}

#[test]
fn the_matrix_names_every_patch_and_no_other() {
    let text = fs::read_to_string(root().join("reference/faults.md")).unwrap();
    let named = |line: &str| line.strip_prefix("| `")?.split_once('`').map(|(name, _)| name.to_owned());
    let written: BTreeSet<String> = text.lines().filter_map(named).collect();
    let planted: BTreeSet<String> = patches().into_iter().map(|patch| patch.name).collect();
    assert_eq!(written, planted, "cargo run --release --example faults -- --write");
}

const PATCH: &str = "\
Two is
three.
Noticed by: A1 B2

--- a/src/x.rs
+++ b/src/x.rs
@@ -2,3 +2,3 @@
 one
-two
+three

--- a/src/y.rs
+++ b/src/y.rs
@@ -1,1 +1,2 @@
+zero
 one
@@ -9,2 +10,1 @@
 nine
-ten
";

#[test]
fn patches_are_read() {
    let patch = Patch::parse("name", PATCH).unwrap();
    assert_eq!((patch.what.as_str(), patch.rows.join(" ").as_str()), ("Two is three.", "A1 B2"));
    let paths: Vec<&str> = patch.files.iter().map(|file| file.path.as_str()).collect();
    assert_eq!(paths, ["src/x.rs", "src/y.rs"]);
    for (wrong, why) in [
        ("no diff\nNoticed by: A1\n", "--- a/"),
        ("no rows\n\n--- a/src/x.rs\n+++ b/src/x.rs\n@@ -1 +1 @@\n-a\n+b\n", "Noticed by"),
        ("nobody\nNoticed by:\n\n--- a/src/x.rs\n+++ b/src/x.rs\n@@ -1 +1 @@\n-a\n+b\n", "which rows"),
        ("out\nNoticed by: A1\n\n--- a/../x.rs\n+++ b/../x.rs\n@@ -1 +1 @@\n-a\n+b\n", "leads out"),
        ("other\nNoticed by: A1\n\n--- a/src/x.rs\n+++ b/src/y.rs\n@@ -1 +1 @@\n-a\n+b\n", "not followed"),
        ("idle\nNoticed by: A1\n\n--- a/src/x.rs\n+++ b/src/x.rs\n@@ -1 +1 @@\n a\n", "changes nothing"),
        ("what\nNoticed by: A1\n\n--- a/src/x.rs\n+++ b/src/x.rs\n@@ -1 +1 @@\n?a\n", "no line of a hunk"),
    ] {
        assert!(Patch::parse("name", wrong).is_err_and(|e| e.contains(why)), "{wrong}");
    }
}

#[test]
fn hunks_go_where_their_lines_are() {
    let patch = Patch::parse("name", PATCH).unwrap();
    let [x, y] = [0, 1].map(|i| &patch.files[i]);
    // As it was, moved, and the nearest of two places.
    assert_eq!(x.apply("zero\none\ntwo\n\n").unwrap(), "zero\none\nthree\n\n");
    assert_eq!(x.apply("\n\n\n\none\ntwo\n\n").unwrap(), "\n\n\n\none\nthree\n\n");
    assert_eq!(x.apply("one\ntwo\n\n\n\none\ntwo\n\n").unwrap(), "one\nthree\n\n\n\none\ntwo\n\n");
    assert_eq!(y.apply("one\n2\n3\n4\n5\n6\n7\n8\nnine\nten\n").unwrap(), "zero\none\n2\n3\n4\n5\n6\n7\n8\nnine\n");
    // Lines that have changed, or are gone.
    for gone in ["one\nTwo\n\n", "", "one\n", "two\n"] {
        assert!(x.apply(gone).is_err_and(|e| e.contains("no longer there")), "{gone}");
    }
}
