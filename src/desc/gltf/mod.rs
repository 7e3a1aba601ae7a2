//! glTF 2.0, `.gltf` and `.glb`.
//!
//! | in the file | in the scene |
//! | --- | --- |
//! | nodes of the default scene | one [`Object`](super::Object) per node and primitive, its matrix the product along the path |
//! | primitive | one [`Mesh`](super::Mesh), shared by all nodes and primitives with the same data; points and lines are skipped |
//! | missing normals | flat; missing tangents under a normal map: MikkTSpace over the map's own UV |
//! | material | [`MetallicRoughness`](super::MetallicRoughness), its emission, normal map and coverage |
//! | images | PNG and JPEG; KTX2 by `KHR_texture_basisu`, WebP by `EXT_texture_webp`: what the extension names, never the fallback |
//! | `KHR_materials_anisotropy`, `_sheen`, `_clearcoat` | [`Layers`](super::Layers) of the material; a sheen roughness below 0.05 is 0.05 |
//! | `KHR_materials_pbrSpecularGlossiness` | [`SpecularGlossiness`](super::SpecularGlossiness) in its place |
//! | `KHR_materials_volume`, `_dispersion` | the interior of closed meshes, the mesh itself being its thickness; of overlapping ones that entered last is there |
//! | `alphaMode` MASK, BLEND | coverage = `baseColorFactor` A × texture A (× vertex alpha) |
//! | cameras, `KHR_lights_punctual`, `EXT_lights_ies` | cameras and lights in world space, scale removed |
//! | `range` of a light | the end that the extension requires, by the window that it recommends |
//! | `EXT_lights_image_based` | the environment: the first level of the specular cube map |
//! | `KHR_xmp_json_ld` | the packet of the asset, in [`Scene::metadata`] and so in the header of every image |
//! | `"extras": {"closed": true}` of a node or mesh | its objects are declared closed |
//! | `EXT_mesh_gpu_instancing` | an object per instance; `KHR_node_visibility` leaves objects and lights out, not cameras |
//! | morph targets | the primitive displaced by the node's weights, else the mesh's: a mesh of its own for each set of weights |
//! | skins | the primitive bent by its joints, in world space: a mesh of its own for each skin |
//! | animations | none, or all together at the time of [`Options`]: see below |
//! | `KHR_materials_variants` | the materials of the variant of [`Options`] |
//! | `KHR_mesh_quantization`, `EXT_meshopt_compression`, `KHR_draco_mesh_compression` | what they encode |
//!
//! Time: where none is asked for, the pose that the nodes state. Else all animations of the file play together from
//! the same zero, as if it were one; where two of them drive the same property the last one counts, and a note says so.
//! Before its first key a curve has its first value, and behind its last key its last. `KHR_animation_pointer` animates
//! whatever the Asset Object Model lists; what is not in the document stays as it is, and is noted.
//!
//! Photometric numbers (cd, lx, cd/m²) are carried one to one into the linear RGB lanes. What the file lacks (camera,
//! light) stays empty here. What becomes of an extension says [`EXTENSIONS`]; one that is ignored is an error where the file requires
//! it, and a note where the file only uses it.
//!
//! Input is hostile: every index and range is checked where it is used, a node is visited once, nothing recurses, and
//! what is decoded is bounded by the size of the input. Errors name the JSON pointer.

mod accessor;
mod animation;
mod budget;
mod buffers;
mod camera;
mod component;
mod deform;
mod document;
mod draco;
mod extensions;
mod light;
mod material;
mod material_extensions;
mod mesh;
mod meshopt;
mod node;
mod normals;
mod notes;
mod texture;
mod vertices;

pub use extensions::{EXTENSIONS, Extension, Status, Use, extension, honoured};

use super::files::{self, Folder};
use super::{Error, Options, Scene};
use accessor::Accessors;
use budget::Budget;
use buffers::Buffers;
use glam::DMat4;
use gltf::json;
use material::UvSets;
use notes::Notes;
use serde_json::{Value, json};
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::rc::Rc;

/// How other files are read: by the name in the document, and the JSON pointer for the error.
pub type Resolve<'a> = &'a dyn Fn(&str, &str) -> Result<Vec<u8>, Error>;

/// Reads a `.gltf` or `.glb` file, and what it refers to inside its folder, as its nodes and primitives state it.
pub fn read(path: &Path) -> Result<Scene, Error> {
    read_with(path, &Options::default())
}

/// Reads a `.gltf` or `.glb` file at a time, in a variant.
pub fn read_with(path: &Path, options: &Options) -> Result<Scene, Error> {
    let folder = Folder::of(path);
    parse_with(&files::read(path)?, path, &|name, place| folder.read(name, place), options)
}

