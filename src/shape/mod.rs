//! Shapes: how rays meet them and how points on them are drawn.
//!
//! Triangles come in meshes, whose rays are answered by [`crate::bvh`]; here is what is known of one triangle and one
//! hit. Quadrics answer for themselves, in f64, so that a hit is known to half a unit in the last place of f32.

mod placed;
mod primitive;
mod quadric;
mod triangle;

pub use placed::PlacedQuadric;
pub use primitive::{Primitive, PrimitiveHit, Triangle};
pub use quadric::{Chart, Quadric, QuadricPoint};
pub use triangle::{
    TriangleAttributes, flat_surface, interpolate, intersect_triangle, triangle_area, triangle_derivatives,
    triangle_normal, triangle_surface, with_attributes,
};

use crate::math::{Transform, gamma};
use glam::{Vec2, Vec3A, Vec4};

/// How a point moves with the first set of texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derivatives {
    /// ∂p/∂u.
    pub dpdu: Vec3A,
    /// ∂p/∂v; v grows downwards.
    pub dpdv: Vec3A,
}

/// A point of a surface with what shading needs, in world space (or object space before it is placed).
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// The point.
    pub p: Vec3A,
    /// Absolute error bound of each coordinate of `p`.
    pub p_error: Vec3A,
    /// Geometric normal, unit, towards the front side (whichever side the ray came from).
    pub ng: Vec3A,
    /// Shading normal, unit, in the hemisphere of `ng`.
    pub ns: Vec3A,
    /// Direction in which u grows; not normalised, 0 where unknown.
    pub tangent: Vec3A,
    /// Sign of the bitangent: ns × tangent × handedness.
    pub handedness: f32,
    /// Texture coordinates, both sets.
    pub uv: [Vec2; 2],
    /// Vertex colour, linear RGBA; 1 where there is none.
    pub color: Vec4,
}

impl Surface {
    /// None yet.
    pub const NOWHERE: Self = Self {
        p: Vec3A::ZERO,
        p_error: Vec3A::ZERO,
        ng: Vec3A::Z,
        ns: Vec3A::Z,
        tangent: Vec3A::ZERO,
        handedness: 1.0,
        uv: [Vec2::ZERO; 2],
        color: Vec4::ONE,
    };

    /// From object space to the world. The error bound grows by the rounding of the map (PBRT 4th ed., section 6.8.4)
    /// and by that of the way back, so that a ray whose origin was moved out of the world-space box
    /// ([`crate::math::offset_origin`]) is still on its side of the surface after its origin was transformed to object
    /// space in f32:
    ///
    /// ```text
    /// δ' = (1 + γ₃) |M| δ + γ₃ (|M| |p| + |T|) + |M| γ₅ (|M⁻¹| |p'| + |T'|)
    /// ```
    pub fn to_world(&self, transform: &Transform) -> Self {
        let (m, inverse) = (&transform.to_world, &transform.to_object);
        let (m_abs, inverse_abs) = (m.matrix3.abs(), inverse.matrix3.abs());
        let p = m.transform_point3a(self.p);
        let forth = m_abs * self.p.abs() + m.translation.abs();
        let back = m_abs * (inverse_abs * p.abs() + inverse.translation.abs());
        let p_error = (1.0 + gamma(3)) * (m_abs * self.p_error) + gamma(3) * forth;
        let mirror = if transform.mirrors() { -1.0 } else { 1.0 };
        Self {
            p,
            p_error: p_error + gamma(5) * back,
            ng: unit_or(transform.normal_to_world(self.ng), self.ng),
            ns: unit_or(transform.normal_to_world(self.ns), self.ns),
            tangent: m.transform_vector3a(self.tangent),
            handedness: self.handedness * mirror,
            ..*self
        }
    }
}

/// `v` normalised, or `otherwise` where it has no direction. In f64, so that no square under- or overflows.
#[inline]
fn unit_or(v: Vec3A, otherwise: Vec3A) -> Vec3A {
    v.as_dvec3().try_normalize().map_or(otherwise, |n| n.as_vec3a())
}
