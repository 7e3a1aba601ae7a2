//! Our own scene format: TOML, strict and readable.
//!
//! ```toml
//! name = "A ball in a room"
//!
//! [camera]
//! position = [0, 1, 4]          # centre of projection
//! target = [0, 1, 0]
//! view_angle = 40               # degrees, across the height
//! resolution = [640, 480]
//!
//! [texture.tiles]
//! type = "checker"
//!
//! [material.floor]
//! type = "diffuse"
//! reflectance = "tiles"         # a texture's name; or 0.5, [0.7, 0.6, 0.5], "#c0b0a0"
//!
//! [material.glass]
//! type = "dielectric"
//! ior = 1.5
//!
//! [[shape]]
//! type = "quad"
//! corner = [-3, 0, 3]
//! edge_u = [6, 0, 0]
//! edge_v = [0, 0, -6]
//! material = "floor"
//!
//! [[shape]]
//! type = "sphere"
//! center = [0, 1, 0]
//! material = "glass"
//!
//! [[light]]
//! type = "point"
//! position = [0, 5, 0]
//! intensity = 50
//!
//! [render]
//! spp = 64
//! ```
//!
//! Every key is declared once, in the file of its table (`scene` has the whole). A declaration reads the table, refuses
//! unknown keys, becomes the JSON Schema of [`schema()`], which holds every key with its unit and default, and is written
//! back by [`write()`]: each table has a `build`, which makes a part of the scene, and its inverse `of`.
//! Lengths are metres, angles degrees, colours linear RGB (BT.709). A hyphen in a key is read as an underscore. Files
//! are looked for below the scene's folder and nowhere else.
//!
//! | file | what |
//! | --- | --- |
//! | `keys`, `read`, `number`, `short`, `words` | declarations of tables, and the values that stand in them |
//! | `schema` | the JSON Schema |
//! | `write`, `writer`, `beside` | values, scenes and their files as text |
//! | `build`, `files`, `budget` | tables → scene: names become numbers, files are read, groups are placed, within bounds |
//! | the others | a table or a few each |

mod beside;
mod budget;
mod build;
mod camera;
mod color;
mod conductor;
mod environment;
mod files;
mod film;
mod gltf_models;
mod image;
mod interior;
mod keys;
mod layers;
mod light;
mod lookup;
mod material;
mod metals;
mod mix;
mod normal_map;
mod number;
mod place;
mod profile;
mod read;
mod render;
mod roughness;
mod scene;
mod schema;
mod shape;
mod short;
mod sky;
mod texture;
mod words;
mod write;
mod writer;

pub use schema::schema;
pub use writer::{Written, to_text, write};

use self::read::{Fault, Read};
use super::files::{self as scene_files, Folder};
use super::{Error, Options, Scene};
use ::toml::Spanned;
use ::toml::de::{DeTable, DeValue};
use std::path::Path;

/// Reads a scene file.
pub fn read(path: &Path) -> Result<Scene, Error> {
    read_with(path, &Options::default())
}

/// Reads a scene file; the options hold for the glTF files that it places.
pub fn read_with(path: &Path, options: &Options) -> Result<Scene, Error> {
    let bytes = scene_files::read(path)?;
    let text = String::from_utf8(bytes).map_err(|e| {
        let line = e.as_bytes()[..e.utf8_error().valid_up_to()].iter().filter(|b| **b == b'\n').count() + 1;
        Error::invalid(path, format!("{line}:1"), "is not UTF-8 text")
    })?;
    parse_with(&text, path, Folder::of(path), options)
}

/// The scene that `text` describes. Files that it names are looked for in the folder of `path`; errors name `path`.
pub fn parse(text: &str, path: &Path) -> Result<Scene, Error> {
    parse_in(text, path, Folder::of(path))
}

/// The scene that `text` describes. Files that it names are looked for in `folder`; errors name `path`.
pub fn parse_in(text: &str, path: &Path, folder: Folder) -> Result<Scene, Error> {
    parse_with(text, path, folder, &Options::default())
}

fn parse_with(text: &str, path: &Path, folder: Folder, options: &Options) -> Result<Scene, Error> {
    let scene = tables(text).and_then(|file| build::Builder::new(&file, folder, options).build());
    let mut scene = scene.map_err(|fault| fault.locate(path, text))?;
    if scene.name.is_empty() {
        scene.name = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    }
    scene.source = Some(path.into());
    Ok(scene)
}

/// The tables of a text.
fn tables(text: &str) -> Result<scene::SceneFile, Fault> {
    let table = DeTable::parse(text).map_err(|e| {
        let at = e.span().unwrap_or(0..0);
        Fault::new(&at, format!("is not TOML: {}", e.message()))
    })?;
    let at = table.span();
    scene::SceneFile::read(&Spanned::new(at, DeValue::Table(table.into_inner())))
}
