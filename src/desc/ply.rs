//! PLY, the polygon format of Stanford (Turk 1994): ASCII and binary, triangles, quadrangles and other polygons.
//!
//! Read are the elements `vertex` (x y z, nx ny nz, u v or s t, red green blue alpha) and `face` (vertex_indices). Colours
//! of whole numbers are sRGB bytes, others are linear. Texture coordinates count v upwards and are turned. Our own files
//! have tangents too (tx ty tz tw), and two sets of texture coordinates that count v downwards (u0 v0, u1 v1).

use super::{ColorParam, Error, Material, Mesh, Model, Object, Scene, Shape, files, image_file, mesh_check};
use glam::{Vec2, Vec3, Vec4};
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{Property, PropertyAccess, PropertyAccessResult};
use std::path::Path;

/// Reads a PLY file.
pub fn read(path: &Path) -> Result<Scene, Error> {
    parse(&files::read(path)?, path)
}

/// The scene that the bytes of a PLY file describe: one mesh. Errors name `path` and, where there are lines, the line.
pub fn parse(bytes: &[u8], path: &Path) -> Result<Scene, Error> {
    let invalid = |message: String| Error::invalid(path, "", message);
    let (mesh, dropped) = mesh(bytes, path)?;
    let (mesh, degenerate) = mesh_check::checked(mesh).map_err(invalid)?;
    if mesh.indices.is_empty() {
        return Err(invalid("has no face with an area".into()));
    }

    let name = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let reflectance = ColorParam { vertex_color: true, ..ColorParam::constant([0.5; 3]) };
    let factor = if mesh.colors.is_empty() { reflectance.factor } else { [1.0; 3] };
    let material = Material::new("default", Model::Diffuse { reflectance: ColorParam { factor, ..reflectance } });
    let object = Object { name: name.clone(), ..Object::new(0, 0) };
    let mut scene = Scene { name, source: Some(path.into()), ..Scene::default() };
    scene.shapes.push(Shape::Mesh(mesh.into()));
    scene.objects.push(object);
    scene.materials.push(material);
    if degenerate > 0 {
        scene.notes.push(format!("{degenerate} triangles without area were left out"));
    }
    if dropped > 0 {
        scene.notes.push(format!("{dropped} faces of less than three corners were left out"));
    }
    Ok(scene)
}

/// The mesh of a file, and how many faces were no polygons.
fn mesh(bytes: &[u8], path: &Path) -> Result<(Mesh, usize), Error> {
    let failed = |e: ParseError| {
        // The parser quotes the line, and its own errors in each other; the innermost one and the place are enough.
        let message = e.to_string();
        let message = message.rsplit("Error: ").next().unwrap_or_default().replace(['\n', '\t'], " ");
        let message: String = message.chars().take(200).collect();
        Error::invalid(path, e.line().map(|l| l.to_string()).unwrap_or_default(), message)
    };
    let mut reader = Reader::new(bytes);
    let header = Parser::<Vertex>::new().read_header(&mut reader).map_err(failed)?;
    let (mut mesh, mut dropped) = (Mesh::default(), 0);
    for (name, element) in &header.elements {
        // Every element takes a byte at least, so that no count makes more work than the file has bytes.
        if element.count > bytes.len() || element.properties.is_empty() {
            let message = format!("announces {} elements `{name}` in {} bytes", element.count, bytes.len());
            return Err(Error::invalid(path, "", message));
        }
        let has = |key: &str| element.properties.contains_key(key);
        match name.as_str() {
            "vertex" => {
                let vertices = Parser::<Vertex>::new().read_payload_for_element(&mut reader, element, &header);
                let vertices = vertices.map_err(failed)?;
                mesh.positions = vertices.iter().map(|v| v.position).collect();
                if has("nx") && has("ny") && has("nz") {
                    mesh.normals = vertices.iter().map(|v| v.normal).collect();
                }
                if ["u", "s", "texture_u"].iter().any(|key| has(key)) {
                    mesh.uv[0] = vertices.iter().map(|v| Vec2::new(v.uv.x, 1.0 - v.uv.y)).collect();
                }
                if has("tx") && has("ty") && has("tz") && has("tw") {
                    mesh.tangents = vertices.iter().map(|v| v.tangent).collect();
                }
                for (set, [u, v]) in [["u0", "v0"], ["u1", "v1"]].into_iter().enumerate() {
                    if has(u) && has(v) {
                        mesh.uv[set] = vertices.iter().map(|v| v.uv_sets[set]).collect();
                    }
                }
                if has("red") && has("green") && has("blue") {
                    mesh.colors = vertices.iter().map(|v| v.color).collect();
                }
            }
            "face" => {
                let faces = Parser::<Face>::new().read_payload_for_element(&mut reader, element, &header);
                for Face(corners) in faces.map_err(failed)? {
                    dropped += usize::from(corners.len() < 3);
                    let fan = corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]);
                    mesh.indices.extend(fan);
                }
            }
            _ => {
                Parser::<Other>::new().read_payload_for_element(&mut reader, element, &header).map_err(failed)?;
            }
        }
    }
    if mesh.indices.is_empty() {
        return Err(Error::unsupported(path, "", "has no faces; point clouds are not honoured"));
    }
    Ok((mesh, dropped))
}

