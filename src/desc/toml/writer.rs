//! Scenes as text: each table of the format made from what it builds.
//!
//! What is written reads as the scene that was written, with its lists in their order and its numbers to the bit, so that
//! its image is bit for bit the one of the scene. Left out is what no image depends on: notes, metadata and variants.

use super::camera::CameraTable;
use super::color::{Radiance, Scalar};
use super::environment::EnvironmentTable;
use super::image::ImageTable;
use super::keys::{Named, OneOrMore};
use super::light::LightTable;
use super::material::MaterialTable;
use super::place::Place;
use super::profile::ProfileTable;
use super::read::At;
use super::render::{ExpectTable, RenderTable};
use super::scene::SceneFile;
use super::shape::{ShapeKind, ShapeTable};
use super::texture::TextureTable;
use super::{beside, write::document};
use crate::desc::ies::Profile;
use crate::desc::{Image, Light, Mesh, Object, RenderSettings, Scene, Shape, Sides, TextureRef};
use std::collections::HashSet;
use std::sync::Arc;

/// A scene as text, and the files that the text names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Written {
    /// The scene file.
    pub text: String,
    /// Names, relative to the folder of the scene file, and contents.
    pub files: Vec<(String, Vec<u8>)>,
}

/// The scene as one text that names no files: meshes and pixels are numbers in it.
pub fn to_text(scene: &Scene) -> String {
    Writer { scene, folder: None, files: Vec::new() }.write().text
}

/// The scene as text, with large meshes (PLY) and images (PNG, OpenEXR) in files of the folder `folder`.
pub fn write(scene: &Scene, folder: &str) -> Written {
    Writer { scene, folder: Some(folder), files: Vec::new() }.write()
}

/// Names of what others refer to, by their numbers in the scene.
pub(super) struct Names {
    materials: Vec<String>,
    textures: Vec<String>,
    images: Vec<String>,
    geometry: Vec<String>,
    profiles: Vec<Arc<Profile>>,
    /// Which images hold codes.
    codes: Vec<bool>,
}

impl Names {
    fn of(scene: &Scene) -> Self {
        let numbered = |prefix: &str, count: usize| (0..count).map(|i| format!("{prefix}{i}")).collect();
        let mut profiles: Vec<Arc<Profile>> = Vec::new();
        for light in &scene.lights {
            if let Light::Profile { profile, .. } = light
                && !profiles.contains(profile)
            {
                profiles.push(profile.clone());
            }
        }
        Self {
            materials: distinct(scene.materials.iter().map(|m| m.name.as_str()), "material"),
            textures: numbered("texture", scene.textures.len()),
            images: numbered("image", scene.images.len()),
            geometry: numbered("geometry", scene.shapes.len()),
            profiles,
            codes: scene.images.iter().map(|image| image.pixels.are_codes()).collect(),
        }
    }

    /// The texture of a use.
    pub(super) fn texture(&self, use_of: &TextureRef) -> At<String> {
        At::nowhere(self.textures[use_of.texture].clone())
    }

    /// An image.
    pub(super) fn image(&self, number: usize) -> At<String> {
        At::nowhere(self.images[number].clone())
    }

    /// Whether an image holds codes, not linear floats.
    pub(super) fn has_codes(&self, image: usize) -> bool {
        self.codes[image]
    }

    /// A light's measurement.
    pub(super) fn profile(&self, profile: &Arc<Profile>) -> At<String> {
        let number = self.profiles.iter().position(|known| known == profile).unwrap_or_default();
        At::nowhere(profile_name(number))
    }
}

fn profile_name(number: usize) -> String {
    format!("profile{number}")
}

/// Each name once: what is empty is called `kind` and its number, and what another has is followed by its number.
fn distinct<'a>(names: impl Iterator<Item = &'a str>, kind: &str) -> Vec<String> {
    let mut taken = HashSet::new();
    let unique = |(i, name): (usize, &str)| {
        let mut unique = if name.is_empty() { format!("{kind}{i}") } else { name.to_string() };
        while !taken.insert(unique.clone()) {
            unique = format!("{unique}-{i}");
        }
        unique
    };
    names.enumerate().map(unique).collect()
}

struct Writer<'a> {
    scene: &'a Scene,
    /// Where files go; `None`: there are none.
    folder: Option<&'a str>,
    files: Vec<(String, Vec<u8>)>,
}

