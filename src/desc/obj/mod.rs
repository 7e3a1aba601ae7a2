//! Wavefront OBJ with its material libraries (Wavefront Technologies 1995, appendices B1 and B2).
//!
//! Polygons become fans of triangles. Corners without a normal are shaded flat. Texture coordinates count v upwards and
//! are turned, since v grows downwards here. Lines, points and free-form surfaces are left out, which a note says.

mod mtl;

use super::files::{self, Folder};
use super::image_file::Grant;
use super::{Error, Material, Mesh, Model, Object, Scene, Shape, mesh_check};
use glam::{Vec2, Vec3, Vec4};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::Path;

/// Reads an OBJ file, its material libraries and their textures.
pub fn read(path: &Path) -> Result<Scene, Error> {
    let bytes = files::read(path)?;
    parse(&String::from_utf8_lossy(&bytes), path)
}

/// The scene that `text` describes. Libraries and textures are looked for in the folder of `path`; errors name `path`
/// and the line.
pub fn parse(text: &str, path: &Path) -> Result<Scene, Error> {
    let mut reader = Reader::new(path);
    let mut joined = String::new();
    for (i, line) in text.lines().enumerate() {
        // A backslash at the end joins lines.
        let line = line.trim_end();
        if let Some(start) = line.strip_suffix('\\') {
            joined.push_str(start);
            joined.push(' ');
            continue;
        }
        joined.push_str(line);
        reader.line(&joined).map_err(|e| match e {
            Fault::Here(message) => Error::invalid(path, (i + 1).to_string(), message),
            Fault::Elsewhere(e) => e,
        })?;
        joined.clear();
    }
    reader.finish()
}

/// What is wrong: with the line that is read, or with another file.
enum Fault {
    Here(String),
    Elsewhere(Error),
}

impl From<String> for Fault {
    fn from(message: String) -> Self {
        Self::Here(message)
    }
}

/// One corner of a face: numbers of its position, texture coordinates and normal. A corner without normal is not
/// shared with other faces, whose number it has in its place.
type Corner = (u32, Option<u32>, Result<u32, u32>);

/// A file being read.
struct Reader<'a> {
    path: &'a Path,
    scene: Scene,
    positions: Vec<Vec3>,
    colors: Vec<Vec3>,
    uv: Vec<Vec2>,
    normals: Vec<Vec3>,
    materials: HashMap<String, usize>,
    /// Material libraries that were read, by name.
    libraries: HashSet<String>,
    /// What their images may take.
    pixels: Grant,
    /// Grey, for faces without a known material.
    default_material: Option<usize>,
    unknown_materials: BTreeSet<String>,
    name: String,
    material: Option<usize>,
    faces: u32,
    /// The mesh so far, and which of its vertices a corner is.
    mesh: Mesh,
    corners: HashMap<Corner, u32>,
    left_out: usize,
    dropped: usize,
}

impl<'a> Reader<'a> {
    fn new(path: &'a Path) -> Self {
        let name = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        Self {
            path,
            scene: Scene { name, source: Some(path.into()), ..Scene::default() },
            positions: Vec::new(),
            colors: Vec::new(),
            uv: Vec::new(),
            normals: Vec::new(),
            materials: HashMap::new(),
            libraries: HashSet::new(),
            pixels: Grant::default(),
            default_material: None,
            unknown_materials: BTreeSet::new(),
            name: String::new(),
            material: None,
            faces: 0,
            mesh: Mesh::default(),
            corners: HashMap::new(),
            left_out: 0,
            dropped: 0,
        }
    }

    /// Reads one line.
    fn line(&mut self, line: &str) -> Result<(), Fault> {
        let line = line.split('#').next().unwrap_or("").trim();
        let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        match word {
            "v" => self.position(rest)?,
            "vt" => {
                let n = numbers(rest, 1..=3)?;
                self.uv.push(Vec2::new(n[0], 1.0 - n.get(1).unwrap_or(&0.0)));
            }
            "vn" => self.normals.push(Vec3::from_slice(&numbers(rest, 3..=3)?)),
            "f" => self.face(rest)?,
            "o" | "g" => {
                self.end_mesh().map_err(Fault::Elsewhere)?;
                self.name = name(rest)?;
            }
            "usemtl" => {
                self.end_mesh().map_err(Fault::Elsewhere)?;
                let name = rest.trim();
                self.material = self.materials.get(name).copied();
                if self.material.is_none() {
                    self.unknown_materials.insert(name.into());
                }
            }
            "mtllib" => self.material_library(rest.trim())?,
            "l" | "p" | "curv" | "curv2" | "surf" => self.left_out += 1,
            _ => {}
        }
        Ok(())
    }

