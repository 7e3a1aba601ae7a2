//! Normals: of triangles, and of vertices where the file's are unusable.

use glam::{DVec3, Vec3};

/// Twice the area times the normal of a triangle, without overflow or underflow.
pub(super) fn area_vector(positions: &[Vec3], [a, b, c]: [u32; 3]) -> DVec3 {
    let p = |i: u32| positions[i as usize].as_dvec3();
    (p(b) - p(a)).cross(p(c) - p(a))
}

/// The unit normal of a triangle that has an area.
pub(super) fn face(positions: &[Vec3], triangle: [u32; 3]) -> Vec3 {
    area_vector(positions, triangle).try_normalize().map_or(Vec3::Z, DVec3::as_vec3)
}

/// Makes all normals unit. Those of length zero become the mean of their triangles' normals, weighted by area; returns
/// how many those are.
pub(super) fn repair(normals: &mut [Vec3], positions: &[Vec3], triangles: &[[u32; 3]]) -> usize {
    let mut lost = Vec::new();
    for (i, n) in normals.iter_mut().enumerate() {
        match n.as_dvec3().try_normalize() {
            Some(unit) => *n = unit.as_vec3(),
            None => lost.push(i as u32),
        }
    }
    if lost.is_empty() {
        return 0;
    }
    let mut sums = vec![DVec3::ZERO; lost.len()];
    let mut any = vec![Vec3::Z; lost.len()];
    for triangle in triangles {
        for vertex in triangle {
            if let Ok(slot) = lost.binary_search(vertex) {
                sums[slot] += area_vector(positions, *triangle);
                any[slot] = face(positions, *triangle);
            }
        }
    }
    for ((vertex, sum), any) in lost.iter().zip(sums).zip(any) {
        normals[*vertex as usize] = sum.try_normalize().map_or(any, DVec3::as_vec3);
    }
    lost.len()
}
