//! What a leaf of a hierarchy may hold.

use super::{
    Derivatives, PlacedQuadric, Surface, TriangleAttributes, intersect_triangle, triangle_derivatives, triangle_surface,
};
use crate::math::Ray;
use glam::{Vec3, Vec3A};

/// A piece of surface that answers rays for itself.
///
/// The triangles of meshes, eight of which share a leaf, are met by [`crate::bvh::TriangleBvh`] instead; what is found of them
/// is the same.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "quadrics are traced where they lie; triangles by themselves are rare")]
pub enum Primitive {
    /// A triangle by itself.
    Triangle(Box<Triangle>),
    /// Sphere, disk or cylinder under an affine map.
    Quadric(PlacedQuadric),
}

/// A triangle with what its vertices carry.
#[derive(Clone, Copy, Debug, Default)]
pub struct Triangle {
    /// The vertices.
    pub p: [Vec3; 3],
    /// What they carry.
    pub attributes: TriangleAttributes,
    /// The front is the side from which the vertices run clockwise.
    pub flip: bool,
}

/// Where a ray meets a primitive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PrimitiveHit {
    /// Ray parameter.
    pub t: f32,
    /// Where on the primitive: of a triangle the weight of the second vertex; 0 of a quadric, whose point the ray says.
    pub u: f32,
    /// The other parameter: of a triangle the weight of the third vertex, 0 of a quadric.
    pub v: f32,
}

impl Primitive {
    /// Nearest hit in (0, `t_max`), whatever the ray says of its end.
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<PrimitiveHit> {
        match self {
            Self::Triangle(triangle) => intersect_triangle(&Ray { t_max, ..*ray }, triangle.p),
            Self::Quadric(quadric) => {
                Some(PrimitiveHit { t: quadric.intersect_before(ray, t_max)?, ..Default::default() })
            }
        }
    }

    /// Whether it stands before the point of it that the ray leads to, at about `t`: what a shadow ray to that point asks.
    #[inline]
    pub fn hides_own_point(&self, ray: &Ray, t: f32) -> bool {
        match self {
            // A line meets a plane once.
            Self::Triangle(_) => false,
            Self::Quadric(quadric) => quadric.hides_own_point(ray, t),
        }
    }

    /// The surface where `ray` meets it; texture coordinates and tangent of a quadric only where the material `needs_uv`, for
    /// they take a while.
    #[inline]
    pub fn surface(&self, ray: &Ray, hit: &PrimitiveHit, needs_uv: bool) -> Surface {
        match self {
            Self::Triangle(t) => triangle_surface(t.p, hit.u, hit.v, &t.attributes, t.flip),
            Self::Quadric(quadric) => quadric.surface(ray, hit.t, needs_uv),
        }
    }

    /// ∂p/∂u and ∂p/∂v where `ray` meets it; `None` where it has no texture coordinates, or degenerate ones.
    pub fn derivatives(&self, ray: &Ray, hit: &PrimitiveHit) -> Option<Derivatives> {
        match self {
            Self::Triangle(t) => triangle_derivatives(t.p, t.attributes.uv[0]?),
            Self::Quadric(quadric) => quadric.derivatives(ray, hit.t),
        }
    }

    /// Lower and upper corner of the bounding box.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        match self {
            Self::Triangle(triangle) => {
                let [a, b, c] = triangle.p;
                (a.min(b).min(c), a.max(b).max(c))
            }
            Self::Quadric(quadric) => quadric.bounds(),
        }
    }

    /// Nearest hit of a ray, and the surface there.
    pub fn meet(&self, ray: &Ray) -> Option<(f32, Surface)> {
        let hit = self.intersect(ray, ray.t_max)?;
        Some((hit.t, self.surface(ray, &hit, true)))
    }
}

impl Triangle {
    /// Of vertices in registers.
    pub fn new(p: [Vec3A; 3], attributes: TriangleAttributes, flip: bool) -> Self {
        Self { p: p.map(Vec3::from), attributes, flip }
    }
}
