//! Whether triangles bound a volume.

use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// What the edges of a surface say about it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Edges {
    /// Edges in all.
    pub all: usize,
    /// Edges of an odd number of triangles: there is a hole.
    pub open: usize,
    /// Edges of an even number of triangles that do not run along them as often as against: neighbours disagree about
    /// the outside.
    pub twisted: usize,
    /// The first triangle with an open or twisted edge.
    pub first: Option<usize>,
}

impl Edges {
    /// Counts the edges of triangles. Vertices of one place are one vertex: files split them where normals or texture
    /// coordinates jump.
    pub(super) fn of(triangles: &[[Vec3; 3]]) -> Self {
        let mut numbers: HashMap<[u32; 3], u32> = HashMap::new();
        let mut number = |p: Vec3| {
            let next = numbers.len() as u32;
            // Adding zero makes −0 and 0 one.
            *numbers.entry((p + Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(next)
        };
        // Of each undirected edge: triangles that run along it, against it, and the first of them.
        let mut uses: HashMap<[u32; 2], ([usize; 2], usize)> = HashMap::new();
        for (i, triangle) in triangles.iter().enumerate() {
            let v = triangle.map(&mut number);
            for (a, b) in [(v[0], v[1]), (v[1], v[2]), (v[2], v[0])] {
                // A triangle that closes upon itself has no edge there.
                if a != b {
                    let entry = uses.entry([a.min(b), a.max(b)]).or_insert(([0; 2], i));
                    entry.0[usize::from(a > b)] += 1;
                }
            }
        }
        let mut edges = Self { all: uses.len(), ..Self::default() };
        for ([along, against], triangle) in uses.into_values() {
            if along == against {
                continue;
            }
            if (along + against) % 2 == 0 {
                edges.twisted += 1
            } else {
                edges.open += 1
            }
            edges.first = Some(edges.first.map_or(triangle, |first| first.min(triangle)));
        }
        edges
    }

    /// It bounds a volume, and all its triangles agree on which side is inside.
    pub(super) fn closed(&self) -> bool {
        self.all > 0 && self.open == 0 && self.twisted == 0
    }
}

/// Six times the volume inside, positive where the triangles run counter-clockwise as seen from outside: Σ a·(b × c),
/// about a point of the surface, so that places far from the origin lose nothing.
pub(super) fn signed_volume(triangles: &[[Vec3; 3]]) -> f64 {
    let origin = triangles.first().map_or(DVec3::ZERO, |t| t[0].as_dvec3());
    triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|p| p.as_dvec3() - origin);
            a.dot(b.cross(c))
        })
        .sum()
}

/// How often the surface winds about `p`: solid angles over 4π, 1 inside of a closed surface and 0 outside (van Oosterom &
/// Strackee 1983).
pub(super) fn winding(triangles: &[[Vec3; 3]], p: Vec3) -> f64 {
    let p = p.as_dvec3();
    let angle = |t: &[Vec3; 3]| {
        let [a, b, c] = t.map(|v| v.as_dvec3() - p);
        let [x, y, z] = [a.length(), b.length(), c.length()];
        let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
        2.0 * a.dot(b.cross(c)).atan2(below)
    };
    triangles.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::desc::{Mesh, primitives};

    fn triangles(mesh: &Mesh) -> Vec<[Vec3; 3]> {
        mesh.indices.iter().map(|t| t.map(|i| mesh.positions[i as usize])).collect()
    }

    #[test]
    fn a_box_is_closed_until_a_triangle_is_missing_or_turned() {
        let mut cube = triangles(&primitives::cuboid(Vec3::ZERO, Vec3::new(1.0, 2.0, 3.0)));
        assert!(Edges::of(&cube).closed());
        assert_eq!(Edges::of(&cube).all, 18);
        assert!((signed_volume(&cube) / 6.0 - 6.0).abs() < 1e-12);
        assert!((winding(&cube, Vec3::splat(0.3)) - 1.0).abs() < 1e-12);
        assert!(winding(&cube, Vec3::splat(-0.3)).abs() < 1e-12);
        cube[5].swap(0, 1);
        let edges = Edges::of(&cube);
        assert_eq!((edges.open, edges.twisted), (0, 3));
        cube.pop();
        let edges = Edges::of(&cube);
        assert!(edges.open == 3 && !edges.closed());
    }
}
