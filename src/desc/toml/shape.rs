//! `[[shape]]`: geometry, placed.

use super::build::Builder;
use super::color::{Radiance, Scalar};
use super::keys::{keys, one_of};
use super::number::{NonNegative, Positive};
use super::place::{Place, unit};
use super::read::{At, Fault, Node, Read};
use super::schema::Defs;
use super::write::{Write, array, pairs};
use crate::desc::{Mesh, Shape, Sides, primitives};
use crate::math::Frame;
use glam::{Mat4, Vec2, Vec3, Vec4};
use serde_json::{Value as Json, json};
use std::sync::Arc;

keys! {
    /// A shape with a material, somewhere.
    struct ShapeTable {
        /// Name for messages. Default: empty.
        name: String = String::new(),
        /// Name of the material. May be left out where the shape emits (then it reflects nothing) and for files (then they say).
        material: Option<At<String>>,
        /// Radiance that the shape emits in W/(sr m²), in place of its material's.
        emission: Option<Radiance>,
        /// Which side emits: "front" or "both". Default "front".
        emission_sides: Sides = Sides::Front,
        /// Share of the surface under a clear coat, which takes some of the emitted light, a number in [0, 1] or a texture. Default: none.
        emission_coat: Option<Scalar>,
        /// Turns the front to the other side. Default false.
        reversed: bool = false,
        /// Declares that the surface is closed, so that verification looks for holes and leaks. Default false.
        closed: bool = false,
        ..place: Place,
        ..kind: ShapeKind,
    }
}

one_of! {
    /// A shape with a material, somewhere.
    enum ShapeKind {
        "sphere" => SphereShape,
        "disk" => DiskShape,
        "cylinder" => CylinderShape,
        "quad" => QuadShape,
        "box" => BoxShape,
        "mesh" => MeshShape,
        "file" => FileShape,
        "geometry" => SharedShape,
    } default None
}

keys! {
    /// A sphere; its front is outside.
    struct SphereShape {
        /// Radius in metres. Default 1.
        radius: Positive = Positive(1.0),
        /// Centre [x, y, z] in metres. Default the origin.
        center: Vec3 = Vec3::ZERO,
    }
}

keys! {
    /// A disk; its front is where the normal points.
    struct DiskShape {
        /// Radius in metres. Default 1.
        radius: Positive = Positive(1.0),
        /// Centre [x, y, z] in metres. Default the origin.
        center: Vec3 = Vec3::ZERO,
        /// Direction of the front [x, y, z]. Default [0, 0, 1].
        normal: At<Vec3> = At { at: 0..0, value: Vec3::Z },
    }
}

keys! {
    /// An open cylinder; its front is outside.
    struct CylinderShape {
        /// Radius in metres. Default 1.
        radius: Positive = Positive(1.0),
        /// Middle of one end [x, y, z] in metres. Default the origin.
        from: Vec3 = Vec3::ZERO,
        /// Middle of the other end [x, y, z] in metres. Default [0, 0, 1].
        to: At<Vec3> = At { at: 0..0, value: Vec3::Z },
    }
}

keys! {
    /// A parallelogram (corner and two edges), or any four corners (two triangles).
    struct QuadShape {
        /// Corner [x, y, z] in metres; (u, v) = (0, 0).
        corner: Option<Vec3>,
        /// Edge from the corner along which u grows, [x, y, z] in metres.
        edge_u: Option<Vec3>,
        /// Edge from the corner along which v grows, [x, y, z] in metres. The front is where edge_u × edge_v points.
        edge_v: Option<Vec3>,
        /// The four corners, counter-clockwise as seen from the front, in place of the three keys above.
        vertices: Option<[Vec3; 4]>,
    }
}

keys! {
    /// A box along the axes; its front is outside.
    struct BoxShape {
        /// Lower corner [x, y, z] in metres.
        min: At<Vec3>,
        /// Upper corner [x, y, z] in metres.
        max: Vec3,
    }
}

keys! {
    /// Triangles; the front is where their corners run counter-clockwise.
    struct MeshShape {
        /// Vertices [[x, y, z], …] in metres.
        positions: Option<At<Vec<Vec3>>>,
        /// Triangles [[a, b, c], …], numbers of vertices from 0. Default: every three vertices are a triangle.
        indices: Option<At<Vec<[u32; 3]>>>,
        /// Shading normals [[x, y, z], …], one a vertex. Default: flat.
        normals: Vec<Vec3> = Vec::new(),
        /// Tangents [[x, y, z, w], …], one a vertex; w is 1, or −1 where the bitangent points the other way. Default: from the texture coordinates.
        tangents: Vec<Vec4> = Vec::new(),
        /// Texture coordinates [[u, v], …], one a vertex. Default: none.
        uv: Vec<Vec2> = Vec::new(),
        /// Texture coordinates of the second set, as `uv`. Default: none.
        second_uv: Vec<Vec2> = Vec::new(),
        /// Linear colours [[r, g, b], …] or with alpha [[r, g, b, a], …], one a vertex: factors on the material's reflectance and opacity. Default: none.
        colors: Vec<VertexColor> = Vec::new(),
        /// A .ply file with the whole mesh, below the scene's folder, in place of the keys above.
        file: Option<At<String>>,
    }
}

