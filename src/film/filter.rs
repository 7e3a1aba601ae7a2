//! Pixel filters by importance sampling (Ernst, Stamminger, Greiner 2006): a sample belongs to one pixel and lands around
//! its centre with the filter as density, so every weight is 1 and pixels stay independent.

use crate::desc::Filter;
use crate::warp::{blackman_harris, gaussian};
use glam::Vec2;
use std::sync::LazyLock;

/// Standard deviation of the Gaussian filter \[px\].
const SIGMA: f64 = 0.5;

/// Half the width of the Gaussian and the Blackman–Harris filter \[px\].
const RADIUS: f64 = 1.5;

static GAUSSIAN: LazyLock<HalfTable> = LazyLock::new(|| HalfTable::new(|x| gaussian(x, SIGMA)));
static HARRIS: LazyLock<HalfTable> = LazyLock::new(|| HalfTable::new(|x| blackman_harris(x, RADIUS)));

/// Half the width of the filter's square support \[px\].
pub fn filter_radius(filter: Filter) -> f32 {
    match filter {
        Filter::Box => 0.5,
        Filter::Gaussian | Filter::BlackmanHarris => RADIUS as f32,
    }
}

/// Offset from the pixel's centre \[px\], distributed as the filter, from `u` in the unit square. Separable: each axis by
/// the inverse of its distribution function.
#[inline]
pub fn filter_offset(filter: Filter, u: [f32; 2]) -> Vec2 {
    match filter {
        Filter::Box => Vec2::from(u) - 0.5,
        Filter::Gaussian => Vec2::from(u.map(|u| GAUSSIAN.invert(u))),
        Filter::BlackmanHarris => Vec2::from(u.map(|u| HARRIS.invert(u))),
    }
}

/// The filter, normalised \[1/px²\]: the density of [`filter_offset`] to within 1e-4 of its maximum.
pub fn filter_density(filter: Filter, offset: Vec2) -> f64 {
    let axis = |x: f32| {
        let x = f64::from(x);
        match filter {
            _ if x.abs() > f64::from(filter_radius(filter)) => 0.0,
            Filter::Box => 1.0,
            Filter::Gaussian => gaussian(x, SIGMA) / GAUSSIAN.integral,
            Filter::BlackmanHarris => blackman_harris(x, RADIUS) / HARRIS.integral,
        }
    };
    axis(offset.x) * axis(offset.y)
}

/// Cells over the positive half of one axis. The share of each is exact and the density inside it linear.
const CELLS: usize = 512;

/// Inverse distribution function of an even density on [−[`RADIUS`], [`RADIUS`]].
struct HalfTable {
    /// ∫ of the density as given.
    integral: f64,
    /// Share of the right half up to each border between cells, from 0 to 1.
    cdf: Vec<f64>,
    /// Density at the borders, as given.
    density: Vec<f64>,
    /// The cell in which `i / CELLS` of the mass is reached: where the search starts.
    guide: Vec<usize>,
}

impl HalfTable {
    fn new(density: impl Fn(f64) -> f64) -> Self {
        // Integrate each cell by Simpson's rule: exact to 1e-12 for these filters.
        let width = RADIUS / CELLS as f64;
        let at = |i: f64| density(i * width);
        let simpson = |i: usize| {
            let i = i as f64;
            (at(i) + 4.0 * at(i + 0.5) + at(i + 1.0)) * width / 6.0
        };
        let mut sums = vec![0.0];
        (0..CELLS).for_each(|i| sums.push(sums[i] + simpson(i)));
        let half = sums[CELLS];
        let cdf: Vec<f64> = sums.iter().map(|s| s / half).collect();
        let start = |i: usize| cdf.partition_point(|&c| c <= i as f64 / CELLS as f64).clamp(1, CELLS) - 1;
        let guide = (0..=CELLS).map(start).collect();
        Self { integral: 2.0 * half, cdf, density: (0..=CELLS).map(|i| at(i as f64)).collect(), guide }
    }

    #[inline]
    fn invert(&self, u: f32) -> f32 {
        // Fold at the middle: the table holds the right half of an even density.
        let signed = 2.0 * f64::from(u) - 1.0;
        let v = signed.abs();
        // Find the cell that holds v.
        let mut i = self.guide[((v * CELLS as f64) as usize).min(CELLS)];
        while i + 1 < CELLS && self.cdf[i + 1] <= v {
            i += 1;
        }
        // Invert the linear density a + (b − a) t inside it: share = (a t + (b − a) t²/2) / ((a + b)/2).
        let share = (v - self.cdf[i]) / (self.cdf[i + 1] - self.cdf[i]);
        let (a, b) = (self.density[i], self.density[i + 1]);
        let t = share * (a + b) / (a + (a * a + share * (b * b - a * a)).max(0.0).sqrt());
        ((i as f64 + t.clamp(0.0, 1.0)) * (RADIUS / CELLS as f64)).copysign(signed) as f32
    }
}
