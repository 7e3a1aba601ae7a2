//! A few kilobytes of text cannot ask for more memory or time than a machine has.

use super::{folder, png};
use radianza::desc::toml::{parse, read};
use radianza::desc::{Error, ErrorKind};
use std::path::Path;

/// The error of a text.
fn error(text: &str) -> Error {
    let e = parse(text, Path::new("scene.toml")).expect_err("should be refused");
    assert_eq!(e.kind, ErrorKind::Invalid, "{e}");
    e
}

#[test]
fn instances_cannot_explode() {
    // 2^40 spheres in 41 groups.
    let mut text = String::from("[group.g0]\n[[group.g0.shape]]\ntype = 'sphere'\nemission = 1\n");
    for i in 1..=40 {
        text += &format!("[group.g{i}]\ninstance = [{{ group = 'g{0}' }}, {{ group = 'g{0}' }}]\n", i - 1);
    }
    let e = error(&text);
    assert!(e.message.contains("the instances would take more than 1024 MiB"), "{e}");
}

/// 2^17 places of 100 emitting triangles are as many lights.
#[test]
fn lamps_cannot_explode() {
    let triangles = "[0, 1, 2], ".repeat(100);
    let mut text = format!(
        "[group.g0]\n[[group.g0.shape]]\ntype = 'mesh'\nemission = 1\n\
         positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\nindices = [{triangles}]\n"
    );
    for i in 1..=17 {
        text += &format!("[group.g{i}]\ninstance = [{{ group = 'g{0}' }}, {{ group = 'g{0}' }}]\n", i - 1);
    }
    let e = error(&text);
    assert!(e.message.contains("the instances would take more than 1024 MiB"), "{e}");
    let dark = text.replace("emission = 1", "material = 'm'") + "[material.m]\ntype = 'absorb'\n";
    assert!(parse(&dark, Path::new("scene.toml")).is_ok());
}

#[test]
fn deep_nesting_is_refused() {
    let mut text = String::from("[group.g0]\n");
    for i in 1..=100 {
        text += &format!("[group.g{}]\ninstance = [{{ group = 'g{i}' }}]\n", i - 1);
    }
    // Tables may be given once; the first is empty.
    let text = text.replacen("[group.g0]\n", "", 1) + "[group.g100]\n";
    let e = error(&text);
    assert!(e.message.contains("nested more than 64 deep"), "{e}");
    let e = error(&format!("a = {}{}", "[".repeat(100_000), "]".repeat(100_000)));
    assert!(e.message.contains("is not TOML"), "{e}");
}

/// Each mixture has so many parts, all the mixture before it: `depth` levels are `parts` to this power models.
fn mixtures(parts: usize, depth: usize) -> String {
    let mut text = String::from("[material.m0]\ntype = 'absorb'\n");
    for i in 1..=depth {
        let part = format!("{{ material = 'm{}', weight = 0.03 }}", i - 1);
        text += &format!("[material.m{i}]\ntype = 'mix'\nparts = [{}]\n", vec![part; parts].join(", "));
    }
    text
}

#[test]
fn mixtures_cannot_explode() {
    assert!(parse(&mixtures(2, 8), Path::new("scene.toml")).is_ok());
    let bytes = "the mixtures would take more than 64 MiB";
    for (parts, depth, expected) in [(1, 40, "nested more than 16 deep"), (2, 40, bytes), (32, 8, bytes)] {
        let e = error(&mixtures(parts, depth));
        assert!(e.message.contains(expected), "{e}");
        let line: usize = e.place.split(':').next().unwrap().parse().unwrap();
        assert_eq!(line % 3, 2, "at a line of `parts`: {e}");
    }
}

/// The distance of two words takes the product of their lengths: 100,000 characters each would take 80 GB.
#[test]
fn long_names_have_no_neighbours() {
    let (a, b) = ("a".repeat(100_000), "b".repeat(100_000));
    let e = error(&format!("[material.{a}]\ntype = 'absorb'\n[[shape]]\ntype = 'sphere'\nmaterial = '{b}'"));
    assert_eq!(e.place, "5:12");
    let many: String = (0..1000).map(|i| format!("[material.m{i}]\ntype = 'absorb'\n")).collect();
    let e = error(&format!("{many}[[shape]]\ntype = 'sphere'\nmaterial = 'another'"));
    assert!(e.message.contains("there are 1000, none of a similar name"), "{e}");
}

#[test]
fn a_file_is_decoded_once_whatever_it_is_called() {
    let files = folder(&[("t.png", &png()), ("t.ply", PLY.as_bytes())]);
    std::fs::create_dir(files.path().join("sub")).unwrap();
    let mut text = String::new();
    for i in 0..20 {
        let dots = "./".repeat(i);
        text += &format!("[texture.t{i}]\nfile = '{dots}t.png'\n[texture.u{i}]\nfile = 'sub/../{dots}t.png'\n");
        text += &format!("[[shape]]\ntype = 'file'\nfile = '{dots}t.ply'\n");
    }
    let path = files.path().join("scene.toml");
    std::fs::write(&path, text).unwrap();
    let scene = read(&path).unwrap();
    assert_eq!((scene.images.len(), scene.textures.len()), (1, 40));
    assert_eq!((scene.shapes.len(), scene.objects.len()), (1, 20));
}

/// One triangle.
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// Names are looked up, not searched for one by one.
#[test]
fn many_names_are_found_in_no_time() {
    const MANY: usize = 20_000;
    let name = |i: usize| format!("m{}{i:06}", "x".repeat(40));
    let materials: String = (0..MANY).map(|i| format!("[material.{}]\ntype = 'absorb'\n", name(i))).collect();
    let last = name(MANY - 1);
    let shapes: String = (0..MANY).map(|_| format!("[[shape]]\ntype = 'disk'\nmaterial = '{last}'\n")).collect();
    let scene = parse(&(materials + &shapes), Path::new("scene.toml")).unwrap();
    assert!(scene.objects.iter().all(|o| o.material == MANY - 1));
}
