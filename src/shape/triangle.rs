//! Triangles: the surface at a hit, and what lights and tests need to know of one.

use super::{Derivatives, PrimitiveHit, Surface};
use crate::math::{Ray, gamma};
use glam::{Vec2, Vec3, Vec3A, Vec4};

/// What the vertices of a triangle carry besides their positions.
#[derive(Clone, Copy, Debug, Default)]
pub struct TriangleAttributes {
    /// Shading normals; flat without.
    pub normals: Option<[Vec3; 3]>,
    /// Tangents; w = ±1 is the handedness of the bitangent.
    pub tangents: Option<[Vec4; 3]>,
    /// Texture coordinates, both sets.
    pub uv: [Option<[Vec2; 3]>; 2],
    /// Linear RGBA vertex colours.
    pub colors: Option<[Vec4; 3]>,
}

/// Σ bᵢ xᵢ with weights (1 − u − v, u, v).
#[inline]
pub fn interpolate<T>(x: [T; 3], u: f32, v: f32) -> T
where
    T: Copy + std::ops::Mul<f32, Output = T> + std::ops::Add<Output = T>,
{
    x[0] * (1.0 - u - v) + x[1] * u + x[2] * v
}

/// Unit normal towards the side from which the vertices run counter-clockwise; `None` for a triangle without area.
/// In f64: the products of f32 edges are exact and do not underflow.
#[inline]
pub fn triangle_normal([a, b, c]: [Vec3; 3]) -> Option<Vec3> {
    let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
    (b - a).cross(c - a).try_normalize().map(|n| n.as_vec3())
}

/// Area \[m²\].
pub fn triangle_area([a, b, c]: [Vec3; 3]) -> f32 {
    let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
    (0.5 * (b - a).cross(c - a).length()) as f32
}

/// The surface of triangle `p` at the weights (1 − u − v, u, v), in the space of `p`. `flip` puts the front on the
/// side from which the vertices run clockwise (reversed objects; vertices that a mirroring map has moved).
///
/// The error of the interpolated point is bounded by γ₇ Σ |bᵢ pᵢ| (PBRT 4th ed., section 6.8.4), and by γ₂ |p₀| more
/// because the weight of the first vertex is the difference 1 − u − v.
pub fn triangle_surface(p: [Vec3; 3], u: f32, v: f32, attributes: &TriangleAttributes, flip: bool) -> Surface {
    // A degenerate triangle, which no ray should meet, gets any normal.
    let front = Vec3A::from(triangle_normal(p).unwrap_or(Vec3::Z));
    let flat = flat_surface(p.map(Vec3A::from), u, v, if flip { -front } else { front });
    with_attributes(flat, p, u, v, attributes, flip)
}

/// [`triangle_surface`] of a triangle that carries nothing but its positions, with the normal `ng` of its front.
#[inline]
pub fn flat_surface(p: [Vec3A; 3], u: f32, v: f32, ng: Vec3A) -> Surface {
    let [a, b, c] = [p[0] * (1.0 - u - v), p[1] * u, p[2] * v];
    Surface {
        p: a + b + c,
        p_error: (a.abs() + b.abs() + c.abs()) * gamma(7) + p[0].abs() * gamma(2),
        ng,
        ns: ng,
        tangent: Vec3A::ZERO,
        handedness: 1.0,
        uv: [Vec2::ZERO; 2],
        color: Vec4::ONE,
    }
}

