//! Polygonal primitives as meshes.

use super::Mesh;
use glam::{Vec2, Vec3};

/// Parallelogram `corner + u a + v b`, 0 ≤ u, v ≤ 1, normal along a × b.
pub fn quad(corner: Vec3, a: Vec3, b: Vec3) -> Mesh {
    Mesh {
        positions: vec![corner, corner + a, corner + a + b, corner + b],
        indices: vec![[0, 1, 2], [0, 2, 3]],
        uv: [vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y], Vec::new()],
        ..Mesh::default()
    }
}

/// Axis-aligned box with outward normals; each face has the UV unit square.
pub fn cuboid(min: Vec3, max: Vec3) -> Mesh {
    let e = max - min;
    let (x, y, z) = (Vec3::X * e.x, Vec3::Y * e.y, Vec3::Z * e.z);
    let faces = [(min, z, y), (min + x, y, z), (min, x, z), (min + y, z, x), (min, y, x), (min + z, x, y)];
    let mut mesh = Mesh::default();
    for (corner, a, b) in faces {
        let face = quad(corner, a, b);
        let base = mesh.positions.len() as u32;
        mesh.positions.extend(face.positions);
        mesh.uv[0].extend(&face.uv[0]);
        mesh.indices.extend(face.indices.iter().map(|t| t.map(|i| i + base)));
    }
    mesh
}
