//! What a scene file refers to: models, images, profiles. Each is read once, whatever it is called.

use super::build::{Builder, Part, find};
use super::read::{At, Fault};
use crate::desc::{Image, Mesh, Pixels, Shape, ies, image_file, load, place, ply};
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl Builder<'_> {
    /// The content of a file, read once, its lists appended to the scene's.
    pub(super) fn file_part(&mut self, file: &At<String>) -> Result<Part, Fault> {
        let key = self.key(file)?;
        if let Some(part) = self.parts.get(&key) {
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
        self.parts.insert(key, part.clone());
        Ok(part)
    }

    /// An image file, decoded once.
    pub(super) fn image(&mut self, file: &At<String>) -> Result<usize, Fault> {
        let key = self.key(file)?;
        if let Some(number) = self.images.get(&key) {
            return Ok(*number);
        }
        let image = self.decode(file)?;
        let number = self.scene.images.len();
        self.scene.images.push(image.into());
        self.images.insert(key, number);
        Ok(number)
    }

    /// The image of a table of its own: shared with the others of the same file, unless it has another name.
    pub(super) fn image_of(&mut self, file: &At<String>, name: Option<&str>) -> Result<Arc<Image>, Fault> {
        let key = self.key(file)?;
        let mut image = match self.images.get(&key) {
            Some(number) => self.scene.images[*number].clone(),
            None => {
                // Its number will be the next one.
                self.images.insert(key, self.scene.images.len());
                self.decode(file)?.into()
            }
        };
        if let Some(name) = name.filter(|name| **name != image.name) {
            if Arc::strong_count(&image) > 1 {
                self.pixels(&image, file)?;
            }
            Arc::make_mut(&mut image).name = name.into();
        }
        Ok(image)
    }

    /// The image of an environment: linear, and nowhere negative.
    pub(super) fn environment_file(&mut self, file: &At<String>) -> Result<usize, Fault> {
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

    /// The image of an environment that has a name: itself, where it is linear and nowhere negative.
    pub(super) fn environment_image(&mut self, name: &At<String>) -> Result<usize, Fault> {
        let number = self.named_image(name)?;
        let image = &self.scene.images[number];
        if let Pixels::Rgba32F(pixels) = &image.pixels
            && pixels.iter().flatten().all(|x| *x >= 0.0)
        {
            return Ok(number);
        }
        let mut image = Image::clone(image);
        image.pixels = image_file::srgb_to_linear(image.pixels);
        image_file::clear_negatives(&mut image);
        self.pixels(&image, name)?;
        self.scene.images.push(image.into());
        Ok(self.scene.images.len() - 1)
    }

    /// The number of an image by its name.
    pub(super) fn named_image(&mut self, name: &At<String>) -> Result<usize, Fault> {
        find(&self.file.image, "image", name)
    }

    /// A profile by its name.
    pub(super) fn named_profile(&mut self, name: &At<String>) -> Result<Arc<ies::Profile>, Fault> {
        find(&self.file.profile, "profile", name).map(|number| self.named_profiles[number].clone())
    }

    /// The mesh of a PLY file, read once. Others of the same file are placed, and so paid for.
    pub(super) fn mesh_file(&mut self, file: &At<String>) -> Result<Arc<Mesh>, Fault> {
        let key = self.key(file)?;
        if let Some(mesh) = self.meshes.get(&key) {
            self.placed.pay(mesh.memory(), &file.at)?;
            return Ok(mesh.clone());
        }
        let bytes = self.folder.read(&file.value, "").map_err(|e| Fault::of_file(&file.at, e))?;
        let content = ply::parse(&bytes, Path::new(&file.value)).map_err(|e| Fault::of_file(&file.at, e))?;
        let [Shape::Mesh(mesh)] = &content.shapes[..] else {
            return Err(Fault::new(&file.at, format!("`{}` is not one mesh", file.value)));
        };
        self.meshes.insert(key, mesh.clone());
        Ok(mesh.clone())
    }

    /// A light's measured profile, read once.
    pub(super) fn profile(&mut self, file: &At<String>) -> Result<Arc<ies::Profile>, Fault> {
        let key = self.key(file)?;
        if let Some(profile) = self.profiles.get(&key) {
            return Ok(profile.clone());
        }
        let bytes = self.folder.read(&file.value, "").map_err(|e| Fault::of_file(&file.at, e))?;
        // A tilt's file stands beside the profile.
        let folder = file.value.rfind('/').map_or("", |end| &file.value[..=end]);
        let beside = |name: &str| self.folder.read(&format!("{folder}{name}"), "").map_err(|e| e.message);
        let profile = ies::parse_beside(&bytes, &beside);
        let profile = profile.map_err(|e| Fault::new(&file.at, format!("`{}`, {e}", file.value)))?;
        let profile = Arc::new(profile);
        self.profiles.insert(key, profile.clone());
        Ok(profile)
    }

    fn decode(&mut self, file: &At<String>) -> Result<Image, Fault> {
        let bytes = self.folder.read(&file.value, "").map_err(|e| Fault::of_file(&file.at, e))?;
        let image = image_file::decode(&file.value, &bytes)
            .map_err(|message| Fault::new(&file.at, format!("`{}` {message}", file.value)))?;
        self.pixels.read(bytes.len());
        self.pixels(&image, file)?;
        Ok(image)
    }

    /// Pays for the pixels of an image.
    fn pixels(&self, image: &Image, name: &At<String>) -> Result<(), Fault> {
        let one_too_many = |message| Fault::new(&name.at, format!("`{}` is one too many: {message}", name.value));
        self.pixels.pay(image.pixels.memory()).map_err(one_too_many)
    }

    /// What a file is known by, whichever way its name is spelt: `a.png` and `./a.png` are decoded once.
    fn key(&self, file: &At<String>) -> Result<PathBuf, Fault> {
        self.folder.identity(&file.value, "").map_err(|e| Fault::of_file(&file.at, e))
    }
}
