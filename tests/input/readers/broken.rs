//! Whatever a file contains, a reader returns: a scene or an error.

use super::{EVERYTHING, models::PLY};
use proptest::prelude::*;
use radianza::desc::{obj, ply, toml};
use std::path::Path;

const OBJ: &str = "o a\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0.5\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/1 4\nf -1 -2 -3\nusemtl x\nf 1//1 2//1 3//1\ns off\nl 1 2\n";

/// Texts that may stand where a value was.
const HOSTILE: [&str; 16] = [
    "nan",
    "inf",
    "-1",
    "0",
    "1e300",
    "99999999999999999999",
    "[]",
    "{}",
    "\"\"",
    "[[]]",
    "true",
    "1979-05-27",
    "\"x\"",
    "[nan, nan, nan]",
    "-0.0",
    "4294967295",
];

/// One change to a text: bytes overwritten, lines dropped, doubled, swapped, a value replaced, the end cut off.
fn mutate(text: &mut Vec<u8>, (kind, a, b): (u8, usize, u8)) {
    let mut lines: Vec<Vec<u8>> = text.split(|c| *c == b'\n').map(<[u8]>::to_vec).collect();
    let n = lines.len();
    match kind % 7 {
        0 if !text.is_empty() => {
            let i = a % text.len();
            text[i] = b;
            return;
        }
        1 => {
            text.truncate(a % (text.len() + 1));
            return;
        }
        2 => drop(lines.remove(a % n)),
        3 => lines.insert(a % n, lines[b as usize % n].clone()),
        4 => lines.swap(a % n, b as usize % n),
        5 => {
            let line = &mut lines[a % n];
            if let Some(i) = line.iter().position(|c| *c == b'=') {
                line.truncate(i + 1);
                line.extend(HOSTILE[b as usize % HOSTILE.len()].bytes());
            }
        }
        _ => {
            let line = &mut lines[a % n];
            let numbers: Vec<_> = (0..line.len()).filter(|i| line[*i].is_ascii_digit()).collect();
            if let Some(i) = numbers.get(b as usize % numbers.len().max(1)) {
                line.splice(i..=i, HOSTILE[a % HOSTILE.len()].bytes());
            }
        }
    }
    *text = lines.join(&b'\n');
}

/// A text after a few changes.
fn broken(text: &'static str) -> impl proptest::strategy::Strategy<Value = Vec<u8>> {
    prop::collection::vec(any::<(u8, usize, u8)>(), 1..6).prop_map(move |changes| {
        let mut text = text.as_bytes().to_vec();
        changes.into_iter().for_each(|change| mutate(&mut text, change));
        text
    })
}

/// What a reader that accepts a file promises of it.
fn check(scene: &radianza::desc::Scene) {
    for object in &scene.objects {
        assert!(object.shape < scene.shapes.len() && object.material < scene.materials.len());
        assert!(object.to_world.is_finite());
    }
    for shape in &scene.shapes {
        if let radianza::desc::Shape::Mesh(m) = shape {
            assert!(m.positions.iter().all(|p| p.is_finite()) && !m.indices.is_empty());
            assert!(m.indices.iter().flatten().all(|i| (*i as usize) < m.positions.len()));
            assert!(m.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-5));
        }
    }
    for camera in &scene.cameras {
        assert!(camera.to_world.is_finite());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn toml_texts(bytes in broken(EVERYTHING)) {
        let text = String::from_utf8_lossy(&bytes);
        match toml::parse(&text, Path::new("scene.toml")) {
            Ok(scene) => check(&scene),
            Err(e) => {
                let (line, column) = e.place.split_once(':').expect("line:column");
                let (line, column): (usize, usize) = (line.parse().unwrap(), column.parse().unwrap());
                prop_assert!((1..=text.matches('\n').count() + 1).contains(&line) && column >= 1, "{}", e);
                prop_assert!(!e.message.is_empty());
            }
        }
    }

    #[test]
    fn obj_texts(bytes in broken(OBJ)) {
        if let Ok(scene) = obj::parse(&String::from_utf8_lossy(&bytes), Path::new("a.obj")) {
            check(&scene);
        }
    }

    #[test]
    fn ply_texts(bytes in broken(PLY)) {
        if let Ok(scene) = ply::parse(&bytes, Path::new("a.ply")) {
            check(&scene);
        }
    }
}

/// `cargo test --test input -- --ignored seeds`.
#[test]
#[ignore = "writes tests/fuzz/corpus"]
fn seeds_of_the_fuzzer() {
    for (target, name, text) in [("toml", "everything.toml", EVERYTHING), ("obj", "a.obj", OBJ), ("ply", "a.ply", PLY)]
    {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus").join(target);
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join(name), text).unwrap();
    }
}
