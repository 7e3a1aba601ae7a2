//! The planted faults of `reference/faults/`: each patch still applies to the tree, and the written matrix knows it.
//! What they do to the battery is seen by `cargo run --release --example faults`.

#[path = "../../examples/faults/patch.rs"]
mod patch;
#[path = "../../examples/faults/schemata.rs"]
mod schemata;

use patch::{Patch, load};
use radianza::verify::battery;
use schemata::{RECORD, SWITCH, changes, combine};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

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

/// A program of its own, with what the faults below change.
const PROGRAM: &str = "\
const TWO: f32 = 2.0;

trait Shape {
    fn side(&self) -> f32;

    /// Of what is as high as it is wide.
    fn area(&self) -> f32 {
        self.side() * self.side() // π is not in it
    }
}

struct Square(f32);

impl Shape for Square {
    fn side(&self) -> f32 {
        self.0
    }
}

mod inner {
    pub(crate) fn twice(x: f32) -> f32 {
        fn double(x: f32) -> f32 {
            crate::TWO * x
        }
        let sum = |x: f32| double(x);
        sum(x)
    }

    pub(crate) const fn three() -> u32 {
        3
    }

    pub(crate) fn some() -> Option<impl Fn() -> u32> {
        Some(|| three())
    }
}

fn idle() -> u32 {
    5
}

fn main() {
    if std::env::args().count() > 1 {
        idle();
    }
    println!(\"{} {} {}\", Square(3.0).area(), inner::twice(1.0), inner::some().map_or(0, |f| f()));
}
";

#[test]
fn faults_in_bodies_are_chosen_while_the_program_runs() {
    // Two in one function, one in another's inner function, one in the method of a trait's implementation and elsewhere.
    let faults = [
        (1, vec![("self.side() * self.side()", "self.side()")]),
        (2, vec![("self.side() * self.side() // π is not in it", "{ let s = self.side(); s + s }")]),
        (3, vec![("crate::TWO * x", "10.0 * x")]),
        (7, vec![("self.0\n", "self.0 + 1.0\n"), ("sum(x)", "sum(x) + 1.0")]),
        (8, vec![("    5\n", "    6\n")]),
    ];
    let faults = faults.map(|(number, edits)| {
        let planted = edits.iter().fold(PROGRAM.to_owned(), |text, (old, new)| text.replacen(old, new, 1));
        (number, changes(PROGRAM, &planted).unwrap().expect("bodies alone"))
    });
    let (text, places) = combine(PROGRAM, &faults).unwrap();
    let body = |number| places.iter().filter(|(n, _)| *n == number).map(|(_, range)| &text[range.clone()]).next_back();
    assert_eq!(body(7).unwrap().lines().nth(5), Some("        sum(x) + 1.0"));

    let folder = tempfile::tempdir().unwrap();
    let (source, program) = (folder.path().join("main.rs"), folder.path().join("program"));
    fs::write(&source, text + SWITCH).unwrap();
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let built = Command::new(rustc).args(["--edition", "2024", "-o"]).arg(&program).arg(&source).output().unwrap();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let record = folder.path().join("reached");
    let prints = |number: &str| {
        let mut command = Command::new(&program);
        let output = command.env("RADIANZA_FAULT", number).env("RADIANZA_REACHED", &record).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    let numbers = ["", "0", "1", "2", "3", "7", "8"];
    assert_eq!(
        numbers.map(prints).map(|s| s.trim().to_owned()),
        ["9 2 3", "9 2 3", "3 2 3", "6 2 3", "9 10 3", "16 3 3", "9 2 3"]
    );

    // The faults whose functions run, each once.
    assert!(!record.exists());
    assert_eq!(prints(&RECORD.to_string()).trim(), "9 2 3");
    let reached = fs::read_to_string(&record).unwrap();
    assert_eq!(reached.lines().collect::<BTreeSet<_>>(), BTreeSet::from(["1", "2", "3", "7"]));
    assert_eq!(reached.lines().count(), 4);
}

#[test]
fn what_is_no_body_is_built_alone() {
    for (old, new) in [
        ("TWO: f32 = 2.0", "TWO: f32 = 3.0"),
        ("struct Square(f32)", "struct Square(pub f32)"),
        ("fn side(&self) -> f32;", "fn side(&self) -> f32 {\n        1.0\n    }"),
        ("fn side(&self) -> f32 {", "fn side(self: &Self) -> f32 {"),
        ("fn main()", "#[inline]\nfn main()"),
        ("fn main()", "fn more() {}\n\nfn main()"),
        ("        3\n", "        4\n"),
        ("Some(|| three())", "Some(|| 4)"),
    ] {
        let planted = PROGRAM.replacen(old, new, 1);
        assert_ne!(planted, PROGRAM, "{old}");
        assert_eq!(changes(PROGRAM, &planted), Ok(None), "{new}");
    }
    assert!(changes(PROGRAM, "fn main() {").is_err());
    assert_eq!(changes(PROGRAM, PROGRAM), Ok(Some(Vec::new())));
    assert_eq!(combine(PROGRAM, &[]).unwrap(), (PROGRAM.to_owned(), Vec::new()));
}