    /// `v x y z [w]` or `v x y z r g b`.
    fn position(&mut self, rest: &str) -> Result<(), Fault> {
        let n = numbers(rest, 3..=7)?;
        self.positions.push(Vec3::from_slice(&n[..3]));
        let color = if n.len() >= 6 { Vec3::from_slice(&n[n.len() - 3..]) } else { Vec3::ONE };
        if color != Vec3::ONE || !self.colors.is_empty() {
            self.colors.resize(self.positions.len() - 1, Vec3::ONE);
            self.colors.push(color);
        }
        Ok(())
    }

    /// `f a/ta/na b/tb/nb c/tc/nc …`: a fan.
    fn face(&mut self, rest: &str) -> Result<(), Fault> {
        let mut fan: Option<(u32, u32)> = None;
        let mut corners = 0;
        for word in rest.split_whitespace() {
            let corner = self.corner(word)?;
            let vertex = self.vertex(corner);
            fan = match fan {
                None => Some((vertex, vertex)),
                Some((first, _)) if corners == 1 => Some((first, vertex)),
                Some((first, last)) => {
                    self.mesh.indices.push([first, last, vertex]);
                    Some((first, vertex))
                }
            };
            corners += 1;
        }
        if corners < 3 {
            return Err(Fault::Here(format!("a face has {corners} corners, expected at least 3")));
        }
        self.faces += 1;
        Ok(())
    }

    /// `12`, `12/3`, `12//7`, `12/3/7`, from 1, or negative from the end.
    fn corner(&self, word: &str) -> Result<Corner, String> {
        let mut parts = word.split('/');
        let mut index = |what: &str, count: usize| -> Result<Option<u32>, String> {
            let Some(text) = parts.next().filter(|t| !t.is_empty()) else { return Ok(None) };
            let number: i64 =
                text.parse().map_err(|_| format!("`{word}` is not a corner; expected v, v/t, v//n or v/t/n"))?;
            let from_zero = if number < 0 { number + count as i64 } else { number - 1 };
            match u32::try_from(from_zero) {
                Ok(i) if (i as usize) < count => Ok(Some(i)),
                _ => Err(format!("`{word}` names {what} {number}; there are {count} so far, numbered from 1")),
            }
        };
        let position = index("vertex", self.positions.len())?;
        let position = position.ok_or_else(|| format!("`{word}` is not a corner; expected v, v/t, v//n or v/t/n"))?;
        let uv = index("texture coordinate", self.uv.len())?;
        let normal = index("normal", self.normals.len())?;
        Ok((position, uv, normal.ok_or(if self.normals.is_empty() { 0 } else { self.faces })))
    }

    /// The vertex of the mesh that a corner is.
    fn vertex(&mut self, corner: Corner) -> u32 {
        *self.corners.entry(corner).or_insert_with(|| {
            let (position, uv, normal) = corner;
            let mesh = &mut self.mesh;
            mesh.positions.push(self.positions[position as usize]);
            mesh.uv[0].push(uv.map_or(Vec2::ZERO, |i| self.uv[i as usize]));
            mesh.normals.push(normal.map_or(Vec3::ZERO, |i| self.normals[i as usize]));
            let color = self.colors.get(position as usize).copied().unwrap_or(Vec3::ONE);
            mesh.colors.push(color.extend(1.0));
            mesh.positions.len() as u32 - 1
        })
    }

