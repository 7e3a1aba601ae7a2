//! The TOML format: what it says, and what it says of mistakes.

use radianza::desc::toml::{parse, schema};
use radianza::desc::{ErrorKind, Scene};
use std::path::Path;

/// The scene that a text describes.
fn scene(text: &str) -> Scene {
    parse(text, Path::new("scene.toml")).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Place and message of a text's error.
fn error(text: &str) -> (String, String) {
    match parse(text, Path::new("scene.toml")) {
        Ok(_) => panic!("should be refused:\n{text}"),
        Err(e) => {
            assert_eq!(e.file, Path::new("scene.toml"));
            assert!(matches!(e.kind, ErrorKind::Invalid | ErrorKind::Missing), "{e:?}");
            (e.place, e.message)
        }
    }
}

#[test]
fn errors_name_place_and_nearest() {
    for text in [
        "naem = 'x'",
        "[camera]\npositon = [1,2,3]\n",
        "[camera]\nposition = [1,2]\n",
        "[camera]\nposition = [1,2,'a']\n",
        "[camera]\ntarget = [1,2,3]\n",
        "[material.a]\ntype = 'difuse'\n",
        "[material.a]\nreflectance = 1\n",
        "[material.a]\ntype = 'diffuse'\nreflectance = 1.5\n",
        "[material.a]\ntype = 'diffuse'\nreflectance = 'tilse'\n[texture.tiles]\ntype='checker'\n",
        "[[shape]]\ntype = 'sphere'\nmaterial = 'x'\n",
        "[[shape]]\ntype = 'sphere'\nradius = -1\n",
        "[render]\nspp = 'a'\n",
        "[render]\nintegrator = 'paht'\n",
        "[render]\nsppp = 1\n",
        "[[expect]]\nlayers = { DX = 1 }\n",
        "a = \n",
        "[render]\nspp = 1\nspp = 2\n",
    ] {
        println!("{text}--> {:?}\n", error(text));
    }
}

#[test]
fn print_schema() {
    println!("{}", schema());
}