impl Writer<'_> {
    fn write(mut self) -> Written {
        let scene = self.scene;
        let names = Names::of(scene);
        let images: Vec<_> =
            scene.images.iter().zip(&names.images).map(|(image, name)| self.image(image, name)).collect();

        // Geometry that objects have one each in order stands in their shapes, other geometry by itself.
        let own = scene.objects.iter().map(|o| o.shape).eq(0..scene.shapes.len());
        let kinds: Vec<_> = scene.shapes.iter().map(|shape| self.geometry(shape)).collect();
        let (geometry, mut kinds) = if own { (Vec::new(), kinds) } else { (kinds, Vec::new()) };
        let mut kinds = kinds.drain(..);
        let shape = |object: &Object| {
            let kind = kinds.next().unwrap_or_else(|| ShapeKind::shared(names.geometry[object.shape].clone()));
            At::nowhere(shape(object, kind, &names))
        };

        let materials = scene.materials.iter().zip(&names.materials);
        let materials = materials.map(|(m, name)| (name.clone(), MaterialTable::of(m, name, &names)));
        let textures = scene.textures.iter().map(|texture| TextureTable::of(texture, &names));
        let profiles = names.profiles.iter().enumerate().map(|(i, p)| (profile_name(i), ProfileTable::of(p)));
        let render = (scene.render != RenderSettings::default()).then(|| RenderTable::of(&scene.render));
        let file = SceneFile {
            name: Some(scene.name.clone()),
            camera: OneOrMore(scene.cameras.iter().map(|c| At::nowhere(CameraTable::of(c))).collect()),
            material: Named::of(materials),
            image: Named::of(names.images.iter().cloned().zip(images)),
            texture: Named::of(names.textures.iter().cloned().zip(textures)),
            geometry: Named::of(names.geometry.iter().cloned().zip(geometry)),
            shape: scene.objects.iter().map(shape).collect(),
            group: Named::of(None),
            instance: Vec::new(),
            profile: Named::of(profiles),
            light: scene.lights.iter().map(|light| LightTable::of(light, &names)).collect(),
            environment: scene.environment.as_ref().map(|e| At::nowhere(EnvironmentTable::of(e, &names))),
            render,
            expect: OneOrMore(scene.expect.iter().map(|e| At::nowhere(ExpectTable::of(e))).collect()),
        };
        Written { text: document(&file), files: self.files }
    }

    /// An image, in a file where there is a folder and it is large.
    fn image(&mut self, image: &Image, name: &str) -> ImageTable {
        /// Most pixels that stand in the text.
        const FEW: usize = 64;
        let count = image.size[0] as usize * image.size[1] as usize;
        let encoded = if count > FEW && self.folder.is_some() { beside::image(image) } else { None };
        let file = encoded.map(|(ending, bytes)| self.file(name, ending, bytes));
        ImageTable::of(image, name, file)
    }

    /// Geometry; a mesh in a file where there is a folder and it is large.
    fn geometry(&mut self, shape: &Shape) -> ShapeKind {
        let file = match shape {
            Shape::Mesh(mesh) if self.folder.is_some() && is_large(mesh) => {
                let name = format!("mesh{}", self.files.len());
                Some(self.file(&name, "ply", beside::ply(mesh)))
            }
            _ => None,
        };
        ShapeKind::of(shape, file)
    }

    /// Keeps a file; its name in the text.
    fn file(&mut self, stem: &str, ending: &str, bytes: Vec<u8>) -> String {
        let name = format!("{}/{stem}.{ending}", self.folder.unwrap_or_default());
        self.files.push((name.clone(), bytes));
        name
    }
}

fn is_large(mesh: &Mesh) -> bool {
    /// Most vertices that stand in the text.
    const FEW: usize = 64;
    mesh.positions.len() > FEW || mesh.indices.len() > FEW
}

/// An object, as the shape that it is.
fn shape(object: &Object, kind: ShapeKind, names: &Names) -> ShapeTable {
    let Object { name, shape: _, to_world, material, emission, reversed, closed } = object;
    let coat = emission.and_then(|e| e.coat);
    ShapeTable {
        name: name.clone(),
        material: Some(At::nowhere(names.materials[*material].clone())),
        emission: emission.map(|e| Radiance::of(&e.radiance, names)),
        emission_sides: emission.map_or(Sides::Front, |e| e.sides),
        emission_coat: coat.map(|coat| Scalar::of(&coat, names)),
        reversed: *reversed,
        closed: *closed,
        place: Place::of(*to_world),
        kind,
    }
}
