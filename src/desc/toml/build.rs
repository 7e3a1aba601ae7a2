//! From the tables to the scene: names become indices, files are read, groups are placed.

use super::budget::Budget;
use super::keys::Named;
use super::lookup::Lookup;
use super::read::{At, Fault, suggest};
use super::scene::{InstanceTable, SceneFile};
use super::shape::{ShapeKind, ShapeTable};
use crate::desc::files::Folder;
use crate::desc::{Emission, Interior, Light, Material, Mesh, MetallicRoughness, Model};
use crate::desc::{Object, Options, Scene, Shape, TextureRef};
use crate::desc::{ies, image_file, mesh_check, place};
use glam::Mat4;
use std::collections::HashMap;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// A scene under construction.
pub(super) struct Builder<'a> {
    pub(super) file: &'a SceneFile,
    pub(super) folder: Folder,
    pub(super) options: &'a Options,
    /// What there is so far.
    pub(super) scene: Scene,
    /// Images by their file.
    pub(super) images: HashMap<PathBuf, usize>,
    /// Light profiles by their file.
    pub(super) profiles: HashMap<PathBuf, Arc<ies::Profile>>,
    /// Texture by its number in the file and whether it is used as a colour.
    textures: HashMap<(usize, bool), usize>,
    /// Meshes by their file.
    pub(super) meshes: HashMap<PathBuf, Arc<Mesh>>,
    /// The content of files by their path.
    pub(super) parts: HashMap<PathBuf, Part>,
    groups: HashMap<usize, Part>,
    /// Groups and mixtures being built, to find cycles.
    open: Vec<(&'static str, usize)>,
    /// How many mixtures are being built, one in another.
    mixtures: usize,
    /// Where shared geometry stands in the space of its shape.
    geometry: Vec<Mat4>,
    pub(super) named_profiles: Vec<Arc<ies::Profile>>,
    /// The material of shapes that only emit.
    absorb: Option<usize>,
    pub(super) placed: Budget,
    mixed: Budget,
    /// What images may take.
    pub(super) pixels: image_file::Grant,
}

