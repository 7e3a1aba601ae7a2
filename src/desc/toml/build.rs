//! From the tables to the scene: names become indices, files are read, groups are placed.

use super::keys::{Entry, Named};
use super::read::{At, Fault, suggest};
use super::scene::{InstanceTable, SceneFile};
use super::shape::{ShapeKind, ShapeTable};
use crate::desc::files::{self, Folder};
use crate::desc::{Emission, Image, Interior, Light, Material, Mesh, Model, Object, Options, Scene, TextureRef};
use crate::desc::{ies, image_file, load, mesh_check, place};
use glam::Mat4;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Most memory that placed objects and lights may take \[bytes\]: nested groups multiply.
const MAX_PLACED: usize = 1 << 30;

/// A scene under construction.
pub(super) struct Builder<'a> {
    file: &'a SceneFile,
    folder: Folder,
    options: &'a Options,
    /// What there is so far.
    pub(super) scene: Scene,
    images: HashMap<String, usize>,
    /// Light profiles by their file.
    profiles: HashMap<String, Arc<ies::Profile>>,
    /// Texture by its number in the file and whether it is used as a colour.
    textures: HashMap<(usize, bool), usize>,
    parts: HashMap<String, Part>,
    groups: HashMap<usize, Part>,
    /// Groups and mixtures being built, to find cycles.
    open: Vec<(&'static str, usize)>,
    /// The material of shapes that only emit.
    absorb: Option<usize>,
    /// Memory that was spent on placing \[bytes\].
    placed: usize,
    /// What images may take.
    pixels: image_file::Grant,
}

/// Objects and lights that stand together.
#[derive(Clone, Debug, Default)]
struct Part {
    objects: Vec<Object>,
    lights: Vec<Light>,
}

impl<'a> Builder<'a> {
    /// Nothing yet.
    pub(super) fn new(file: &'a SceneFile, folder: Folder, options: &'a Options) -> Self {
        Self {
            file,
            folder,
            options,
            scene: Scene::default(),
            images: HashMap::new(),
            profiles: HashMap::new(),
            textures: HashMap::new(),
            parts: HashMap::new(),
            groups: HashMap::new(),
            open: Vec::new(),
            absorb: None,
            placed: 0,
            pixels: image_file::Grant::default(),
        }
    }

    /// The scene.
    pub(super) fn build(mut self) -> Result<Scene, Fault> {
        let file = self.file;
        self.scene.name = file.name.clone().unwrap_or_default();
        self.scene.cameras = file.camera.0.iter().map(|c| c.build()).collect::<Result<_, _>>()?;
        self.scene.render = file.render.as_ref().map(|r| r.0.clone()).unwrap_or_default();
        self.scene.expect = file.expect.0.iter().map(|e| e.0.clone()).collect();

        // Materials keep their number; textures are made as materials ask for them, and those that none uses are
        // made too, so that their errors do not wait for their first use.
        for entry in &file.material.0 {
            let material = entry.value.build(&entry.name, &entry.at, &mut self)?;
            self.scene.materials.push(material);
        }
        for index in 0..file.texture.0.len() {
            if !self.textures.contains_key(&(index, true)) && !self.textures.contains_key(&(index, false)) {
                self.texture_number(index, true)?;
            }
        }

        let mut all = self.part(&file.shape, &file.instance)?;
        for light in &file.light {
            all.lights.push(light.build(&mut self)?);
        }
        // Groups that no instance places are built all the same: their errors count.
        for (index, entry) in file.group.0.iter().enumerate() {
            self.group(index, &entry.at)?;
        }
        self.scene.objects = all.objects;
        self.scene.lights = all.lights;
        if let Some(environment) = &file.environment {
            self.scene.environment = Some(environment.value.build(&environment.at, &mut self)?);
        }
        Ok(self.scene)
    }