keys! {
    /// Everything in a .gltf, .glb, .obj or .ply file, except its cameras.
    struct FileShape {
        /// The file, below the scene's folder.
        file: At<String>,
    }
}

keys! {
    /// Geometry that several shapes share.
    struct SharedShape {
        /// Its name among `[geometry.NAME]`.
        geometry: At<String>,
    }
}

/// A vertex colour with or without alpha.
#[derive(Clone, Copy, Debug)]
pub(super) struct VertexColor(Vec4);

impl Read for VertexColor {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref().as_array().map(|a| a.len()) {
            Some(4) => <[NonNegative; 4]>::read(node).map(|c| Self(c.map(|x| x.0).into())),
            _ => <[NonNegative; 3]>::read(node).map(|[r, g, b]| Self(Vec4::new(r.0, g.0, b.0, 1.0))),
        }
    }
    fn one() -> String {
        <[NonNegative; 3]>::one()
    }
    fn many() -> String {
        <[NonNegative; 3]>::many()
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "anyOf": [<[NonNegative; 3]>::schema(defs), <[NonNegative; 4]>::schema(defs)] })
    }
}

impl Write for VertexColor {
    fn text(&self) -> String {
        let rgba = self.0.to_array().map(NonNegative);
        if self.0.w == 1.0 { array(&rgba[..3]) } else { array(&rgba) }
    }
}

impl ShapeKind {
    /// The geometry and where it stands in the object's space; `None` for files and what is shared.
    pub(super) fn build(
        &self,
        name: &str,
        at: &std::ops::Range<usize>,
        b: &mut Builder<'_>,
    ) -> Result<Option<(Shape, Mat4)>, Fault> {
        let placed = match self {
            Self::SphereShape(s) => (Shape::Sphere { radius: s.radius.0 }, Mat4::from_translation(s.center)),
            Self::DiskShape(s) => (Shape::Disk { radius: s.radius.0 }, along(s.center, unit(&s.normal)?)),
            Self::CylinderShape(s) => {
                let axis = s.to.value - s.from;
                let height = axis.as_dvec3().length() as f32;
                let to = if s.to.at.is_empty() { at } else { &s.to.at };
                // Normalised even where it is nearly of length 1, as the height is divided off.
                let direction = axis.as_dvec3().try_normalize().map(|d| d.as_vec3());
                let direction = direction.ok_or_else(|| Fault::new(to, "found [0, 0, 0], expected a direction"))?;
                (Shape::Cylinder { radius: s.radius.0, height }, along(s.from, direction))
            }
            Self::QuadShape(s) => (Shape::Mesh(b.checked(name, at, s.mesh(at)?)?.into()), Mat4::IDENTITY),
            Self::BoxShape(s) => {
                if !s.min.value.cmplt(s.max).all() {
                    return Err(Fault::new(&s.min.at, "`min` is not below `max` in every coordinate"));
                }
                (Shape::Mesh(b.checked(name, at, primitives::cuboid(s.min.value, s.max))?.into()), Mat4::IDENTITY)
            }
            Self::MeshShape(s) => {
                if let Some(file) = &s.file {
                    return Ok(Some((Shape::Mesh(s.mesh_of_file(file, b)?), Mat4::IDENTITY)));
                }
                let Some(positions) = &s.positions else {
                    return Err(Fault::new(at, format!("missing key `positions`; expected {}", Vec::<Vec3>::one())));
                };
                let at = s.indices.as_ref().map_or(&positions.at, |i| &i.at);
                (Shape::Mesh(b.checked(name, at, s.mesh(positions)?)?.into()), Mat4::IDENTITY)
            }
            Self::FileShape(_) | Self::SharedShape(_) => return Ok(None),
        };
        Ok(Some(placed))
    }
}

/// The rigid motion that takes the origin to `o` and z to the unit vector `z`.
fn along(o: Vec3, z: Vec3) -> Mat4 {
    let f = Frame::from_z(z);
    Mat4::from_cols(f.s.extend(0.0), f.t.extend(0.0), f.n.extend(0.0), o.extend(1.0))
}

