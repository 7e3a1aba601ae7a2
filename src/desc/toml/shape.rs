//! `[[shape]]`: geometry, placed.

use super::build::Builder;
use super::color::Radiance;
use super::keys::{keys, one_of};
use super::place::{Place, unit};
use super::read::{At, Fault, NonNegative, Positive};
use crate::desc::{Mesh, Shape, Sides, primitives};
use crate::math::Frame;
use glam::{Mat4, Vec2, Vec3, Vec4};

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
        positions: At<Vec<Vec3>>,
        /// Triangles [[a, b, c], …], numbers of vertices from 0. Default: every three vertices are a triangle.
        indices: Option<At<Vec<[u32; 3]>>>,
        /// Shading normals [[x, y, z], …], one a vertex. Default: flat.
        normals: At<Vec<Vec3>> = At { at: 0..0, value: Vec::new() },
        /// Texture coordinates [[u, v], …], one a vertex. Default: none.
        uv: Vec<Vec2> = Vec::new(),
        /// Linear colours [[r, g, b], …], one a vertex: factors on the material's reflectance. Default: none.
        colors: Vec<[NonNegative; 3]> = Vec::new(),
    }
}

keys! {
    /// Everything in a .gltf, .glb, .obj or .ply file, except its cameras.
    struct FileShape {
        /// The file, below the scene's folder.
        file: At<String>,
    }
}

impl ShapeKind {
    /// The geometry and where it stands in the object's space; `None` for files.
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
                let direction = unit(&At { at: to.clone(), value: axis })?;
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
                let at = s.indices.as_ref().map_or(&s.positions.at, |i| &i.at);
                (Shape::Mesh(b.checked(name, at, s.mesh()?)?.into()), Mat4::IDENTITY)
            }
            Self::FileShape(_) => return Ok(None),
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
    fn mesh(&self) -> Result<Mesh, Fault> {
        let count = self.positions.value.len();
        let indices = match &self.indices {
            Some(indices) => indices.value.clone(),
            None if count.is_multiple_of(3) => (0..count as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
            None => {
                let message = format!("{count} vertices without `indices` are not triangles; expected a multiple of 3");
                return Err(Fault::new(&self.positions.at, message));
            }
        };
        Ok(Mesh {
            positions: self.positions.value.clone(),
            indices,
            normals: self.normals.value.clone(),
            uv: [self.uv.clone(), Vec::new()],
            colors: self.colors.iter().map(|c| Vec4::new(c[0].0, c[1].0, c[2].0, 1.0)).collect(),
            ..Mesh::default()
        })
    }
}
