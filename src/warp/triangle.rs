//! Square → triangle.

use super::to_unit;

/// Barycentric coordinates (b₀, b₁, b₂) of a point uniform over a triangle's area (density 1/area): the square is cut
/// along the diagonal u₀ = u₁ and each half is sheared onto half the triangle, so that strata stay compact
/// (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
#[inline]
pub fn uniform_triangle(u: [f32; 2]) -> [f32; 3] {
    // Either half loses half of the lesser coordinate from both.
    let half = 0.5 * u[0].min(u[1]);
    let (b0, b1) = (u[0] - half, u[1] - half);
    [b0, b1, 1.0 - b0 - b1]
}

/// Inverse of [`uniform_triangle`], of the first two barycentric coordinates.
pub fn uniform_triangle_inverse(b: [f32; 2]) -> [f32; 2] {
    let u = if b[0] < b[1] { [2.0 * b[0], b[1] + b[0]] } else { [b[0] + b[1], 2.0 * b[1]] };
    u.map(to_unit)
}
