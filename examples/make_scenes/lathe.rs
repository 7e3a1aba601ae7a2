//! Meshes: surfaces of revolution and boxes.

use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

/// Triangles with normals and texture coordinates.
#[derive(Default)]
pub(super) struct Mesh {
    pub(super) positions: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    pub(super) uv: Vec<Vec2>,
    pub(super) indices: Vec<u16>,
}

/// Turns a profile of (radius, height) about the y axis; where it runs upwards, the front is outside. Its corners stay
/// sharp, its bends (below 40°) become smooth. u runs around, v along the profile; `flutes` waves of 1/40 of the radius
/// run around it.
pub(super) fn lathe(profile: &[[f32; 2]], segments: u16, flutes: f32) -> Mesh {
    let points: Vec<Vec2> = profile.iter().map(|&p| p.into()).collect();
    let pieces: Vec<Vec2> = points.windows(2).map(|p| (p[1] - p[0]).normalize()).collect();
    let total: f32 = points.windows(2).map(|p| p[0].distance(p[1])).sum();
    let mut mesh = Mesh::default();
    let mut along = 0.0;
    for (i, &direction) in pieces.iter().enumerate() {
        let ends = [points[i], points[i + 1]];
        let bend = |other: Option<&Vec2>| match other {
            Some(other) if other.dot(direction) > 0.77 => (*other + direction).normalize(),
            _ => direction,
        };
        let directions = [bend(i.checked_sub(1).and_then(|j| pieces.get(j))), bend(pieces.get(i + 1))];
        let length = ends[0].distance(ends[1]);
        let base = mesh.positions.len() as u16;
        for step in 0..=segments {
            let around = step as f32 / segments as f32;
            let (sin, cos) = (TAU * around).sin_cos();
            let wave = 1.0 - 0.025 * (0.5 - 0.5 * (flutes * TAU * around).cos());
            for k in 0..2 {
                let (p, d) = (ends[k], directions[k]);
                mesh.positions.push(Vec3::new(p.x * wave * cos, p.y, -p.x * wave * sin));
                mesh.normals.push(Vec3::new(d.y * cos, -d.x, -d.y * sin));
                mesh.uv.push(Vec2::new(around, (along + k as f32 * length) / total));
            }
        }
        for step in 0..segments {
            let a = base + 2 * step;
            // At the axis one of the two triangles has no area.
            if ends[0].x > 0.0 {
                mesh.indices.extend([a, a + 2, a + 3]);
            }
            if ends[1].x > 0.0 {
                mesh.indices.extend([a, a + 3, a + 1]);
            }
        }
        along += length;
    }
    mesh
}

/// A box with a face's texture on each side.
pub(super) fn cuboid(min: Vec3, max: Vec3) -> Mesh {
    let quads = radianza::desc::primitives::cuboid(min, max);
    let mut mesh = Mesh { indices: quads.indices.iter().flatten().map(|&i| i as u16).collect(), ..Mesh::default() };
    for t in quads.indices.chunks(2) {
        let corner = |i: usize| quads.positions[t[0][i] as usize];
        let normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalize();
        mesh.normals.extend([normal; 4]);
    }
    mesh.uv = quads.uv[0].clone();
    mesh.positions = quads.positions;
    mesh
}
