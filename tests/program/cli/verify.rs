//! `radianza verify` from outside: exit codes, choice of checks, files.

use super::{folder, radianza, triangle};
use quick_xml::Reader;
use quick_xml::events::Event;
use radianza::verify::report::json::Document;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

/// A row that takes milliseconds.
const CHEAP: &str = "L1/point";

fn read(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).unwrap()
}

/// How often each element occurs; fails where the text is not well-formed.
fn elements(xml: &str, name: &str) -> usize {
    let mut reader = Reader::from_str(xml);
    let mut n = 0;
    loop {
        match reader.read_event().unwrap() {
            Event::Start(e) | Event::Empty(e) => n += usize::from(e.name().as_ref() == name),
            Event::Eof => return n,
            _ => {}
        }
    }
}

#[test]
fn names_are_listed_a_line_each() {
    let folder = folder();
    let (code, out, err) = radianza(folder.path(), &["verify", "--list"]);
    assert_eq!((code, err.as_str()), (0, ""));
    assert!(out.lines().count() > 20 && out.lines().all(|line| line.contains('/')), "{out}");
    let (_, some, _) = radianza(folder.path(), &["verify", "--list", "--only", "l1/POINT", "--only", "f2"]);
    let expected = out.lines().filter(|line| line.contains("L1/point") || line.to_lowercase().contains("f2"));
    assert_eq!(some.lines().collect::<Vec<_>>(), expected.collect::<Vec<_>>());
    let (_, verbose, _) = radianza(folder.path(), &["verify", "--list", "--only", CHEAP, "-v"]);
    assert!(verbose.starts_with("# L1: "), "{verbose}");
}

#[test]
fn wrong_usage_is_2() {
    let folder = folder();
    for wrong in [
        &["--alpha", "0"][..],
        &["--alpha", "1"],
        &["--alpha", "often"],
        &["--seed", "-1"],
        &["--threads", "many"],
        &["--only"],
        &["-v", "-q"],
        &["--json", "-", "--junit", "-"],
        &["--json", "same", "--html", "same"],
        &["a.toml", "b.toml"],
    ] {
        let (code, out, err) = radianza(folder.path(), &[&["verify"], wrong].concat());
        assert_eq!((code, out.as_str()), (2, ""), "{wrong:?}\n{err}");
    }
    // What fits nothing is answered with what is near.
    let (code, _, err) = radianza(folder.path(), &["verify", "--only", CHEAP, "--only", "L1/pont"]);
    assert_eq!(code, 2);
    assert!(err.contains("L1/pont: nothing") && err.contains("near are `L1/"), "{err}");
}

#[test]
fn a_row_passes_and_is_written_in_every_form() {
    let folder = folder();
    let files = ["--json", "new/a.json", "--junit", "a.xml", "--html", "a.html"];
    let (code, out, err) = radianza(folder.path(), &[&["verify", "--only", CHEAP, "--seed", "5"], &files[..]].concat());
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("\nL1  ") && out.contains("PASSED") && out.contains("seed 5"), "{out}");
    assert!(out.lines().all(|line| line.chars().count() <= 100) && !out.contains('\u{1b}'), "{out}");

    let document: Document = serde_json::from_str(&read(folder.path(), "new/a.json")).unwrap();
    assert!(document.passes && document.failures == 0 && document.checks > 0 && document.seed == 5);
    assert_eq!(document.sections.iter().map(|section| section.checks.len()).sum::<usize>(), document.checks);
    assert!(document.command.contains("--seed 5") && document.command.contains("--only 'L1/point'"));

    let xml = read(folder.path(), "a.xml");
    assert_eq!([elements(&xml, "testcase"), elements(&xml, "failure")], [document.checks, 0]);
    let page = read(folder.path(), "a.html");
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>"), "{page}");

    // To stdout, it is all that is there; and another seed draws other numbers.
    let (_, out, _) = radianza(folder.path(), &["verify", "--only", CHEAP, "--json", "-", "--threads", "1"]);
    let other: Document = serde_json::from_str(&out).unwrap();
    assert_eq!((other.checks, other.seed), (document.checks, 0));

    // Quiet: nothing but the verdict.
    let (code, out, err) = radianza(folder.path(), &["verify", "--only", CHEAP, "-q"]);
    assert_eq!((code, err.as_str()), (0, ""));
    assert!(!out.contains("L1") && out.contains("PASSED"), "{out}");
}