/// A vertex as its properties come in.
struct Vertex {
    position: Vec3,
    normal: Vec3,
    tangent: Vec4,
    uv: Vec2,
    uv_sets: [Vec2; 2],
    color: Vec4,
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        let (uv, uv_sets) = (Vec2::ZERO, [Vec2::ZERO; 2]);
        Self { position: Vec3::ZERO, normal: Vec3::ZERO, tangent: Vec4::X, uv, uv_sets, color: Vec4::ONE }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let target = match name {
            "x" => &mut self.position.x,
            "y" => &mut self.position.y,
            "z" => &mut self.position.z,
            "nx" => &mut self.normal.x,
            "ny" => &mut self.normal.y,
            "nz" => &mut self.normal.z,
            "tx" => &mut self.tangent.x,
            "ty" => &mut self.tangent.y,
            "tz" => &mut self.tangent.z,
            "tw" => &mut self.tangent.w,
            "u0" => &mut self.uv_sets[0].x,
            "v0" => &mut self.uv_sets[0].y,
            "u1" => &mut self.uv_sets[1].x,
            "v1" => &mut self.uv_sets[1].y,
            "u" | "s" | "texture_u" => &mut self.uv.x,
            "v" | "t" | "texture_v" => &mut self.uv.y,
            "red" => &mut self.color.x,
            "green" => &mut self.color.y,
            "blue" => &mut self.color.z,
            "alpha" => &mut self.color.w,
            _ => return PropertyAccessResult::Ignored,
        };
        let Some(value) = scalar(&property) else { return PropertyAccessResult::UnsupportedType };
        *target = match (name, &property) {
            ("red" | "green" | "blue", Property::UChar(byte)) => image_file::srgb8_to_linear([*byte, 0, 0, 0])[0],
            ("alpha", Property::UChar(byte)) => f32::from(*byte) / 255.0,
            _ => value,
        };
        PropertyAccessResult::Set
    }
}

/// A number of any type.
fn scalar(property: &Property) -> Option<f32> {
    Some(match property {
        Property::Char(x) => f32::from(*x),
        Property::UChar(x) => f32::from(*x),
        Property::Short(x) => f32::from(*x),
        Property::UShort(x) => f32::from(*x),
        Property::Int(x) => *x as f32,
        Property::UInt(x) => *x as f32,
        Property::Float(x) => *x,
        Property::Double(x) => *x as f32,
        _ => return None,
    })
}

/// The corners of a polygon. A negative number becomes one that no vertex has.
struct Face(Vec<u32>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !matches!(name, "vertex_indices" | "vertex_index") {
            return PropertyAccessResult::Ignored;
        }
        let index = |x: i64| u32::try_from(x).unwrap_or(u32::MAX);
        self.0 = match property {
            Property::ListChar(v) => v.into_iter().map(|x| index(x.into())).collect(),
            Property::ListUChar(v) => v.into_iter().map(u32::from).collect(),
            Property::ListShort(v) => v.into_iter().map(|x| index(x.into())).collect(),
            Property::ListUShort(v) => v.into_iter().map(u32::from).collect(),
            Property::ListInt(v) => v.into_iter().map(|x| index(x.into())).collect(),
            Property::ListUInt(v) => v,
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// An element that is not looked at.
struct Other;

impl PropertyAccess for Other {
    fn new() -> Self {
        Self
    }
}
