//! glTF 2.0, `.gltf` and `.glb`.
//!
//! | in the file | in the scene |
//! | --- | --- |
//! | nodes of the default scene | one [`Object`](super::Object) per node and primitive, its matrix the product along the path |
//! | primitive | one [`Mesh`](super::Mesh), shared by all nodes and primitives with the same data; points and lines are skipped |
//! | missing normals | flat; missing tangents under a normal map: MikkTSpace over the map's own UV |
//! | material | [`MetallicRoughness`](super::MetallicRoughness), its emission, normal map and coverage |
//! | `KHR_materials_volume`, `_dispersion` | the interior of closed meshes, the mesh itself being its thickness; of overlapping ones that entered last is there |
//! | `alphaMode` MASK, BLEND | coverage = `baseColorFactor` A × texture A (× vertex alpha) |
//! | cameras, `KHR_lights_punctual` | cameras and lights in world space, scale removed |
//! | `"extras": {"closed": true}` of a node or mesh | its objects are declared closed |
//! | skins, morph targets, animations | the static pose, and a note |
//!
//! Photometric numbers (cd, lx, cd/m²) are carried one to one into the linear RGB lanes. What the file lacks (camera,
//! light) stays empty here. An extension of [`HONOURED`] is honoured; another one is an error where the file requires
//! it, and a note where the file only uses it.
//!
//! Input is hostile: every index and range is checked where it is used, a node is visited once, nothing recurses, and
//! what is decoded is bounded by the size of the input. Errors name the JSON pointer.

mod accessor;
mod budget;
mod buffers;
mod camera;
mod container;
mod dielectric;
mod diffuse_transmission;
mod document;
mod extensions;
mod interior;
mod light;
mod material;
mod mesh;
mod node;
mod normals;
mod notes;
mod slot;
mod tangents;
mod texture;
mod triangles;
mod uri;

pub use extensions::HONOURED;

use super::files::{self, Folder};
use super::{Error, Scene};
use budget::Budget;
use buffers::Buffers;
use gltf::json;
use notes::Notes;
use std::collections::HashMap;
use std::path::Path;

/// How other files are read: by the name in the document, and the JSON pointer for the error.
pub type Resolve<'a> = &'a dyn Fn(&str, &str) -> Result<Vec<u8>, Error>;

/// Reads a `.gltf` or `.glb` file, and what it refers to inside its folder.
pub fn read(path: &Path) -> Result<Scene, Error> {
    let folder = Folder::of(path);
    parse(&files::read(path)?, path, &|name, place| folder.read(name, place))
}

/// Reads the bytes of a `.gltf` or `.glb` file; `file` is its name in messages.
pub fn parse(bytes: &[u8], file: &Path, resolve: Resolve) -> Result<Scene, Error> {
    let container = container::split(bytes, file)?;
    let mut notes = Notes::default();
    let root = document::parse(container.json, file, &mut notes)?;
    let source = Source { file, root: &root };
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut reader = Reader {
        source,
        buffers: Buffers::new(source, container.bin, resolve),
        budget: Budget::of(bytes.len()),
        notes,
        scene: Scene { name, source: Some(file.into()), ..Scene::default() },
        materials: HashMap::new(),
        textures: HashMap::new(),
        images: HashMap::new(),
        geometry: HashMap::new(),
        meshes: HashMap::new(),
    };
    reader.nodes()?;
    reader.still_life();
    Ok(Scene { notes: reader.notes.finish(), ..reader.scene })
}

/// The document, and the name of its file.
#[derive(Clone, Copy)]
struct Source<'a> {
    file: &'a Path,
    root: &'a json::Root,
}

impl<'a> Source<'a> {
    /// Wrong content at a JSON pointer.
    fn invalid(&self, place: impl Into<String>, message: impl Into<String>) -> Error {
        Error::invalid(self.file, place, message)
    }

    /// Element `index` of a list of things called `what`, which `place` refers to.
    fn get<'b, T>(&self, list: &'b [T], index: usize, what: &str, place: &str) -> Result<&'b T, Error> {
        list.get(index).ok_or_else(|| {
            let message = format!("refers to {what} {index}; the file has {}", list.len());
            self.invalid(place, message)
        })
    }
}

/// The scene under construction. Parts of the document are turned into parts of the scene when they are first used;
/// the maps remember which became which.
struct Reader<'a> {
    source: Source<'a>,
    buffers: Buffers<'a>,
    budget: Budget,
    notes: Notes,
    scene: Scene,
    /// Material of the document, or the default one → material of the scene.
    materials: HashMap<Option<usize>, usize>,
    /// Texture of the document and whether it is sRGB → texture of the scene.
    textures: HashMap<(usize, bool), usize>,
    /// Image of the document → image of the scene.
    images: HashMap<usize, usize>,
    /// What a primitive is made of → shape of the scene, if a triangle is left of it.
    geometry: HashMap<mesh::Ingredients, Option<usize>>,
    /// Mesh of the document → its primitives as shapes with materials.
    meshes: HashMap<usize, std::rc::Rc<[mesh::Part]>>,
}

impl Reader<'_> {
    /// Says what moves in the file and does not move here.
    fn still_life(&mut self) {
        let root = self.source.root;
        if !root.animations.is_empty() {
            self.notes.add(
                "animations are not played: the pose that the nodes state is used",
                "/animations/0",
                root.animations.len(),
            );
        }
        if root.nodes.iter().any(|n| n.skin.is_some()) {
            self.notes.add(
                "skins are not applied: the unskinned mesh is used where its node is",
                "/skins/0",
                root.skins.len().max(1),
            );
        }
    }

    /// `x` in [0, 1]: refused where it is not a number, clamped with a note where it is outside.
    fn unit(&mut self, x: f32, place: &str) -> Result<f32, Error> {
        self.clamped(x, 0.0, 1.0, place)
    }

    /// `x` in [low, high]: refused where it is not finite, clamped with a note where it is outside.
    fn clamped(&mut self, x: f32, low: f32, high: f32, place: &str) -> Result<f32, Error> {
        let x = self.finite(x, place)?;
        if !(low..=high).contains(&x) {
            let range = if high < f32::INFINITY { format!("[{low}, {high}]") } else { format!("[{low}, ∞)") };
            self.notes.at(place, format!("numbers outside {range} are clamped"));
        }
        Ok(x.clamp(low, high))
    }

    /// `x` if it is finite.
    fn finite(&self, x: f32, place: &str) -> Result<f32, Error> {
        x.is_finite()
            .then_some(x)
            .ok_or_else(|| self.source.invalid(place, format!("is {x}; expected a finite number")))
    }
}
