//! Shapes: how rays meet them and how points on them are drawn.

use glam::{Vec2, Vec3, Vec4};

/// A point of a surface with what shading needs, in world space (or object space before it is placed).
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// The point.
    pub p: Vec3,
    /// Absolute error bound of each coordinate of `p`.
    pub p_error: Vec3,
    /// Geometric normal, unit, towards the front side (whichever side the ray came from).
    pub ng: Vec3,
    /// Shading normal, unit, in the hemisphere of `ng`.
    pub ns: Vec3,
    /// Direction in which u grows; not normalised, 0 where unknown.
    pub tangent: Vec3,
    /// Sign of the bitangent: ns × tangent × handedness.
    pub handedness: f32,
    /// Texture coordinates, both sets.
    pub uv: [Vec2; 2],
    /// Vertex colour, linear RGBA; 1 where there is none.
    pub color: Vec4,
}