#[test]
fn findings_do_not_depend_on_threads() {
    let folder = folder();
    let found = |threads: &str| {
        let (_, out, _) = radianza(folder.path(), &["verify", "--only", CHEAP, "--json", "-", "--threads", threads]);
        let document: Document = serde_json::from_str(&out).unwrap();
        document.sections.into_iter().map(|section| serde_json::to_string(&section.checks).unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(found("1"), found("3"));
}

#[test]
fn a_check_that_fails_is_1() {
    // With a significance of all but 1, a check passes only if its p is about as large: chance sees to it that some fail.
    let folder = folder();
    let arguments = ["verify", "--only", "L5", "--alpha", "0.9999999999999999", "--junit", "a.xml", "--html", "a.html"];
    let (code, out, err) = radianza(folder.path(), &arguments);
    assert_eq!(code, 1, "{out}");
    assert!(out.contains("FAILED: ") && out.contains("failures:") && err.contains("checks fail"), "{out}{err}");
    assert!(elements(&read(folder.path(), "a.xml"), "failure") > 0);
    assert!(read(folder.path(), "a.html").contains("id=\"failures\""));
}

#[test]
fn an_output_that_cannot_be_written_is_known_before() {
    let folder = folder();
    std::fs::create_dir(folder.path().join("folder.html")).unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    for output in [["--html", "folder.html"], ["--json", "file/a.json"], ["--junit", "/proc/a.xml"]] {
        let (code, out, err) = radianza(folder.path(), &["verify", "--thorough", output[0], output[1]]);
        assert_eq!((code, out.as_str()), (6, ""), "{err}");
        assert!(err.contains(output[1]), "{err}");
    }
}

#[test]
fn a_scene_is_checked_in_place_of_the_program() {
    let folder = folder();
    triangle(folder.path(), "tri.gltf", "");
    std::fs::write(folder.path().join("bad.toml"), "[camera").unwrap();
    let (code, list, _) = radianza(folder.path(), &["verify", "tri.gltf", "--list"]);
    assert_eq!(code, 0);
    assert!(list.contains("data/") && !list.contains("L1/"), "{list}");
    let quick = ["verify", "tri.gltf", "--only", "data/", "--html", "a.html", "--quick"];
    let (code, out, err) = radianza(folder.path(), &quick);
    assert_eq!(code, 0, "{out}{err}");
    assert!(out.contains("PASSED; size quick") && read(folder.path(), "a.html").contains("tri.gltf"), "{out}");
    assert_eq!(radianza(folder.path(), &["verify", "tri.gltf", "--quick", "--thorough"]).0, 2);
    assert_eq!(radianza(folder.path(), &["verify", "none.glb"]).0, 4);
    assert_eq!(radianza(folder.path(), &["verify", "bad.toml"]).0, 3);
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_without_output() {
    let folder = folder();
    let mut child = Command::new(assert_cmd::cargo::cargo_bin("radianza"))
        .current_dir(folder.path())
        .args(["verify", "--thorough", "--threads", "1", "--json", "a.json"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap);
    assert!(lines.any(|line| line.contains("left: ")), "progress");
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let rest: Vec<String> = lines.collect();
    assert_eq!(child.wait().unwrap().code(), Some(130), "{rest:?}");
    assert!(rest.iter().any(|line| line.contains("interrupted; nothing was written")), "{rest:?}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
