//! What a compiled scene holds, in numbers for people.

use crate::bvh::Aabb;

/// Counts and sizes.
#[derive(Clone, Debug)]
pub struct Info {
    /// Box about all surfaces \[m\].
    pub bounds: Aabb,
    /// Triangles in memory.
    pub stored_triangles: usize,
    /// Triangles in the world: each instance counts its own.
    pub triangles: usize,
    /// Instances of meshes that stand in several places.
    pub instances: usize,
    /// Spheres, disks, cylinders.
    pub quadrics: usize,
    /// Names of the materials.
    pub materials: Vec<String>,
    /// Lights: emissive triangles and quadrics, points, spots, parallel light, environments.
    pub lights: usize,
    /// Textures.
    pub textures: usize,
    /// Bytes of vertices and indices.
    pub mesh_bytes: usize,
    /// Bytes of hierarchies.
    pub bvh_bytes: usize,
    /// Bytes of images.
    pub texture_bytes: usize,
}
