//! The folder beside the scene file: meshes and images, each written once, and what has to be noted.

use super::mesh::{self, Variant};
use super::picture::{Format, Picture};
use super::value::{Pattern, Scalar};
use super::{ExportError, Target, Written, tessellate};
use crate::desc::{Scene, Shape};
use crate::film::exr::write_exr;
use crate::film::file::{check_writable, write_atomic};
use std::borrow::Cow;
use std::collections::HashMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// What an export has written so far.
pub(super) struct Beside<'a> {
    pub(super) scene: &'a Scene,
    target: Target,
    folder: PathBuf,
    /// Its name, as the scene file says it.
    name: String,
    meshes: HashMap<Variant, String>,
    pictures: Vec<(Picture, String)>,
    notes: Vec<String>,
}

impl<'a> Beside<'a> {
    pub(super) fn new(scene: &'a Scene, path: &Path, target: Target) -> Self {
        // A folder of its own for each target: their images differ.
        let target_name = match target {
            Target::Mitsuba => "mitsuba",
            Target::Pbrt => "pbrt",
        };
        let name = format!("{}-{target_name}", path.file_stem().unwrap_or_default().to_string_lossy());
        let folder = path.with_file_name(&name);
        Self { scene, target, folder, name, meshes: HashMap::new(), pictures: Vec::new(), notes: Vec::new() }
    }

    /// Notes once what the target has otherwise.
    pub(super) fn note(&mut self, text: impl Into<String>) {
        let text = text.into();
        if !self.notes.contains(&text) {
            self.notes.push(text);
        }
    }

    pub(super) fn notes(&self) -> &[String] {
        &self.notes
    }

    pub(super) fn written(self) -> Written {
        Written { files: self.meshes.len() + self.pictures.len(), notes: self.notes }
    }

    /// The PLY file of a shape, by its path from the scene file.
    pub(super) fn mesh(&mut self, variant: Variant) -> Result<String, ExportError> {
        if let Some(name) = self.meshes.get(&variant) {
            return Ok(name.clone());
        }
        let mesh = match &self.scene.shapes[variant.shape] {
            Shape::Mesh(mesh) => Cow::Borrowed(&**mesh),
            shape => Cow::Owned(tessellate::mesh(shape)),
        };
        let bytes = mesh::ply(&mesh, &variant);
        let file = format!("mesh-{}.ply", self.meshes.len());
        self.write(&file, |path| write_atomic(path, |out| out.write_all(&bytes)))?;
        let name = format!("{}/{file}", self.name);
        self.meshes.insert(variant, name.clone());
        Ok(name)
    }

    /// The image file of a picture, by its path from the scene file, and whether its numbers are linear.
    pub(super) fn picture(&mut self, picture: Picture) -> Result<(String, bool), ExportError> {
        let linear = picture.is_linear(self.scene);
        if let Some((_, name)) = self.pictures.iter().find(|(known, _)| *known == picture) {
            return Ok((name.clone(), linear));
        }
        let stem = format!("image-{}", self.pictures.len());
        let file = match picture.encode(self.scene) {
            Format::Png(bytes) => {
                let file = format!("{stem}.png");
                self.write(&file, |path| write_atomic(path, |out| out.write_all(&bytes?)))?;
                file
            }
            Format::Exr(image) => {
                let file = format!("{stem}.exr");
                self.write(&file, |path| write_exr(path, &image))?;
                file
            }
        };
        let name = format!("{}/{file}", self.name);
        self.pictures.push((picture, name.clone()));
        Ok((name, linear))
    }

    /// The mean of a number over its texture.
    pub(super) fn mean(&self, scalar: &Scalar) -> f32 {
        match scalar {
            Scalar::Constant(x) => *x,
            Scalar::Texture(source) => match &source.pattern {
                Pattern::Checker { even, odd, .. } => 0.5 * (even + odd),
                Pattern::Image { file, .. } => {
                    let picture = self.pictures.iter().find(|(_, name)| name == file);
                    picture.map_or(0.0, |(picture, _)| picture.mean(self.scene))
                }
            },
        }
    }

    fn write(&self, file: &str, write: impl FnOnce(&Path) -> io::Result<()>) -> Result<(), ExportError> {
        let path = self.folder.join(file);
        let done = check_writable(&path).and_then(|()| write(&path));
        done.map_err(|e| ExportError::Output(path, e))
    }

    /// What it is written for.
    pub(super) fn target(&self) -> Target {
        self.target
    }
}