    /// Shapes and instances, placed.
    fn part(&mut self, shapes: &'a [At<ShapeTable>], instances: &'a [At<InstanceTable>]) -> Result<Part, Fault> {
        let mut part = Part::default();
        for shape in shapes {
            self.shape(&shape.value, &shape.at, &mut part)?;
        }
        for At { at, value: instance } in instances {
            let material = instance.material.as_ref().map(|m| self.material(m)).transpose()?;
            let to_parent = instance.place.matrix(at)?;
            let index = find(&self.file.group, "group", &instance.group)?;
            let group = self.group(index, &instance.group.at)?;
            let name = instance.name.as_deref().unwrap_or(&instance.group.value);
            part.add(&group, to_parent, material, Some(name), &instance.group.at, &mut self.placed)?;
        }
        Ok(part)
    }

    /// Adds one shape, or what its file has.
    fn shape(&mut self, shape: &'a ShapeTable, at: &Range<usize>, part: &mut Part) -> Result<(), Fault> {
        let ShapeTable { name, material, emission, emission_sides, reversed, closed, place, kind } = shape;
        let to_parent = place.matrix(at)?;
        let material = material.as_ref().map(|m| self.material(m)).transpose()?;
        let emission = match emission {
            None => None,
            Some(radiance) => Some(Emission { radiance: radiance.build(self)?, sides: *emission_sides, coat: None }),
        };

        if let ShapeKind::FileShape(f) = kind {
            let mut content = self.file_part(&f.file)?;
            for object in &mut content.objects {
                object.emission = emission.or(object.emission);
                object.reversed ^= reversed;
                object.closed |= closed;
            }
            let name = (!name.is_empty()).then_some(name.as_str());
            return part.add(&content, to_parent, material, name, &f.file.at, &mut self.placed);
        }
        let material = match material {
            Some(index) => index,
            None if emission.is_some() => self.absorbing_material(),
            None => {
                let message = "missing key `material`; a shape that does not emit needs one";
                return Err(Fault::new(at, message));
            }
        };
        let Some((geometry, local)) = kind.build(name, at, self)? else { return Ok(()) };
        self.scene.shapes.push(geometry);
        part.objects.push(Object {
            name: name.clone(),
            shape: self.scene.shapes.len() - 1,
            to_world: to_parent * local,
            material,
            emission,
            reversed: *reversed,
            closed: *closed,
        });
        Ok(())
    }

    /// The content of a group, built once.
    fn group(&mut self, index: usize, at: &Range<usize>) -> Result<Part, Fault> {
        if let Some(part) = self.groups.get(&index) {
            return Ok(part.clone());
        }
        let entry = &self.file.group.0[index];
        self.enter("group", index, &entry.name, at)?;
        let mut part = self.part(&entry.value.shape, &entry.value.instance)?;
        for light in &entry.value.light {
            part.lights.push(light.build(self)?);
        }
        self.open.pop();
        self.groups.insert(index, part.clone());
        Ok(part)
    }

    /// The content of a file, read once, its lists appended to the scene's.
    fn file_part(&mut self, file: &At<String>) -> Result<Part, Fault> {
        let plain = files::plain(&file.value);
        if let Some(part) = self.parts.get(&plain) {
            return Ok(part.clone());
        }
        let path = self.folder.resolve(&file.value, "").map_err(|e| Fault::of_file(&file.at, e))?;
        let content = load::read_model(&path, self.options).map_err(|mut e| {
            e.message = match e.place.as_str() {
                "" => format!("`{}`: {}", file.value, e.message),
                place => format!("`{}`, {place}: {}", file.value, e.message),
            };
            e.place.clear();
            Fault::of_file(&file.at, e)
        })?;
        let before = self.scene.notes.len();
        let (objects, lights) = place::append(&mut self.scene, content);
        for note in &mut self.scene.notes[before..] {
            *note = format!("{}: {note}", file.value);
        }
        let part = Part { objects, lights };
        self.parts.insert(plain, part.clone());
        Ok(part)
    }

