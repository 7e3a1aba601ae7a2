//! The kernels of the traversal, as the environment chooses them.

use super::{folder, triangle};
use assert_cmd::Command;
use radianza::bvh::Isa;
use std::path::Path;

fn with(folder: &Path, isa: &str, arguments: &[&str]) -> (i32, String) {
    let mut command = Command::cargo_bin("radianza").unwrap();
    let output = command.current_dir(folder).env(Isa::VARIABLE, isa).args(arguments).output().unwrap();
    (output.status.code().unwrap_or(-1), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn every_kernel_makes_the_same_file() {
    let folder = folder();
    triangle(folder.path(), "tri.gltf", "");
    let mut files = Vec::new();
    for (_, name) in Isa::ALL.into_iter().filter(|(isa, _)| isa.is_available()) {
        let output = format!("{name}.exr");
        let arguments = ["render", "tri.gltf", "--spp", "4", "--size", "33x21", "-q", "-o", &output];
        assert_eq!(with(folder.path(), name, &arguments).0, 0);
        files.push(std::fs::read(folder.path().join(output)).unwrap());
    }
    assert!(files.windows(2).all(|pair| pair[0] == pair[1]), "kernels differ");
}

#[test]
fn an_unknown_kernel_is_a_usage_error() {
    let folder = folder();
    triangle(folder.path(), "tri.gltf", "");
    let (code, words) = with(folder.path(), "sse", &["info", "tri.gltf"]);
    assert_eq!(code, 2, "{words}");
    assert!(words.contains("RADIANZA_ISA") && words.contains("portable, avx2, avx512"), "{words}");
}
