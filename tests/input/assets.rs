//! Files made by others, through to an image: each one loads, compiles and renders without a sample that is no radiance,
//! or is refused for what it requires. They are named by the environment variable RADIANZA_ASSETS.

use crate::common::{film, settings};
use radianza::desc::{self, ErrorKind};
use radianza::render::Settings;
use radianza::scene::Scene;
use std::path::{Path, PathBuf};

fn scenes_below(folder: &Path, found: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            scenes_below(&path, found);
        } else if path.extension().is_some_and(|e| ["glb", "gltf", "obj"].iter().any(|k| e == *k)) {
            found.push(path);
        }
    }
}

#[test]
fn files_of_others_render_or_are_refused_by_name() {
    let Some(folder) = std::env::var_os("RADIANZA_ASSETS").map(PathBuf::from) else {
        return crate::skip::skip("RADIANZA_ASSETS names no folder of files to try");
    };
    let mut found = Vec::new();
    scenes_below(&folder, &mut found);
    found.sort();
    assert!(!found.is_empty(), "{}: no scenes", folder.display());
    for path in found {
        let desc = match desc::load(&path) {
            Ok(desc) => desc,
            Err(error) => {
                assert_eq!(error.kind, ErrorKind::Unsupported, "{error}");
                println!("{error}");
                continue;
            }
        };
        let scene = Scene::compile(&desc).unwrap_or_else(|e| panic!("{e}"));
        let film = film(&scene, &Settings { spp: 4, replicate: 1, ..settings([32, 24]) });
        let [mean, ..] =
            film.pixels().map(|[x, y]| film.mean(x, y)).fold([0.0; 3], |a, b| [0, 1, 2].map(|c| a[c] + b[c]));
        assert!(mean > 0.0, "{} is black", path.display());
        println!("{}: mean {:.4}", path.display(), mean / (32.0 * 24.0));
    }
}
