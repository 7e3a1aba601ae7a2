//! Meshes that stand in several places.

use super::geometry::{Owner, corners};
use crate::bvh::{Aabb, Obstacle, Passing, TriangleBvh, TriangleHit, TriangleRef};
use crate::desc::Mesh;
use crate::math::{Ray, Transform, gamma};
use crate::shape::{Surface, triangle_surface};
use glam::{Mat3A, Vec3, Vec3A};
use std::sync::Arc;

/// A mesh that stands in several places, in object space.
#[derive(Debug)]
pub struct Prototype {
    /// Object-space geometry.
    pub mesh: Arc<Mesh>,
    /// Its triangles.
    pub bvh: TriangleBvh,
}

/// A prototype placed in the world.
#[derive(Debug)]
pub struct Instance {
    /// Which prototype.
    pub prototype: u32,
    /// Where.
    pub transform: Transform,
    /// Whose it is.
    pub owner: Owner,
    /// The front is the side from which the vertices, in the world, run clockwise.
    pub flip: bool,
}

impl Instance {
    /// The ray in object space, and how much of its parameter was skipped: its origin is rounded, and hits nearer than
    /// that error are none, or the surface that the ray leaves could be met again (PBRT 4th ed., section 6.8.5).
    #[inline]
    fn ray(&self, ray: &Ray, t_max: f32) -> (Ray, f32) {
        let m = &self.transform.to_object;
        let o = m.transform_point3a(ray.o);
        let d = m.transform_vector3a(ray.d);
        let error = (abs(&m.matrix3) * ray.o.abs() + m.translation.abs()) * gamma(4);
        let shift = d.abs().dot(error) / d.length_squared();
        (Ray { o: o + d * shift, d, t_max: t_max - shift }, shift)
    }

    pub(super) fn nearest(
        &self,
        prototype: &Prototype,
        ray: &Ray,
        t_max: f32,
        excluded: TriangleRef,
    ) -> Option<TriangleHit> {
        let (local, skipped) = self.ray(ray, t_max);
        let mut hit = prototype.bvh.nearest(&local, excluded)?;
        hit.t += skipped;
        Some(hit)
    }

    pub(super) fn occluded(&self, prototype: &Prototype, ray: &Ray, t_max: f32, excluded: [TriangleRef; 2]) -> bool {
        prototype.bvh.obstacle(&self.ray(ray, t_max).0, excluded, Passing::NOTHING) != Obstacle::None
    }

    pub(super) fn bounds(&self, prototype: &Prototype) -> Aabb {
        let m = &self.transform.to_world;
        let local = prototype.bvh.bounds();
        let world = Aabb::of(local.corners().map(|c| m.transform_point3(c)));
        // The corners are rounded.
        let reach =
            (abs(&m.matrix3) * local.min.abs().max(local.max.abs()) + Vec3::from(m.translation).abs()) * gamma(4);
        Aabb { min: world.min - reach, max: world.max + reach }
    }

    /// The surface, in the world, of a triangle of the prototype.
    pub(super) fn surface(&self, mesh: &Mesh, triangle: u32, u: f32, v: f32) -> Surface {
        let m = &self.transform.to_world;
        let (local, mut attributes) = corners(mesh, triangle, self.owner.needs_uv);
        let p = local.map(|p| m.transform_point3(p));
        attributes.normals =
            attributes.normals.map(|n| n.map(|n| self.transform.normal_to_world(n).normalize_or_zero().into()));
        attributes.tangents = attributes.tangents.map(|t| t.map(|t| m.transform_vector3(t.truncate()).extend(t.w)));
        let mut surface = triangle_surface(p, u, v, &attributes, self.flip);
        surface.p_error += map_error(&self.transform, local, surface.p);
        surface
    }
}

/// Bound on how far rays meet a triangle of object space from where its vertices stand in the world, at the point `p`: the
/// errors of the map to the world, and of the map back that a ray takes.
pub(super) fn map_error(transform: &Transform, local: [Vec3; 3], p: Vec3A) -> Vec3A {
    let (m, inverse) = (&transform.to_world, &transform.to_object);
    let reach = local.iter().fold(Vec3::ZERO, |r, p| r.max(p.abs()));
    let outward = abs(&m.matrix3) * Vec3A::from(reach) + m.translation.abs();
    let inward = abs(&inverse.matrix3) * p.abs() + inverse.translation.abs();
    outward * gamma(4) + abs(&m.matrix3) * (inward * gamma(4))
}

fn abs(m: &Mat3A) -> Mat3A {
    Mat3A::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
}