/// Objects and lights that stand together.
#[derive(Clone, Debug, Default)]
pub(super) struct Part {
    /// Shapes, placed.
    pub(super) objects: Vec<Object>,
    /// Lights without a surface, placed.
    pub(super) lights: Vec<Light>,
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
            meshes: HashMap::new(),
            textures: HashMap::new(),
            parts: HashMap::new(),
            groups: HashMap::new(),
            open: Vec::new(),
            mixtures: 0,
            geometry: Vec::new(),
            named_profiles: Vec::new(),
            absorb: None,
            placed: Budget::of_instances(),
            mixed: Budget::of_mixtures(),
            pixels: image_file::Grant::default(),
        }
    }

    /// The scene.
    pub(super) fn build(mut self) -> Result<Scene, Fault> {
        let file = self.file;
        self.scene.name = file.name.clone().unwrap_or_default();
        self.scene.cameras = file.camera.0.iter().map(|c| c.value.build(&c.at)).collect::<Result<_, _>>()?;
        self.scene.render = file.render.as_ref().map(|r| r.build()).unwrap_or_default();
        self.scene.expect = file.expect.0.iter().map(|e| e.value.build(&e.at)).collect::<Result<_, _>>()?;

        // What has a name of its own keeps its number.
        for entry in &file.image.entries {
            let image = entry.value.build(&entry.name, &mut self)?;
            self.scene.images.push(image);
        }
        for (index, entry) in file.texture.entries.iter().enumerate() {
            if entry.value.is_settled() {
                self.texture_number(index, true)?;
            }
        }
        for entry in &file.geometry.entries {
            let Some((shape, local)) = entry.value.build(&entry.name, &entry.table, &mut self)? else {
                return Err(Fault::new(&entry.table, "expected geometry of another type than `file` and `geometry`"));
            };
            self.scene.shapes.push(shape);
            self.geometry.push(local);
        }
        for entry in &file.profile.entries {
            self.named_profiles.push(entry.value.build(&entry.table)?.into());
        }

        // Materials keep their number; textures are made as materials ask for them, and those that none uses are
        // made too, so that their errors do not wait for their first use.
        for entry in &file.material.entries {
            let material = entry.value.build(&entry.name, &entry.at, &mut self)?;
            self.scene.materials.push(material);
        }
        for index in 0..file.texture.entries.len() {
            if !self.textures.contains_key(&(index, false)) {
                self.texture_number(index, true)?;
            }
        }

        let mut all = self.part(&file.shape, &file.instance)?;
        for light in &file.light {
            all.lights.push(light.build(&mut self)?);
        }
        // Groups that no instance places are built all the same: their errors count.
        for (index, entry) in file.group.entries.iter().enumerate() {
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
            self.placed.pay(self.lamps(&group, material), &instance.group.at)?;
            part.add(&group, to_parent, material, Some(name), &instance.group.at, &mut self.placed)?;
        }
        Ok(part)
    }

    /// Adds one shape, or what its file has.
    fn shape(&mut self, shape: &'a ShapeTable, at: &Range<usize>, part: &mut Part) -> Result<(), Fault> {
        let ShapeTable { name, material, emission, emission_sides: sides, emission_coat, .. } = shape;
        let ShapeTable { reversed, closed, place, kind, .. } = shape;
        let to_parent = place.matrix(at)?;
        let material = material.as_ref().map(|m| self.material(m)).transpose()?;
        let emission = match emission {
            None => None,
            Some(radiance) => {
                let coat = emission_coat.as_ref().map(|coat| coat.build(self)).transpose()?;
                Some(Emission { radiance: radiance.build(self)?, sides: *sides, coat })
            }
        };

        if let ShapeKind::FileShape(f) = kind {
            let mut content = self.file_part(&f.file)?;
            for object in &mut content.objects {
                object.emission = emission.or(object.emission);
                object.reversed ^= reversed;
                object.closed |= closed;
            }
            let name = (!name.is_empty()).then_some(name.as_str());
            self.placed.pay(self.lamps(&content, material), &f.file.at)?;
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
        let (number, local) = match kind {
            ShapeKind::SharedShape(shared) => {
                let number = find(&self.file.geometry, "geometry", &shared.geometry)?;
                (number, self.geometry[number])
            }
            _ => {
                let Some((geometry, local)) = kind.build(name, at, self)? else { return Ok(()) };
                self.scene.shapes.push(geometry);
                (self.scene.shapes.len() - 1, local)
            }
        };
        part.objects.push(Object {
            name: name.clone(),
            shape: number,
            to_world: if local == Mat4::IDENTITY { to_parent } else { to_parent * local },
            material,
            emission,
            reversed: *reversed,
            closed: *closed,
        });
        Ok(())
    }

    /// Memory of the emitting triangles of a part: each place of such a mesh is as many lights.
    fn lamps(&self, part: &Part, material: Option<usize>) -> usize {
        const LIGHT: usize = 128;
        let emits = |object: &&Object| {
            let worn = self.scene.materials.get(material.unwrap_or(object.material));
            object.emission.is_some() || worn.is_some_and(|m| m.emission.is_some())
        };
        let lights = |object: &Object| match &self.scene.shapes[object.shape] {
            Shape::Mesh(mesh) => LIGHT * mesh.indices.len(),
            _ => LIGHT,
        };
        part.objects.iter().filter(emits).map(lights).sum()
    }

    /// The content of a group, built once.
    fn group(&mut self, index: usize, at: &Range<usize>) -> Result<Part, Fault> {
        if let Some(part) = self.groups.get(&index) {
            return Ok(part.clone());
        }
        let entry = &self.file.group.entries[index];
        self.enter("group", index, &entry.name, at)?;
        let mut part = self.part(&entry.value.shape, &entry.value.instance)?;
        for light in &entry.value.light {
            part.lights.push(light.build(self)?);
        }
        self.open.pop();
        self.groups.insert(index, part.clone());
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
        let entry = &self.file.material.entries[index];
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
        // Each part of a mixture has a copy of its model: mixtures of mixtures are trees, however few materials they name.
        self.mixed.pay(size_of::<Model>() + size_of::<MetallicRoughness>(), &name.at)?;
        self.enter("material", index, &entry.name, &name.at)?;
        let model = entry.value.kind.build(&entry.at, self);
        self.open.pop();
        model
    }

    /// Counts the mixtures that are being built. Written out one in another they must stay below what TOML parsers nest.
    pub(super) fn enter_mixture(&mut self, at: &Range<usize>) -> Result<(), Fault> {
        const DEEPEST: usize = 16;
        self.mixtures += 1;
        if self.mixtures > DEEPEST {
            return Err(Fault::new(at, format!("mixtures are nested more than {DEEPEST} deep")));
        }
        Ok(())
    }

    /// The end of [`Self::enter_mixture`].
    pub(super) fn leave_mixture(&mut self) {
        self.mixtures -= 1;
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
    pub(super) fn texture(&mut self, name: &At<String>, lookup: &Lookup, as_color: bool) -> Result<TextureRef, Fault> {
        let uv_set = lookup.uv_set;
        if uv_set > 1 {
            return Err(Fault::new(&name.at, format!("`uv_set` is {uv_set}, expected 0 or 1")));
        }
        let index = find(&self.file.texture, "texture", name)?;
        let texture = self.texture_number(index, as_color)?;
        let transform = lookup.transform(self.file.texture.entries[index].value.uv_transform());
        Ok(TextureRef { texture, uv_set: uv_set as usize, transform })
    }

    fn texture_number(&mut self, index: usize, as_color: bool) -> Result<usize, Fault> {
        let entry = &self.file.texture.entries[index];
        let as_color = as_color || entry.value.is_settled();
        if let Some(number) = self.textures.get(&(index, as_color)) {
            return Ok(*number);
        }
        let texture = entry.value.build(as_color, &entry.table, self)?;
        let number = self.scene.textures.len();
        self.scene.textures.push(texture);
        self.textures.insert((index, as_color), number);
        Ok(number)
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
        placed: &mut Budget,
    ) -> Result<(), Fault> {
        let name_length = name.map_or(0, str::len);
        let size = |o: &Object| size_of::<Object>() + o.name.len() + name_length;
        let objects: usize = other.objects.iter().map(size).sum();
        placed.pay(objects + size_of_val(&other.lights[..]), at)?;
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
pub(super) fn find<T>(named: &Named<T>, kind: &str, name: &At<String>) -> Result<usize, Fault> {
    named.number(&name.value).ok_or_else(|| {
        let hint = suggest(&name.value, named.entries.iter().map(|e| e.name.as_str()));
        Fault::new(&name.at, format!("unknown {kind} `{}`; {hint}", name.value))
    })
}
