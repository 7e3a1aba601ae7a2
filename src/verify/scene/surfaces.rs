//! The meshes of a scene as they stand in the world.

use super::unique;
use crate::desc::{Mesh, Object, Scene, Shape};
use crate::math::Transform;
use glam::{DVec3, Vec3};

/// A mesh with the first object that places it.
pub(super) struct Placed<'a> {
    /// Name of the object, unique.
    pub name: String,
    /// Its number.
    pub index: usize,
    /// The object.
    pub object: &'a Object,
    /// Its mesh, in object space.
    pub mesh: &'a Mesh,
    /// Objects that place it.
    pub uses: usize,
}

/// Every mesh that stands somewhere, once.
pub(super) fn meshes(scene: &Scene) -> Vec<Placed<'_>> {
    let names = unique(scene.objects.iter().map(|o| &*o.name), "object");
    let mut first: Vec<Option<usize>> = vec![None; scene.shapes.len()];
    let mut all: Vec<Placed> = Vec::new();
    for ((index, object), name) in scene.objects.iter().enumerate().zip(names) {
        let Some(Shape::Mesh(mesh)) = scene.shapes.get(object.shape) else { continue };
        match first[object.shape] {
            Some(known) => all[known].uses += 1,
            None => {
                first[object.shape] = Some(all.len());
                all.push(Placed { name, index, object, mesh, uses: 1 });
            }
        }
    }
    all
}

impl Placed<'_> {
    /// Whether the front is the side from which the vertices, in the world, run clockwise.
    pub(super) fn flipped(&self) -> bool {
        Transform::from_mat4(self.object.to_world).is_some_and(|t| t.mirrors()) != self.object.reversed
    }
}

/// What three vertices carry, if they carry it.
pub(super) fn corners<T: Copy>(list: &[T], triangle: [u32; 3]) -> Option<[T; 3]> {
    let [a, b, c] = triangle.map(|i| list.get(i as usize).copied());
    Some([a?, b?, c?])
}

/// Twice the area times the normal, in object space.
pub(super) fn area_vector(p: [Vec3; 3]) -> DVec3 {
    let [a, b, c] = p.map(|p| p.as_dvec3());
    (b - a).cross(c - a)
}
