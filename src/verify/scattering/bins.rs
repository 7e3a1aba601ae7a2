//! Bins of direction that follow the draws of a function.
//!
//! On either side of the surface, directions are (h, φ) with h = 1 − |cos θ|, in which solid angle is area: dω = dh dφ.
//! h is computed from the sine, so that it resolves lobes about the normal. Rows are quantiles of h among the draws of a
//! pilot run, columns quantiles of φ within a row: every bin is about as likely as the others, and a lobe of width
//! 10⁻³ fills as many of them as a broad one. The horizon is the edge h = 1.

use super::quadrature::{Integral, Rectangle, integrate};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Rows, and columns of a row, of a side that is often drawn.
const MOST: usize = 16;

/// Bins of one side of the surface.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    /// 1 above, −1 below.
    side: f64,
    /// Azimuth about which φ in [−π, π] is measured.
    zero: f64,
    rows: Vec<f64>,
    /// Edges within each row.
    columns: Vec<Vec<f64>>,
    /// Further cuts for integrals, in the tails of h and of φ.
    row_cuts: Vec<f64>,
    column_cuts: Vec<Vec<f64>>,
}

/// h, without cancellation near the normal.
fn height(w: DVec3) -> f64 {
    let sin2 = w.x * w.x + w.y * w.y;
    sin2 / (1.0 + (1.0 - sin2).max(0.0).sqrt())
}

/// Values of `sorted` at these shares of its length, between the outermost edges; equal ones are one.
fn quantiles(sorted: &[f64], shares: impl Iterator<Item = f64>, [low, high]: [f64; 2]) -> Vec<f64> {
    let mut edges = vec![low];
    for share in shares {
        let i = ((share * sorted.len() as f64) as usize).clamp(1, sorted.len() - 1);
        // Between two draws, so that rounding puts none on an edge.
        let edge = 0.5 * (sorted[i - 1] + sorted[i]);
        if edge > edges[edges.len() - 1] && edge < high {
            edges.push(edge);
        }
    }
    edges.push(high);
    edges
}

fn inner(n: usize) -> impl Iterator<Item = f64> {
    (1..n).map(move |i| i as f64 / n as f64)
}

/// Where tails are cut, beside the edges of bins.
fn tails() -> impl Iterator<Item = f64> {
    [3e-4, 2e-3, 1e-2, 0.99, 0.998, 0.9997].into_iter()
}

impl Bins {
    /// Of one side, for the draws of a pilot run.
    pub(super) fn new(side: f64, pilot: &[DVec3]) -> Self {
        let mean: DVec3 = pilot.iter().filter(|w| w.z * side > 0.0).sum();
        let zero = mean.y.atan2(mean.x);
        let mut this =
            Self { side, zero, rows: Vec::new(), columns: Vec::new(), row_cuts: Vec::new(), column_cuts: Vec::new() };
        let mut places: Vec<[f64; 2]> = pilot.iter().filter(|w| w.z * side > 0.0).map(|&w| this.place(w)).collect();
        let n = ((places.len() as f64 / 40.0).sqrt() as usize).min(MOST);
        if n < 2 {
            // Seldom drawn: a coarse net over all of it.
            this.rows = (0..=4).map(|i| f64::from(i) / 4.0).collect();
            this.columns = vec![(0..=4).map(|i| PI * (f64::from(i) / 2.0 - 1.0)).collect(); 4];
            (this.row_cuts, this.column_cuts) = (this.rows.clone(), this.columns.clone());
            return this;
        }
        places.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let heights: Vec<f64> = places.iter().map(|p| p[0]).collect();
        this.rows = quantiles(&heights, inner(n), [0.0, 1.0]);
        this.row_cuts = quantiles(&heights, tails(), [0.0, 1.0]);
        for row in this.rows.windows(2) {
            let mut azimuths: Vec<f64> =
                places.iter().filter(|p| (row[0]..row[1]).contains(&p[0])).map(|p| p[1]).collect();
            azimuths.sort_by(f64::total_cmp);
            this.columns.push(quantiles(&azimuths, inner(n), [-PI, PI]));
            this.column_cuts.push(quantiles(&azimuths, tails(), [-PI, PI]));
        }
        this
    }

    fn place(&self, w: DVec3) -> [f64; 2] {
        let phi = (w.y.atan2(w.x) - self.zero + PI).rem_euclid(TAU) - PI;
        [height(w), phi]
    }

    fn direction(&self, h: f64, phi: f64) -> DVec3 {
        let r = (h * (2.0 - h)).max(0.0).sqrt();
        let (sin, cos) = (phi + self.zero).sin_cos();
        DVec3::new(r * cos, r * sin, self.side * (1.0 - h))
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.columns.iter().map(|c| c.len() - 1).sum()
    }

    /// Columns of the rectangle, where all rows have the same number.
    pub(super) fn width(&self) -> Option<usize> {
        let n = self.columns.first()?.len();
        self.columns.iter().all(|c| c.len() == n).then(|| n - 1)
    }

    /// The bin of a direction on this side.
    pub(super) fn find(&self, w: DVec3) -> Option<usize> {
        if w.z * self.side <= 0.0 {
            return None;
        }
        let [h, phi] = self.place(w);
        let within = |edges: &[f64], x: f64| edges.partition_point(|&e| e <= x).clamp(1, edges.len() - 1) - 1;
        let row = within(&self.rows, h);
        let before: usize = self.columns[..row].iter().map(|c| c.len() - 1).sum();
        Some(before + within(&self.columns[row], phi))
    }

    /// ∫ f dω over each bin, and the sum of the errors seen.
    pub(super) fn integrate<const K: usize>(&self, f: impl Fn(DVec3) -> [f64; K]) -> (Vec<[f64; K]>, f64) {
        let of = |h: f64, phi: f64| f(self.direction(h, phi));
        let (mut values, mut error) = (Vec::with_capacity(self.len()), 0.0);
        for (row, (columns, cuts)) in self.rows.windows(2).zip(self.columns.iter().zip(&self.column_cuts)) {
            let rows = parts(row, &self.row_cuts);
            for column in columns.windows(2) {
                let mut value = [0.0; K];
                for y in parts(column, cuts).windows(2) {
                    for x in rows.windows(2) {
                        let cell: Rectangle = [[x[0], x[1]], [y[0], y[1]]];
                        let Integral { value: part, error: seen } = integrate(&of, cell, TOLERANCE, DEPTH);
                        value = std::array::from_fn(|k| value[k] + part[k]);
                        error += seen;
                    }
                }
                values.push(value);
            }
        }
        (values, error)
    }
}

/// Largest difference between a cell and its parts that is let be.
const TOLERANCE: f64 = 1e-6;
/// Most cuts of a cell.
const DEPTH: u32 = 9;

/// The interval, cut where one of the `cuts` lies inside it.
fn parts(interval: &[f64], cuts: &[f64]) -> Vec<f64> {
    let [low, high] = [interval[0], interval[1]];
    let inside = cuts.iter().copied().filter(|&x| x > low && x < high);
    std::iter::once(low).chain(inside).chain([high]).collect()
}