    /// Closes the mesh of one name and material.
    fn end_mesh(&mut self) -> Result<(), Error> {
        let mut mesh = std::mem::take(&mut self.mesh);
        let corners = std::mem::take(&mut self.corners);
        if mesh.indices.is_empty() {
            return Ok(());
        }
        // Lists that say nothing are left empty.
        if corners.keys().all(|(_, _, normal)| normal.is_err()) {
            mesh.normals.clear();
        }
        if corners.keys().all(|(_, uv, _)| uv.is_none()) {
            mesh.uv[0].clear();
        }
        if mesh.colors.iter().all(|c| *c == Vec4::ONE) {
            mesh.colors.clear();
        }
        let (mesh, dropped) = mesh_check::checked(mesh).map_err(|message| {
            let place = if self.name.is_empty() { String::new() } else { format!("`{}`: ", self.name) };
            Error::invalid(self.path, "", format!("{place}{message}"))
        })?;
        self.dropped += dropped;
        if mesh.indices.is_empty() {
            return Ok(());
        }
        let material = match self.material {
            Some(index) => index,
            None => *self.default_material.get_or_insert_with(|| {
                let reflectance = super::ColorParam { vertex_color: true, ..super::ColorParam::constant([0.5; 3]) };
                self.scene.materials.push(Material::new("default", Model::Diffuse { reflectance }));
                self.scene.materials.len() - 1
            }),
        };
        self.scene.shapes.push(Shape::Mesh(mesh.into()));
        self.scene
            .objects
            .push(Object { name: self.name.clone(), ..Object::new(self.scene.shapes.len() - 1, material) });
        Ok(())
    }

    /// `mtllib a.mtl`. OBJ files often travel without it, so that a missing library is a note.
    fn material_library(&mut self, name: &str) -> Result<(), Fault> {
        let name = files::plain(&name.replace('\\', "/"));
        if !self.libraries.insert(name.clone()) {
            return Ok(());
        }
        let folder = Folder::of(self.path);
        let path = match folder.resolve(&name, "") {
            Ok(path) => path,
            Err(e) if e.kind == super::ErrorKind::Missing => {
                self.scene.notes.push(format!("the material library `{name}` is missing"));
                return Ok(());
            }
            Err(e) => return Err(Fault::Here(e.message)),
        };
        let text = files::read(&path).map_err(Fault::Elsewhere)?;
        let text = String::from_utf8_lossy(&text);
        let library = mtl::parse(&text, &path, &folder, &self.pixels, &mut self.scene).map_err(Fault::Elsewhere)?;
        for (name, material) in library {
            self.scene.materials.push(material);
            self.materials.insert(name, self.scene.materials.len() - 1);
        }
        Ok(())
    }

    /// The scene, with what was left out in its notes.
    fn finish(mut self) -> Result<Scene, Error> {
        self.end_mesh()?;
        if self.scene.objects.is_empty() {
            return Err(Error::invalid(self.path, "", "has no face with an area"));
        }
        if self.default_material.is_some() {
            let names: Vec<_> = self.unknown_materials.into_iter().collect();
            let which = if names.is_empty() { String::new() } else { format!(" ({} unknown)", names.join(", ")) };
            self.scene.notes.push(format!("faces without a material are grey{which}"));
        }
        if self.left_out > 0 {
            self.scene.notes.push(format!("{} lines, points or curves were left out", self.left_out));
        }
        if self.dropped > 0 {
            self.scene.notes.push(format!("{} triangles without area were left out", self.dropped));
        }
        Ok(self.scene)
    }
}

/// A name of an object, which each of its meshes will have.
fn name(text: &str) -> Result<String, String> {
    const MOST: usize = 4096;
    let name = text.trim();
    if name.len() > MOST {
        return Err(format!("found a name of {} bytes, expected at most {MOST}", name.len()));
    }
    Ok(name.into())
}

/// Finite numbers, as many as `count` says.
fn numbers(text: &str, count: std::ops::RangeInclusive<usize>) -> Result<Vec<f32>, String> {
    let number = |word: &str| match word.parse::<f32>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err(format!("found `{word}`, expected a finite number")),
    };
    let numbers: Vec<f32> = text.split_whitespace().map(number).collect::<Result<_, _>>()?;
    if count.contains(&numbers.len()) {
        return Ok(numbers);
    }
    let expected = match (count.start(), count.end()) {
        (a, b) if a == b => a.to_string(),
        (a, b) => format!("{a} to {b}"),
    };
    Err(format!("found {} numbers, expected {expected}", numbers.len()))
}