    /// The number of a material.
    fn material(&self, name: &At<String>) -> Result<usize, Fault> {
        find(&self.file.material, "material", name)
    }

    /// The material of shapes that only emit.
    fn absorbing_material(&mut self) -> usize {
        *self.absorb.get_or_insert_with(|| {
            self.scene.materials.push(Material::new("", Model::Absorb));
            self.scene.materials.len() - 1
        })
    }

    /// The scattering model of a material, for mixtures.
    pub(super) fn model(&mut self, name: &At<String>) -> Result<Model, Fault> {
        let index = self.material(name)?;
        let entry = &self.file.material.0[index];
        if entry.value.is_more_than_a_model() {
            let message =
                format!("`{}` has an emission, opacity or normal map, which a mixture cannot honour", entry.name);
            return Err(Fault::new(&name.at, message));
        }
        if entry.value.kind.interior()? != Interior::default() {
            let message =
                format!("`{}` has an absorption, priority or dispersion, which a mixture cannot honour", entry.name);
            return Err(Fault::new(&name.at, message));
        }
        self.enter("material", index, &entry.name, &name.at)?;
        let model = entry.value.kind.build(&entry.at, self);
        self.open.pop();
        model
    }

    /// Notes that a group or a mixture is being built; refuses cycles, and nesting that would exhaust the stack.
    fn enter(&mut self, kind: &'static str, index: usize, name: &str, at: &Range<usize>) -> Result<(), Fault> {
        if self.open.contains(&(kind, index)) {
            return Err(Fault::new(at, format!("the {kind} `{name}` contains itself")));
        }
        if self.open.len() >= 64 {
            return Err(Fault::new(at, format!("the {kind} `{name}` is nested more than 64 deep")));
        }
        self.open.push((kind, index));
        Ok(())
    }

    /// A use of a texture.
    pub(super) fn texture(&mut self, name: &At<String>, uv_set: u32, as_color: bool) -> Result<TextureRef, Fault> {
        if uv_set > 1 {
            return Err(Fault::new(&name.at, format!("`uv_set` is {uv_set}, expected 0 or 1")));
        }
        let index = find(&self.file.texture, "texture", name)?;
        let texture = self.texture_number(index, as_color)?;
        let transform = self.file.texture.0[index].value.uv_transform();
        Ok(TextureRef { texture, uv_set: uv_set as usize, transform })
    }

    fn texture_number(&mut self, index: usize, as_color: bool) -> Result<usize, Fault> {
        if let Some(number) = self.textures.get(&(index, as_color)) {
            return Ok(*number);
        }
        let texture = self.file.texture.0[index].value.build(as_color, self)?;
        let number = self.scene.textures.len();
        self.scene.textures.push(texture);
        self.textures.insert((index, as_color), number);
        Ok(number)
    }

    /// An image file, decoded once.
    pub(super) fn image(&mut self, file: &At<String>) -> Result<usize, Fault> {
        let plain = files::plain(&file.value);
        if let Some(number) = self.images.get(&plain) {
            return Ok(*number);
        }
        let image = self.decode(file)?;
        let number = self.scene.images.len();
        self.scene.images.push(image.into());
        self.images.insert(plain, number);
        Ok(number)
    }

    /// The image of an environment: linear, and nowhere negative.
    pub(super) fn environment_image(&mut self, file: &At<String>) -> Result<usize, Fault> {
        let mut image = self.decode(file)?;
        let (width, height) = (image.size[0], image.size[1]);
        if width != 2 * height {
            self.scene.notes.push(format!(
                "{}: {width} × {height} pixels are stretched over 360° × 180° (expected twice as wide as high)",
                file.value
            ));
        }
        image.pixels = image_file::srgb_to_linear(image.pixels);
        let cleared = image_file::clear_negatives(&mut image);
        if cleared > 0 {
            self.scene.notes.push(format!("{}: {cleared} pixels had negative values, now 0", file.value));
        }
        self.scene.images.push(image.into());
        Ok(self.scene.images.len() - 1)
    }

