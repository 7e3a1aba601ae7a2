//! What is asked of every file: a reader returns, and what it returns can be compiled.

#![allow(dead_code, reason = "each target asks one")]

use radianza::desc::{self, Error, Pixels, image_file};
use radianza::scene::Scene;
use std::path::Path;

/// A place where nothing is: what a file refers to is missing.
const NOWHERE: &str = "/nonexistent/fuzz";

fn compile(scene: Result<desc::Scene, Error>) {
    let Ok(mut scene) = scene else { return };
    desc::complete(&mut scene);
    if let Ok(compiled) = Scene::compile(&scene) {
        assert_eq!(compiled.info().materials.len(), scene.materials.len());
    }
}

/// glTF, text or binary.
pub(crate) fn gltf(bytes: &[u8]) {
    let file = Path::new(NOWHERE).join("a.glb");
    let missing = |name: &str, place: &str| Err(Error::missing(&file, place, format!("`{name}` is not there")));
    compile(desc::gltf::parse(bytes, &file, &missing));
}

/// The crate's own format.
pub(crate) fn toml(bytes: &[u8]) {
    if let Ok(text) = std::str::from_utf8(bytes) {
        compile(desc::toml::parse(text, &Path::new(NOWHERE).join("a.toml")));
    }
}

/// Wavefront OBJ.
pub(crate) fn obj(bytes: &[u8]) {
    if let Ok(text) = std::str::from_utf8(bytes) {
        compile(desc::obj::parse(text, &Path::new(NOWHERE).join("a.obj")));
    }
}

/// Stanford PLY.
pub(crate) fn ply(bytes: &[u8]) {
    compile(desc::ply::parse(bytes, &Path::new(NOWHERE).join("a.ply")));
}

/// Every image format.
pub(crate) fn image(bytes: &[u8]) {
    let Ok(image) = image_file::decode("a", bytes) else { return };
    let pixels = match &image.pixels {
        Pixels::Rgba8(pixels) => pixels.len(),
        Pixels::Rgba16(pixels) => pixels.len(),
        Pixels::Rgba32F(pixels) => {
            assert!(pixels.iter().flatten().all(|x| x.is_finite()));
            pixels.len()
        }
    };
    assert_eq!(pixels, image.size[0] as usize * image.size[1] as usize);
}
