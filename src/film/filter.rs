//! Pixel filters by importance sampling (Ernst, Stamminger, Greiner 2006): a sample belongs to one pixel and lands around
//! its centre with the filter as density, so every weight is 1 and pixels stay independent.

use crate::desc::Filter;
use glam::Vec2;
use std::f64::consts::{FRAC_1_SQRT_2, PI};
use std::sync::LazyLock;

/// Standard deviation of the Gaussian filter \[px\].
const SIGMA: f64 = 0.5;

/// Coefficients of the four-term Blackman–Harris window (Harris 1978, minimum side lobes).
const BLACKMAN_HARRIS: [f64; 4] = [0.358_75, 0.488_29, 0.141_28, 0.011_68];

/// Half the width of the filter's square support \[px\].
pub fn filter_radius(filter: Filter) -> f32 {
    match filter {
        Filter::Box => 0.5,
        Filter::Gaussian | Filter::BlackmanHarris => 1.5,
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

/// Density of [`filter_offset`] \[1/px²\]: the filter, normalised.
pub fn filter_density(filter: Filter, offset: Vec2) -> f64 {
    let radius = f64::from(filter_radius(filter));
    let axis = |x: f64| if x.abs() <= radius { density(filter, x) } else { 0.0 };
    axis(f64::from(offset.x)) * axis(f64::from(offset.y))
}

/// One axis of the filter, normalised, inside its support \[1/px\].
fn density(filter: Filter, x: f64) -> f64 {
    match filter {
        Filter::Box => 1.0,
        Filter::Gaussian => {
            let inside = statrs::function::erf::erf(1.5 / SIGMA * FRAC_1_SQRT_2);
            (-0.5 * (x / SIGMA).powi(2)).exp() / (SIGMA * (2.0 * PI).sqrt() * inside)
        }
        Filter::BlackmanHarris => {
            let wave = |k: usize| BLACKMAN_HARRIS[k] * (PI * k as f64 * x / 1.5).cos();
            (0..4).map(wave).sum::<f64>() / (3.0 * BLACKMAN_HARRIS[0])
        }
    }
}

/// ∫ of [`density`] from 0 to x, in closed form.
fn mass(filter: Filter, x: f64) -> f64 {
    match filter {
        Filter::Box => x,
        Filter::Gaussian => {
            let erf = |x: f64| statrs::function::erf::erf(x / SIGMA * FRAC_1_SQRT_2);
            0.5 * erf(x) / erf(1.5)
        }
        Filter::BlackmanHarris => {
            let wave = |k: usize| BLACKMAN_HARRIS[k] * (PI * k as f64 * x / 1.5).sin() * 1.5 / (PI * k as f64);
            (BLACKMAN_HARRIS[0] * x + (1..4).map(wave).sum::<f64>()) / (3.0 * BLACKMAN_HARRIS[0])
        }
    }
}

static GAUSSIAN: LazyLock<HalfTable> = LazyLock::new(|| HalfTable::new(Filter::Gaussian));
static HARRIS: LazyLock<HalfTable> = LazyLock::new(|| HalfTable::new(Filter::BlackmanHarris));

/// Cells over the positive half of one axis. The share of each cell is exact and the density inside it linear, which is
/// within 1e-5 of the filter everywhere.
const CELLS: usize = 512;

/// Inverse distribution function of an even density.
struct HalfTable {
    /// Width of a cell \[px\].
    width: f64,
    /// 2 ∫₀ˣ density at the cells' borders; ends at 1.
    cdf: Vec<f64>,
    /// Density at the border relative to the next one's, as (left, right) of each cell.
    ends: Vec<(f64, f64)>,
    /// The cell in which `i / CELLS` of the mass is reached: where the search starts.
    guide: Vec<usize>,
}

impl HalfTable {
    fn new(filter: Filter) -> Self {
        let width = f64::from(filter_radius(filter)) / CELLS as f64;
        let mut cdf: Vec<f64> = (0..=CELLS).map(|i| 2.0 * mass(filter, i as f64 * width)).collect();
        cdf[CELLS] = 1.0;
        let border = |i: usize| density(filter, i as f64 * width);
        let ends = (0..CELLS).map(|i| (border(i), border(i + 1))).collect();
        let start = |i: usize| cdf.partition_point(|&c| c <= i as f64 / CELLS as f64).clamp(1, CELLS) - 1;
        let guide = (0..=CELLS).map(start).collect();
        Self { width, cdf, ends, guide }
    }

    #[inline]
    fn invert(&self, u: f32) -> f32 {
        // Fold at the middle: the density is even and the table holds its right half.
        let signed = 2.0 * f64::from(u) - 1.0;
        let v = signed.abs();
        // Find the cell that holds v.
        let mut i = self.guide[((v * CELLS as f64) as usize).min(CELLS)];
        while i + 1 < CELLS && self.cdf[i + 1] <= v {
            i += 1;
        }
        // Invert the linear density a + (b − a) t inside it: v' = (a t + (b − a) t²/2) / ((a + b)/2).
        let v = (v - self.cdf[i]) / (self.cdf[i + 1] - self.cdf[i]);
        let (a, b) = self.ends[i];
        let t = v * (a + b) / (a + (a * a + v * (b * b - a * a)).max(0.0).sqrt());
        ((i as f64 + t.clamp(0.0, 1.0)) * self.width).copysign(signed) as f32
    }
}
