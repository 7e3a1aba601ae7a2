//! Quadrics as meshes, where a map bends them or a texture needs coordinates that the target's quadric has not.

use crate::desc::{Mesh, Shape};
use glam::{Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Segments around.
const AROUND: u32 = 256;

/// The mesh of a quadric, with normals and the texture coordinates of [`crate::shape::Quadric`].
pub(super) fn mesh(shape: &Shape) -> Mesh {
    match *shape {
        Shape::Sphere { radius } => grid(AROUND / 2, |u, v| {
            let ((sin, cos), (s, c)) = ((PI * v).sin_cos(), (TAU * u).sin_cos());
            let n = Vec3::new(sin * c, sin * s, cos);
            (n * radius, n)
        }),
        Shape::Cylinder { radius, height } => grid(1, |u, v| {
            let (s, c) = (TAU * u).sin_cos();
            (Vec3::new(radius * c, radius * s, height * (1.0 - v)), Vec3::new(c, s, 0.0))
        }),
        Shape::Disk { radius } => disk(radius),
        Shape::Mesh(ref mesh) => Mesh::clone(mesh),
    }
}

/// Quadrangles over the unit square of (u, v), of which u goes round.
fn grid(rows: u32, at: impl Fn(f32, f32) -> (Vec3, Vec3)) -> Mesh {
    let mut mesh = Mesh::default();
    for j in 0..=rows {
        for i in 0..=AROUND {
            let uv = Vec2::new(i as f32 / AROUND as f32, j as f32 / rows as f32);
            let (p, n) = at(uv.x, uv.y);
            mesh.positions.push(p);
            mesh.normals.push(n);
            mesh.uv[0].push(uv);
        }
    }
    let vertex = |i: u32, j: u32| j * (AROUND + 1) + i;
    for (i, j) in (0..rows).flat_map(|j| (0..AROUND).map(move |i| (i, j))) {
        // v goes down, so that these run counter-clockwise from outside.
        let [a, b, c, d] = [vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1), vertex(i + 1, j)];
        mesh.indices.extend([[a, b, c], [a, c, d]]);
    }
    // At a pole one of the two has no area.
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a).length()
    };
    let least = 1e-6 * mesh.positions.iter().map(|p| p.length_squared()).fold(0.0, f32::max) / AROUND as f32;
    mesh.indices = mesh.indices.iter().copied().filter(|t| area(t) > least).collect();
    mesh
}

/// A fan, with the coordinates of the square around it.
fn disk(radius: f32) -> Mesh {
    let rim = (0..AROUND).map(|i| {
        let (s, c) = (TAU * i as f32 / AROUND as f32).sin_cos();
        Vec2::new(c, s)
    });
    let points: Vec<Vec2> = std::iter::once(Vec2::ZERO).chain(rim).collect();
    let uv = points.iter().map(|p| 0.5 * (Vec2::new(p.x, -p.y) + 1.0)).collect();
    Mesh {
        positions: points.iter().map(|p| (*p * radius).extend(0.0)).collect(),
        indices: (0..AROUND).map(|i| [0, 1 + i, 1 + (i + 1) % AROUND]).collect(),
        normals: vec![Vec3::Z; points.len()],
        uv: [uv, Vec::new()],
        ..Mesh::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_run_counter_clockwise_from_outside() {
        let shapes =
            [Shape::Sphere { radius: 2.0 }, Shape::Cylinder { radius: 0.5, height: 3.0 }, Shape::Disk { radius: 2.0 }];
        for (shape, area) in shapes.iter().zip([16.0 * PI, 3.0 * PI, 4.0 * PI]) {
            let mesh = mesh(shape);
            let mut sum = 0.0;
            for t in &mesh.indices {
                let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
                let n = (b - a).cross(c - a);
                assert!(t.iter().all(|i| mesh.normals[*i as usize].dot(n) > 0.0), "{shape:?} {t:?}");
                sum += 0.5 * n.length();
            }
            assert!((sum / area - 1.0).abs() < 1e-3, "{shape:?}: {sum} of {area}");
        }
    }
}
