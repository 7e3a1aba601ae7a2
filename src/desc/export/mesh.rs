//! Meshes as PLY, binary, little endian.

use crate::desc::Mesh;
use glam::{Vec2, Vec3};
use std::fmt::Write;

/// How far the back of a surface that emits from both sides lies behind it, of the mesh's extent.
pub(super) const INSET: f32 = 1e-5;

/// A shape as one file holds it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Variant {
    /// Index of the shape.
    pub(super) shape: usize,
    /// Vertices run the other way.
    pub(super) turned: bool,
    /// Normals are negated.
    pub(super) negated: bool,
    /// Which of the two sets of texture coordinates.
    pub(super) uv_set: usize,
    /// v counts upwards.
    pub(super) upwards: bool,
    /// Moved a little against its (written) normals' opposite: the back of what emits from both sides.
    pub(super) inset: bool,
}

/// The bytes of the file.
pub(super) fn ply(mesh: &Mesh, variant: &Variant) -> Vec<u8> {
    let mut mesh = mesh.clone();
    if variant.inset {
        inset(&mut mesh);
    }
    agree(&mut mesh);
    if variant.turned {
        mesh.indices.iter_mut().for_each(|t| t.swap(1, 2));
    }
    if variant.negated {
        mesh.normals.iter_mut().for_each(|n| *n = -*n);
    }

    let uv = &mesh.uv[variant.uv_set];
    let mut header = String::from("ply\nformat binary_little_endian 1.0\n");
    let _ = writeln!(header, "element vertex {}", mesh.positions.len());
    let mut properties = vec!["x", "y", "z"];
    if !mesh.normals.is_empty() {
        properties.extend(["nx", "ny", "nz"]);
    }
    if !uv.is_empty() {
        properties.extend(["u", "v"]);
    }
    if !mesh.colors.is_empty() {
        properties.extend(["r", "g", "b"]);
    }
    properties.iter().for_each(|name| {
        let _ = writeln!(header, "property float {name}");
    });
    let _ = writeln!(header, "element face {}", mesh.indices.len());
    header.push_str("property list uchar int vertex_indices\nend_header\n");

    let mut bytes = header.into_bytes();
    for i in 0..mesh.positions.len() {
        let normal = mesh.normals.get(i).map(|n| n.to_array());
        let uv = uv.get(i).map(|uv| [uv.x, if variant.upwards { 1.0 - uv.y } else { uv.y }]);
        let color = mesh.colors.get(i).map(|c| c.truncate().to_array());
        let numbers = mesh.positions[i].to_array().into_iter().chain(normal.into_iter().flatten());
        let numbers = numbers.chain(uv.into_iter().flatten()).chain(color.into_iter().flatten());
        numbers.for_each(|x| bytes.extend(x.to_le_bytes()));
    }
    for triangle in &mesh.indices {
        bytes.push(3);
        triangle.iter().for_each(|i| bytes.extend(i.to_le_bytes()));
    }
    bytes
}

/// Twice the area times the normal.
fn normal(mesh: &Mesh, triangle: &[u32; 3]) -> Vec3 {
    let [a, b, c] = triangle.map(|i| mesh.positions[i as usize].as_dvec3());
    (b - a).cross(c - a).as_vec3()
}

/// Gives triangles that all their normals look away from vertices of their own: shading normals are on the side of the front
/// here, and the front on the side of the normals there.
fn agree(mesh: &mut Mesh) {
    if mesh.normals.is_empty() {
        return;
    }
    for k in 0..mesh.indices.len() {
        let (triangle, n) = (mesh.indices[k], normal(mesh, &mesh.indices[k]));
        if triangle.iter().all(|i| mesh.normals[*i as usize].dot(n) < 0.0) {
            mesh.indices[k] = triangle.map(|i| copy_of(mesh, i as usize));
            mesh.indices[k].iter().for_each(|i| mesh.normals[*i as usize] *= -1.0);
        }
    }
}

/// Appends a copy of a vertex.
fn copy_of(mesh: &mut Mesh, i: usize) -> u32 {
    fn again<T: Copy>(list: &mut Vec<T>, i: usize) {
        if let Some(x) = list.get(i).copied() {
            list.push(x);
        }
    }
    again(&mut mesh.positions, i);
    again(&mut mesh.normals, i);
    again::<Vec2>(&mut mesh.uv[0], i);
    again(&mut mesh.uv[1], i);
    again(&mut mesh.colors, i);
    (mesh.positions.len() - 1) as u32
}

/// Moves the surface behind itself.
fn inset(mesh: &mut Mesh) {
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    for triangle in &mesh.indices {
        let n = normal(mesh, triangle);
        triangle.iter().for_each(|i| sums[*i as usize] += n);
    }
    let (low, high) =
        mesh.positions.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
    let depth = INSET * (high - low).length();
    for (p, n) in mesh.positions.iter_mut().zip(sums) {
        *p -= n.normalize_or_zero() * depth;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::desc::{Shape, ply as reader, primitives::quad};
    use std::path::Path;

    const PLAIN: Variant = Variant { shape: 0, turned: false, negated: false, uv_set: 0, upwards: true, inset: false };

    /// As our own reader, which counts v upwards, has it.
    fn read(mesh: &Mesh, variant: &Variant) -> Mesh {
        let mut scene = reader::parse(&ply(mesh, variant), Path::new("a.ply")).unwrap();
        let Shape::Mesh(mesh) = scene.shapes.remove(0) else { unreachable!() };
        std::sync::Arc::unwrap_or_clone(mesh)
    }

    #[test]
    fn what_is_written_is_read_again() {
        let mut mesh = quad(Vec3::ZERO, Vec3::X, Vec3::Y);
        mesh.normals = vec![Vec3::Z; 4];
        assert_eq!(read(&mesh, &PLAIN), mesh);
        let back = read(&mesh, &Variant { turned: true, negated: true, inset: true, ..PLAIN });
        assert_eq!((back.indices[0], back.normals[0]), ([0, 2, 1], -Vec3::Z));
        assert!(back.positions.iter().all(|p| p.z < 0.0 && p.z > -1e-4));
    }

    #[test]
    fn normals_that_look_away_are_turned() {
        let mut mesh = quad(Vec3::ZERO, Vec3::X, Vec3::Y);
        mesh.normals = vec![-Vec3::Z; 4];
        let read = read(&mesh, &PLAIN);
        assert_eq!(read.positions.len(), 10);
        assert!(read.indices.iter().flatten().all(|i| read.normals[*i as usize] == Vec3::Z));
    }
}