/// A flat surface with what its triangle's vertices carry.
pub fn with_attributes(
    flat: Surface,
    p: [Vec3; 3],
    u: f32,
    v: f32,
    attributes: &TriangleAttributes,
    flip: bool,
) -> Surface {
    let ng = flat.ng;

    // Shading normal, in the hemisphere of ng.
    let ns = attributes.normals.and_then(|n| interpolate(n.map(Vec3A::from), u, v).try_normalize()).unwrap_or(ng);
    let ns = if ns.dot(ng) < 0.0 { -ns } else { ns };

    // Tangent as given, or ∂p/∂u of the first set of texture coordinates. A flipped normal turns the cross product
    // with the tangent, the bitangent stays.
    let (tangent, handedness) = match (attributes.tangents, attributes.uv[0]) {
        (Some(tangents), _) => {
            let tangent = interpolate(tangents, u, v);
            (Vec3A::from_vec4(tangent), if (tangent.w < 0.0) != flip { -1.0 } else { 1.0 })
        }
        (None, Some(uv)) => tangent_from_uv(p, uv, flip),
        (None, None) => (Vec3A::ZERO, 1.0),
    };

    Surface {
        ns,
        tangent,
        handedness,
        uv: attributes.uv.map(|set| set.map_or(Vec2::ZERO, |uv| interpolate(uv, u, v))),
        color: attributes.colors.map_or(Vec4::ONE, |colors| interpolate(colors, u, v)),
        ..flat
    }
}

/// ∂p/∂u, the solution of eᵢ = Δuᵢ ∂p/∂u + Δvᵢ ∂p/∂v, and the handedness with which ns × ∂p/∂u points against ∂p/∂v
/// (v grows downwards, the bitangent upwards, as glTF has it); (0, 1) where the coordinates are degenerate.
fn tangent_from_uv(p: [Vec3; 3], uv: [Vec2; 3], flip: bool) -> (Vec3A, f32) {
    let (e1, e2) = (p[1] - p[0], p[2] - p[0]);
    let (d1, d2) = (uv[1] - uv[0], uv[2] - uv[0]);
    let det = d1.perp_dot(d2);
    if det == 0.0 || !det.is_finite() {
        return (Vec3A::ZERO, 1.0);
    }
    // (∂p/∂u × ∂p/∂v)·n has the sign of det where n is the counter-clockwise normal.
    let handedness = if (det > 0.0) != flip { -1.0 } else { 1.0 };
    (((e1 * d2.y - e2 * d1.y) * det.signum()).into(), handedness)
}

/// ∂p/∂u and ∂p/∂v of a triangle with these texture coordinates, the solution of eᵢ = Δuᵢ ∂p/∂u + Δvᵢ ∂p/∂v; `None` where
/// they are degenerate.
pub fn triangle_derivatives(p: [Vec3; 3], uv: [Vec2; 3]) -> Option<Derivatives> {
    let (e1, e2) = (p[1] - p[0], p[2] - p[0]);
    let (d1, d2) = (uv[1] - uv[0], uv[2] - uv[0]);
    let inverse = d1.perp_dot(d2).recip();
    let (dpdu, dpdv) = ((e1 * d2.y - e2 * d1.y) * inverse, (e2 * d1.x - e1 * d2.x) * inverse);
    (dpdu.is_finite() && dpdv.is_finite()).then_some(Derivatives { dpdu: dpdu.into(), dpdv: dpdv.into() })
}

/// Where `ray` meets triangle `p`, from either side (Möller & Trumbore 1997, in f64). For one triangle at a time;
/// meshes are traced by [`crate::bvh`].
pub fn intersect_triangle(ray: &Ray, [a, b, c]: [Vec3; 3]) -> Option<PrimitiveHit> {
    let (o, d, a) = (ray.o.as_dvec3(), ray.d.as_dvec3(), a.as_dvec3());
    let (e1, e2) = (b.as_dvec3() - a, c.as_dvec3() - a);
    let h = d.cross(e2);
    let det = e1.dot(h);
    if det == 0.0 {
        return None;
    }
    let s = o - a;
    let q = s.cross(e1);
    let (u, v, t) = (s.dot(h) / det, d.dot(q) / det, e2.dot(q) / det);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < f64::from(ray.t_max)).then_some(PrimitiveHit {
        t: t as f32,
        u: u as f32,
        v: v as f32,
    })
}
