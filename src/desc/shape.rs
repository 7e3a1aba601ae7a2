//! Geometry as written.

use super::Emission;
use glam::{Mat4, Vec2, Vec3, Vec4};
use std::sync::Arc;

/// Geometry in object space. Normals point outwards (sphere, cylinder), along +z (disk), or to the side from which
/// a triangle's vertices run counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// About the origin.
    Sphere {
        /// Radius \[m\].
        radius: f32,
    },
    /// About the origin in the plane z = 0.
    Disk {
        /// Radius \[m\].
        radius: f32,
    },
    /// Open cylinder about the z axis, 0 ≤ z ≤ height.
    Cylinder {
        /// Radius \[m\].
        radius: f32,
        /// Height \[m\].
        height: f32,
    },
    /// Triangles; who places them unmoved need not copy them.
    Mesh(Arc<Mesh>),
}

/// Indexed triangles. Each attribute list is empty or as long as `positions`; readers guarantee that indices are in
/// range and positions finite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertices \[m\].
    pub positions: Vec<Vec3>,
    /// Triangles, counter-clockwise from outside.
    pub indices: Vec<[u32; 3]>,
    /// Shading normals, unit; empty: flat.
    pub normals: Vec<Vec3>,
    /// Tangents, unit; w = ±1 is the handedness of the bitangent.
    pub tangents: Vec<Vec4>,
    /// Texture coordinates.
    pub uv: [Vec<Vec2>; 2],
    /// Linear RGBA factors on the base colour.
    pub colors: Vec<Vec4>,
}

impl Mesh {
    /// Bytes of memory.
    pub fn memory(&self) -> usize {
        let Self { positions, indices, normals, tangents, uv: [first, second], colors } = self;
        let places = size_of_val(&positions[..]) + size_of_val(&indices[..]) + size_of_val(&normals[..]);
        let charts = size_of_val(&tangents[..]) + size_of_val(&first[..]) + size_of_val(&second[..]);
        places + charts + size_of_val(&colors[..])
    }

    /// Its vertices carry something that textures are placed by: coordinates, tangents, or colours.
    pub fn has_chart(&self) -> bool {
        !(self.tangents.is_empty() && self.uv.iter().all(Vec::is_empty) && self.colors.is_empty())
    }
}

/// A shape placed in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Name for messages; may be empty.
    pub name: String,
    /// Which shape.
    pub shape: usize,
    /// Object → world, affine.
    pub to_world: Mat4,
    /// Which material.
    pub material: usize,
    /// Emission of this object in place of its material's.
    pub emission: Option<Emission>,
    /// Normals point to the other side.
    pub reversed: bool,
    /// The author declares that it bounds a volume, alone or with its neighbours of the same name and place.
    pub closed: bool,
}

impl Object {
    /// A shape of this material where it was made, and nothing said beyond that.
    pub fn new(shape: usize, material: usize) -> Self {
        Self {
            name: String::new(),
            shape,
            to_world: Mat4::IDENTITY,
            material,
            emission: None,
            reversed: false,
            closed: false,
        }
    }
}