    /// A light's measured profile, read once.
    pub(super) fn profile(&mut self, file: &At<String>) -> Result<Arc<ies::Profile>, Fault> {
        let plain = files::plain(&file.value);
        if let Some(profile) = self.profiles.get(&plain) {
            return Ok(profile.clone());
        }
        let bytes = self.folder.read(&file.value, "").map_err(|e| Fault::of_file(&file.at, e))?;
        // A tilt's file stands beside the profile.
        let folder = plain.rfind('/').map_or("", |end| &plain[..=end]);
        let beside = |name: &str| self.folder.read(&format!("{folder}{name}"), "").map_err(|e| e.message);
        let profile = ies::parse_beside(&bytes, &beside);
        let profile = profile.map_err(|e| Fault::new(&file.at, format!("`{}`, {e}", file.value)))?;
        let profile = Arc::new(profile);
        self.profiles.insert(plain, profile.clone());
        Ok(profile)
    }

    fn decode(&self, file: &At<String>) -> Result<Image, Fault> {
        let bytes = self.folder.read(&file.value, "").map_err(|e| Fault::of_file(&file.at, e))?;
        let wrong = |message| Fault::new(&file.at, format!("`{}` {message}", file.value));
        let image = image_file::decode(&file.value, &bytes).map_err(wrong)?;
        self.pixels.read(bytes.len());
        self.pixels.pay(image.pixels.memory()).map_err(|message| wrong(format!("is one too many: {message}")))?;
        Ok(image)
    }

    /// A mesh that keeps what readers guarantee.
    pub(super) fn checked(&mut self, name: &str, at: &Range<usize>, mesh: Mesh) -> Result<Mesh, Fault> {
        let (mesh, dropped) = mesh_check::checked(mesh).map_err(|message| Fault::new(at, message))?;
        if mesh.indices.is_empty() {
            return Err(Fault::new(at, "has no triangle with an area"));
        }
        if dropped > 0 {
            let name = if name.is_empty() { "a mesh" } else { name };
            self.scene.notes.push(format!("{name}: {dropped} triangles without area were left out"));
        }
        Ok(mesh)
    }
}

impl Part {
    /// Adds another part, moved by `to_parent`.
    fn add(
        &mut self,
        other: &Self,
        to_parent: Mat4,
        material: Option<usize>,
        name: Option<&str>,
        at: &Range<usize>,
        placed: &mut usize,
    ) -> Result<(), Fault> {
        let name_length = name.map_or(0, str::len);
        let size = |o: &Object| std::mem::size_of::<Object>() + o.name.len() + name_length;
        *placed += other.objects.iter().map(size).sum::<usize>();
        *placed += other.lights.len() * std::mem::size_of::<Light>();
        if *placed > MAX_PLACED {
            return Err(Fault::new(at, format!("the instances would take more than {} MiB", MAX_PLACED >> 20)));
        }
        for object in &other.objects {
            let to_world = super::place::invertible(at, to_parent * object.to_world)?;
            let name = match (name, object.name.as_str()) {
                (Some(outer), "") => outer.into(),
                (Some(outer), inner) => format!("{outer}/{inner}"),
                (None, inner) => inner.into(),
            };
            let material = material.unwrap_or(object.material);
            self.objects.push(Object { name, to_world, material, ..object.clone() });
        }
        self.lights.extend(other.lights.iter().map(|light| place::moved(light, to_parent)));
        Ok(())
    }
}

/// The number of a named table.
fn find<T>(named: &Named<T>, kind: &str, name: &At<String>) -> Result<usize, Fault> {
    named.0.iter().position(|e: &Entry<T>| e.name == name.value).ok_or_else(|| {
        let hint = suggest(&name.value, named.0.iter().map(|e| e.name.as_str()));
        Fault::new(&name.at, format!("unknown {kind} `{}`; {hint}", name.value))
    })
}