impl QuadShape {
    fn mesh(&self, at: &std::ops::Range<usize>) -> Result<Mesh, Fault> {
        match (self.corner, self.edge_u, self.edge_v, &self.vertices) {
            (Some(corner), Some(u), Some(v), None) => Ok(primitives::quad(corner, u, v)),
            (None, None, None, Some(vertices)) => {
                let [p, a, _, b] = *vertices;
                Ok(Mesh { positions: vertices.to_vec(), ..primitives::quad(p, a - p, b - p) })
            }
            _ => Err(Fault::new(at, "a quad needs `corner`, `edge_u` and `edge_v`, or `vertices`")),
        }
    }
}

impl MeshShape {
    fn mesh(&self, positions: &At<Vec<Vec3>>) -> Result<Mesh, Fault> {
        let count = positions.value.len();
        let indices = match &self.indices {
            Some(indices) => indices.value.clone(),
            None if count.is_multiple_of(3) => (0..count as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
            None => {
                let message = format!("{count} vertices without `indices` are not triangles; expected a multiple of 3");
                return Err(Fault::new(&positions.at, message));
            }
        };
        Ok(Mesh {
            positions: positions.value.clone(),
            indices,
            normals: self.normals.clone(),
            tangents: self.tangents.clone(),
            uv: [self.uv.clone(), self.second_uv.clone()],
            colors: self.colors.iter().map(|c| c.0).collect(),
        })
    }

    /// The mesh of a PLY file, which must say everything.
    fn mesh_of_file(&self, file: &At<String>, b: &mut Builder<'_>) -> Result<Arc<Mesh>, Fault> {
        if let Some((key, _)) = pairs(self).first().filter(|(key, _)| *key != "file") {
            return Err(Fault::new(&file.at, format!("`{key}` is given too; expected one way")));
        }
        b.mesh_file(file)
    }

    fn of(mesh: &Mesh) -> Self {
        let Mesh { positions, indices, normals, tangents, uv: [uv, second_uv], colors } = mesh.clone();
        Self {
            positions: Some(At::nowhere(positions)),
            indices: Some(At::nowhere(indices)),
            normals,
            tangents,
            uv,
            second_uv,
            colors: colors.into_iter().map(VertexColor).collect(),
            file: None,
        }
    }

    fn in_file(name: String) -> Self {
        Self { positions: None, indices: None, file: Some(At::nowhere(name)), ..Self::of(&Mesh::default()) }
    }
}

impl ShapeKind {
    /// What builds this geometry at its own place. A mesh is one of the file `file`, if there is one.
    pub(super) fn of(shape: &Shape, file: Option<String>) -> Self {
        let nowhere = |value| At::nowhere(value);
        match shape {
            Shape::Sphere { radius } => {
                Self::SphereShape(SphereShape { radius: Positive(*radius), center: Vec3::ZERO })
            }
            Shape::Disk { radius } => {
                Self::DiskShape(DiskShape { radius: Positive(*radius), center: Vec3::ZERO, normal: nowhere(Vec3::Z) })
            }
            Shape::Cylinder { radius, height } => Self::CylinderShape(CylinderShape {
                radius: Positive(*radius),
                from: Vec3::ZERO,
                to: nowhere(Vec3::Z * *height),
            }),
            Shape::Mesh(mesh) => match (file, plain(mesh)) {
                (_, Some(known)) => known,
                (Some(name), None) => Self::MeshShape(MeshShape::in_file(name)),
                (None, None) => Self::MeshShape(MeshShape::of(mesh)),
            },
        }
    }
}

impl ShapeKind {
    /// The geometry of this name.
    pub(super) fn shared(name: String) -> Self {
        Self::SharedShape(SharedShape { geometry: At::nowhere(name) })
    }
}

/// The quad or box that this mesh is.
fn plain(mesh: &Mesh) -> Option<ShapeKind> {
    let [first, .., last] = mesh.positions[..] else { return None };
    if let [a, b, c, d] = mesh.positions[..] {
        let quad = QuadShape { corner: None, edge_u: None, edge_v: None, vertices: Some([a, b, c, d]) };
        let same = quad.mesh(&(0..0)).is_ok_and(|quad| quad == *mesh);
        return same.then_some(ShapeKind::QuadShape(quad));
    }
    // The last vertex of the last face is the upper corner but for z; `cuboid` adds, which rounds.
    let max = mesh.positions.iter().fold(first.max(last), |max, p| max.max(*p));
    let same = mesh.positions.len() == 24 && primitives::cuboid(first, max) == *mesh;
    same.then_some(ShapeKind::BoxShape(BoxShape { min: At::nowhere(first), max }))
}
