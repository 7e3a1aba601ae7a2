//! A triangle divided by how brightly its parts shine.

use crate::spectrum::Spectrum;
use crate::warp::{Table1, uniform_triangle};

/// Most cells along an edge.
const MOST: usize = 256;

/// The n² equal triangles that n − 1 parallels to each edge cut out of a triangle, drawn in proportion to their mean
/// radiance.
///
/// Cell (i, j) holds the points whose weights (u, v) of the second and third vertex have ⌊un⌋ = i and ⌊vn⌋ = j, the upper
/// half of it those whose fractions add up to more than 1.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    n: usize,
    /// Two entries for each pair (i, j).
    table: Table1,
}

impl Cells {
    /// Mean radiance over the triangle of `le(u, v)`, and cells as large as a step of what it shows, of which there are
    /// `steps` along the longest edge; at most `lookups` (at least 1) are made. No cells where the brightest would be
    /// less than twice as bright as the mean.
    pub(super) fn new(le: impl Fn([f32; 2]) -> Spectrum, steps: f32, lookups: usize) -> (Spectrum, Option<Self>) {
        let fine = |n: usize| (1.5 * steps / n as f32).ceil() as usize;
        let n = (steps.ceil() as usize).clamp(1, MOST).min(lookups.isqrt()).max(1);
        let side = n * fine(n).clamp(1, (lookups.isqrt() / n).max(1));

        // The middles of a finer division, each counted to its cell.
        let (mut sum, mut weights) = ([0.0f64; 3], vec![0.0; 2 * n * n]);
        for i in 0..side {
            for j in 0..side - i {
                for third in [1.0 / 3.0, 2.0 / 3.0] {
                    if third > 0.5 && i + j + 1 == side {
                        continue;
                    }
                    let at = [i, j].map(|k| (k as f32 + third) / side as f32);
                    let radiance = le(at);
                    let [r, g, b] = radiance.to_rgb().map(f64::from);
                    sum = [sum[0] + r, sum[1] + g, sum[2] + b];
                    weights[find(n, at)] += radiance.luminance();
                }
            }
        }
        let count = (side * side) as f64;
        let mean = Spectrum::from_rgb(sum.map(|x| (x / count) as f32));
        let greatest = weights.iter().copied().fold(0.0, f32::max);
        let total: f64 = weights.iter().map(|&w| f64::from(w)).sum();
        let uneven = f64::from(greatest) * (n * n) as f64 > 2.0 * total;
        let table = if uneven { Table1::new(&weights) } else { None };
        (mean, table.map(|table| Self { n, table }))
    }

    /// Weights of the second and third vertex at a point drawn.
    #[inline]
    pub(super) fn sample(&self, u: [f32; 2]) -> [f32; 2] {
        let (index, _, within) = self.table.choose(u[0]);
        let (i, j, upper) = (index / 2 / self.n, index / 2 % self.n, index % 2 == 1);
        let [_, s, t] = uniform_triangle([within, u[1]]);
        let [s, t] = if upper { [1.0 - s, 1.0 - t] } else { [s, t] };
        [(i as f32 + s) / self.n as f32, (j as f32 + t) / self.n as f32]
    }

    /// Density of [`sample`](Self::sample) over the triangle's area, relative to the uniform one.
    #[inline]
    pub(super) fn density(&self, at: [f32; 2]) -> f32 {
        self.table.probability(find(self.n, at)) * (self.n * self.n) as f32
    }
}

/// Entry of the cell that holds the point with these weights of the second and third vertex.
#[inline]
fn find(n: usize, at: [f32; 2]) -> usize {
    let [x, y] = at.map(|x| x.max(0.0) * n as f32);
    let i = (x as usize).min(n - 1);
    let j = (y as usize).min(n - 1 - i);
    let upper = i + j + 1 < n && (x - i as f32) + (y - j as f32) > 1.0;
    2 * (i * n + j) + usize::from(upper)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bright spot of one step is found, drawn, and its mean is exact.
    #[test]
    fn bright_cells_are_drawn() {
        let n = 8.0;
        let bright = |[u, v]: [f32; 2]| {
            (u * n).floor() == 3.0 && (v * n).floor() == 2.0 && (u * n).fract() + (v * n).fract() < 1.0
        };
        let (mean, cells) = Cells::new(|at| Spectrum::splat(if bright(at) { 64.0 } else { 0.0 }), n, 1 << 16);
        assert_eq!(mean, Spectrum::splat(1.0));
        let cells = cells.unwrap();
        for i in 0..100 {
            // Off the edges.
            let u = [(i % 10) as f32 / 10.0 + 0.03, (i / 10) as f32 / 10.0 + 0.06];
            let at = cells.sample(u);
            assert!(bright(at) || cells.density(at) == 0.0, "{at:?}");
        }
        assert_eq!(cells.density([0.4, 0.28]), 64.0);
        assert_eq!(cells.density([0.1, 0.1]), 0.0);
    }

    #[test]
    fn even_triangles_are_not_divided() {
        let (mean, cells) = Cells::new(|[u, _]| Spectrum::splat(1.0 + 0.1 * u), 30.0, 1 << 16);
        assert!(cells.is_none() && (mean.luminance() - 1.0 - 0.1 / 3.0).abs() < 1e-4);
    }
}
