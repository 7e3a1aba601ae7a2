//! A quadric divided by how brightly its parts shine.

use crate::spectrum::Spectrum;
use crate::warp::Table2;

/// Most cells along an axis.
const MOST: usize = 256;

/// Cells of a quadric that have equal areas in its own space, drawn in proportion to what they emit in the world.
///
/// They are the squares of a grid over the numbers that [`Quadric::sample_area`](crate::shape::Quadric::sample_area) maps to points without changing areas.
#[derive(Clone, Debug)]
pub(super) struct Grid(Table2);

impl Grid {
    /// Mean radiance over the surface, and cells as large as a step of what it shows, of which there are `steps` along an
    /// axis; at most `lookups` (at least 1) are made. `le` gives the radiance at a point drawn by these numbers, and how much
    /// of the world's area lies there. No cells where the brightest would be less than twice as bright as the mean.
    pub(super) fn new(
        le: impl Fn([f32; 2]) -> (Spectrum, f64),
        steps: f32,
        lookups: usize,
    ) -> (Spectrum, Option<Self>) {
        let most = lookups.isqrt().max(1);
        let n = (steps.ceil() as usize).clamp(1, MOST).min(most);
        let fine = ((1.5 * steps / n as f32).ceil() as usize).clamp(1, most / n);

        // The middles of a finer division, each counted to its cell.
        let (side, mut weights) = (n * fine, vec![0.0f64; n * n]);
        let (mut sum, mut area) = ([0.0f64; 3], 0.0);
        for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
            let (radiance, scale) = le([i, j].map(|k| (k as f32 + 0.5) / side as f32));
            let rgb = radiance.to_rgb().map(|x| f64::from(x) * scale);
            sum = [0, 1, 2].map(|c| sum[c] + rgb[c]);
            area += scale;
            weights[j / fine * n + i / fine] += f64::from(radiance.luminance()) * scale;
        }
        let mean = Spectrum::from_rgb(sum.map(|x| if area > 0.0 { (x / area) as f32 } else { 0.0 }));
        let greatest = weights.iter().copied().fold(0.0, f64::max);
        let uneven = greatest * (n * n) as f64 > 2.0 * weights.iter().sum::<f64>();
        let share = |&w: &f64| if w > 0.0 { ((w / greatest) as f32).max(f32::MIN_POSITIVE) } else { 0.0 };
        let table = if uneven { Table2::new(&weights.iter().map(share).collect::<Vec<_>>(), [n, n]) } else { None };
        (mean, table.map(Self))
    }

    /// Numbers of a point drawn.
    #[inline]
    pub(super) fn sample(&self, u: [f32; 2]) -> [f32; 2] {
        self.0.sample(u).p
    }

    /// Density of [`sample`](Self::sample) over the area in the quadric's own space, relative to the uniform one.
    #[inline]
    pub(super) fn density(&self, at: [f32; 2]) -> f32 {
        self.0.pdf(at.map(|x| x.clamp(0.0, 1.0f32.next_down())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Quadric;

    /// Points drawn lie where it is bright, the mean is exact, and the numbers of a point are those that it was drawn by.
    #[test]
    fn bright_cells_are_drawn() {
        let quadrics = [
            Quadric::Sphere { radius: 2.0 },
            Quadric::Disk { radius: 0.5 },
            Quadric::Cylinder { radius: 1.0, height: 3.0 },
        ];
        for quadric in quadrics {
            // One sixteenth of the area.
            let bright = |[a, b]: [f32; 2]| (0.25..0.5).contains(&a) && (0.5..0.75).contains(&b);
            let le = |at| (Spectrum::splat(if bright(at) { 16.0 } else { 0.0 }), 1.0);
            let (mean, grid) = Grid::new(le, 8.0, 1 << 16);
            assert_eq!(mean, Spectrum::splat(1.0));
            let grid = grid.expect("cells");
            for i in 0..100 {
                let u = [(i % 10) as f32 / 10.0 + 0.03, (i / 10) as f32 / 10.0 + 0.06];
                let at = grid.sample(u);
                let again = quadric.area_coordinates(&quadric.sample_area(at));
                assert!(bright(at) && (0..2).all(|k| (at[k] - again[k]).abs() < 1e-5), "{quadric:?} {at:?} {again:?}");
                assert_eq!(grid.density(again), 16.0);
            }
            assert_eq!(grid.density([0.1, 0.1]), 0.0);
        }
    }

    #[test]
    fn even_quadrics_are_not_divided() {
        let (mean, grid) = Grid::new(|[u, _]| (Spectrum::splat(1.0 + 0.1 * u), 1.0), 30.0, 1 << 16);
        assert!(grid.is_none() && (mean.luminance() - 1.05).abs() < 1e-4);
    }
}