/// Reads the bytes of a `.gltf` or `.glb` file; `file` is its name in messages.
pub fn parse(bytes: &[u8], file: &Path, resolve: Resolve) -> Result<Scene, Error> {
    parse_with(bytes, file, resolve, &Options::default())
}

/// Reads the bytes of a `.gltf` or `.glb` file at a time, in a variant; one that it does not have is passed over.
pub fn parse_with(bytes: &[u8], file: &Path, resolve: Resolve, options: &Options) -> Result<Scene, Error> {
    let container = document::split(bytes, file)?;
    let mut notes = Notes::default();
    let mut document = document::parse(container.json, file, &mut notes)?;
    let animations = document.as_object_mut().and_then(|d| d.remove("animations")).unwrap_or(json!([]));
    let duration = animation::duration(&animations, &document);

    // The document at the time asked for is a document like any other. Buffers are the same at all times.
    let rest = document::typed(&document, file)?;
    let budget = Budget::of(bytes.len());
    let buffers = Buffers::new(Source { file, root: &rest, json: &Value::Null }, container.bin, resolve);
    let posed = match options.at.filter(|_| duration.is_some()) {
        Some(time) => {
            let source = Source { file, root: &rest, json: &Value::Null };
            let accessors = Accessors { source, buffers: &buffers, budget: &budget };
            animation::pose(&mut document, &animations, time, accessors, &mut notes)?;
            Some(document::typed(&document, file)?)
        }
        None => None,
    };
    drop(animations);
    let source = Source { file, root: posed.as_ref().unwrap_or(&rest), json: &document };
    let variants: Vec<String> = material::variants(source)?.into_iter().map(String::from).collect();
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut reader = Reader {
        source,
        buffers,
        budget,
        notes,
        variant: options.variant.as_ref().and_then(|name| variants.iter().position(|v| v == name)),
        scene: Scene {
            name,
            source: Some(file.into()),
            variants,
            duration,
            extensions: extensions::uses(&document, file)?,
            metadata: document::packets(&document, file)?,
            ..Scene::default()
        },
        materials: HashMap::new(),
        uv_sets: UvSets::default(),
        uv_sets_of: HashMap::new(),
        textures: HashMap::new(),
        images: HashMap::new(),
        geometry: HashMap::new(),
        lit: HashSet::new(),
        meshes: HashMap::new(),
        profiles: HashMap::new(),
        worlds: Vec::new(),
        skins: HashMap::new(),
    };
    reader.nodes()?;
    reader.image_based()?;
    reader.choices(options);
    Ok(Scene { notes: reader.notes.finish(), ..reader.scene })
}

/// The document, and the name of its file.
#[derive(Clone, Copy)]
struct Source<'a> {
    file: &'a Path,
    root: &'a json::Root,
    /// The document as it is written, for what has no type.
    json: &'a Value,
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
    /// UV sets of the material that is being read.
    uv_sets: UvSets,
    /// Material of the scene → n of the TEXCOORD_n that it has in the places of 0 and 1.
    uv_sets_of: HashMap<usize, [u32; 2]>,
    /// Texture of the document and whether it is sRGB → texture of the scene.
    textures: HashMap<(usize, bool), usize>,
    /// Image of the document → image of the scene.
    images: HashMap<usize, texture::Decoded>,
    /// What a primitive is made of → shape of the scene, if a triangle is left of it.
    geometry: HashMap<mesh::Ingredients, Option<usize>>,
    /// Shapes that emit and are placed.
    lit: HashSet<usize>,
    /// Mesh of the document and its pose → its primitives as shapes with materials.
    meshes: HashMap<(usize, mesh::Pose), Rc<[mesh::Part]>>,
    /// Node → world, of those that are in the scene.
    worlds: Vec<Option<DMat4>>,
    /// Skin of the document → mesh → world, for each of its joints.
    skins: HashMap<usize, Rc<[DMat4]>>,
    /// The variant of the document that is chosen.
    variant: Option<usize>,
    /// Light profile of the document, read.
    profiles: HashMap<usize, std::sync::Arc<super::ies::Profile>>,
}

impl<'a> Reader<'a> {
    /// What accessors are read with.
    fn accessors(&self) -> Accessors<'_, 'a> {
        Accessors { source: self.source, buffers: &self.buffers, budget: &self.budget }
    }

    /// Says what else the file holds.
    fn choices(&mut self, options: &Options) {
        if let Some(end) = self.scene.duration.filter(|_| options.at.is_none()) {
            self.notes.say(format!("nothing moves: of animations of {end} s the pose that the nodes state is used"));
        }
        if self.variant.is_none() && !self.scene.variants.is_empty() {
            let names: Vec<_> = self.scene.variants.iter().map(|name| format!("`{name}`")).collect();
            self.notes.say(format!("of the variants {} none is chosen", names.join(", ")));
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
