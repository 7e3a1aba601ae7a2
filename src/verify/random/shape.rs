//! Random shapes about the origin, of a radius of about a half.

use super::draw::Draw;
use super::feature::Feature;
use crate::desc::{Mesh, Shape, primitives};
use glam::{Vec2, Vec3, Vec4};
use std::collections::BTreeSet;
use std::f32::consts::TAU;
use std::sync::Arc;

/// A shape with what it has.
#[derive(Clone, Debug)]
pub(super) struct Form {
    pub(super) shape: Shape,
    pub(super) features: BTreeSet<Feature>,
}

impl Form {
    /// Its surface bounds a volume.
    pub(super) fn is_closed(&self) -> bool {
        use Feature::*;
        self.features.iter().any(|f| matches!(f, Sphere | Cuboid | Facets | Ring))
    }

    fn has(&self, feature: Feature) -> bool {
        self.features.contains(&feature)
    }

    /// The set of texture coordinates that its material looks at.
    pub(super) fn uv_set(&self) -> usize {
        usize::from(self.has(Feature::SecondUv))
    }
}

/// A shape by its kind, one of [`Feature`]'s shapes.
pub(super) fn form(kind: Feature, draw: &mut Draw) -> Form {
    let mut features = BTreeSet::from([kind]);
    let mesh = match kind {
        Feature::Sphere => return Form { shape: Shape::Sphere { radius: draw.between(0.4, 0.7) }, features },
        Feature::Disk => return Form { shape: Shape::Disk { radius: draw.between(0.4, 0.8) }, features },
        Feature::Cylinder => {
            let (radius, height) = (draw.between(0.25, 0.5), draw.between(0.4, 0.9));
            return Form { shape: Shape::Cylinder { radius, height }, features };
        }
        Feature::Quad => primitives::quad(Vec3::new(-0.6, -0.6, 0.0), Vec3::X * 1.2, Vec3::Y * 1.2),
        Feature::Cuboid => primitives::cuboid(Vec3::splat(-0.45), Vec3::splat(0.45)),
        Feature::Facets => ring(draw, 5, 4),
        _ => ring(draw, 10, 8),
    };
    let mesh = dressed(mesh, draw, &mut features);
    Form { shape: Shape::Mesh(Arc::new(mesh)), features }
}

/// A ring of so many triangles that copies of it are kept once.
pub(super) fn fine(draw: &mut Draw) -> Form {
    let mut features = BTreeSet::from([Feature::Ring, Feature::Instances]);
    let mesh = ring(draw, 48, 24);
    let mesh = dressed(mesh, draw, &mut features);
    Form { shape: Shape::Mesh(Arc::new(mesh)), features }
}

/// A torus of `around` × `about` quadrilaterals, which is closed and sees itself. The seams of its texture coordinates
/// have two vertices in one place.
fn ring(draw: &mut Draw, around: u32, about: u32) -> Mesh {
    let (major, minor) = (draw.between(0.35, 0.5), draw.between(0.1, 0.25));
    let mut mesh = Mesh::default();
    // What closes the circle is the number that began it, bit for bit.
    let circle = |i: u32, n: u32| Vec2::from_angle(TAU * (i % n) as f32 / n as f32);
    for i in 0..=around {
        for k in 0..=about {
            let (a, b) = (circle(i, around), circle(k, about));
            let from_axis = major + minor * b.x;
            mesh.positions.push(Vec3::new(a.x * from_axis, a.y * from_axis, minor * b.y));
            mesh.normals.push(Vec3::new(a.x * b.x, a.y * b.x, b.y).normalize());
            mesh.tangents.push(Vec4::new(-a.y, a.x, 0.0, 1.0));
            mesh.uv[0].push(Vec2::new(i as f32 / around as f32, k as f32 / about as f32));
        }
    }
    for i in 0..around {
        for k in 0..about {
            let [a, b] = [i * (about + 1) + k, (i + 1) * (about + 1) + k];
            mesh.indices.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
    }
    mesh
}

/// Gives a mesh some of what meshes may have.
fn dressed(mut mesh: Mesh, draw: &mut Draw, features: &mut BTreeSet<Feature>) -> Mesh {
    let n = mesh.positions.len();
    if mesh.normals.is_empty() {
        // Faces of boxes and quads: normals that lean outwards.
        let flat = face_normals(&mesh);
        mesh.normals = mesh.positions.iter().zip(&flat).map(|(p, n)| (*n + 0.6 * *p).normalize()).collect();
        mesh.tangents = flat.iter().map(|n| n.cross(Vec3::Z).try_normalize().unwrap_or(Vec3::X).extend(1.0)).collect();
    }
    if draw.chance(0.4) {
        features.insert(Feature::SmoothNormals);
    } else {
        mesh.normals.clear();
    }
    if draw.chance(0.5) {
        features.insert(Feature::Tangents);
    } else {
        mesh.tangents.clear();
    }
    if draw.chance(0.35) {
        features.insert(Feature::VertexColors);
        mesh.colors = (0..n).map(|_| Vec3::from(draw.rgb(0.2, 1.0)).extend(draw.between(0.4, 1.0))).collect();
    }
    if draw.chance(0.3) {
        features.insert(Feature::SecondUv);
        let turn = Vec2::from_angle(draw.between(0.0, TAU));
        mesh.uv[1] = mesh.uv[0].iter().map(|uv| 1.5 * turn.rotate(*uv)).collect();
    }
    mesh
}

/// The geometric normal at each vertex, of the triangle that has it.
fn face_normals(mesh: &Mesh) -> Vec<Vec3> {
    let mut normals = vec![Vec3::Z; mesh.positions.len()];
    for triangle in &mesh.indices {
        let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
        triangle.iter().for_each(|i| normals[*i as usize] = (b - a).cross(c - a).normalize());
    }
    normals
}
