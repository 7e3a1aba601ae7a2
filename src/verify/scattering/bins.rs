//! Bins of direction that follow the draws of a function.
//!
//! On either side of the surface, directions are (h, φ) with h = 1 − |cos θ|, in which solid angle is area: dω = dh dφ.
//! h is computed from the sine, so that it resolves lobes about the normal. Rows are quantiles of h among the draws of a
//! pilot run, columns quantiles of φ within a row: every bin is about as likely as the others, and a lobe of width
//! 10⁻³ fills as many of them as a broad one. The horizon is the edge h = 1.

use super::quadrature::{Integral, Stop, integrate, split};
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
    /// Where the pilot run went, (h, φ).
    places: Vec<[f64; 2]>,
    /// Share of the draws that each of them stands for.
    share: f64,
}

/// h, without cancellation near the normal.
fn height(w: DVec3) -> f64 {
    let sin2 = w.x * w.x + w.y * w.y;
    sin2 / (1.0 + (1.0 - sin2).max(0.0).sqrt())
}

/// Edges that cut `sorted` into `n` equal parts, between the outermost ones; equal ones are one.
fn quantiles(sorted: &[f64], n: usize, [low, high]: [f64; 2]) -> Vec<f64> {
    let mut edges = vec![low];
    for k in 1..n {
        let i = (k * sorted.len() / n).max(1);
        // Between two draws, so that rounding puts none on an edge.
        let Some(pair) = sorted.get(i - 1..=i) else { continue };
        let edge = 0.5 * (pair[0] + pair[1]);
        if edge > edges[edges.len() - 1] && edge < high {
            edges.push(edge);
        }
    }
    edges.push(high);
    edges
}

/// The interval, cut at steps that grow by four from both ends: lobes have tails that reach far beyond their width.
fn graded([low, high]: [f64; 2], [first, last]: [f64; 2]) -> Vec<f64> {
    let mut cuts = vec![low, high];
    for (from, mut step) in [(low, first), (high, -last)] {
        while step != 0.0 && step.abs() < 0.5 * (high - low) {
            cuts.push(from + step);
            step *= 4.0;
        }
    }
    cuts.sort_by(f64::total_cmp);
    cuts
}

/// Cuts for integrals over each interval between `edges`: the outermost are cut at steps of their neighbours' size.
fn cuts(edges: &[f64]) -> Vec<Vec<f64>> {
    let n = edges.len() - 1;
    let width = |i: usize| edges[i + 1] - edges[i];
    let cut = |i: usize| {
        let first = if i + 1 == n && n > 2 { width(i - 1) } else { 0.0 };
        let last = if i == 0 && n > 2 { width(1) } else { 0.0 };
        graded([edges[i], edges[i + 1]], [first, last])
    };
    (0..n).map(cut).collect()
}

impl Bins {
    /// Of one side, for the directions of a pilot run of `draws`.
    pub(super) fn new(side: f64, pilot: &[DVec3], draws: u64) -> Self {
        let mean: DVec3 = pilot.iter().filter(|w| w.z * side > 0.0).sum();
        let (rows, columns, places) = (Vec::new(), Vec::new(), Vec::new());
        let mut this = Self { side, zero: mean.y.atan2(mean.x), rows, columns, places, share: 1.0 / draws as f64 };
        let mut places: Vec<[f64; 2]> = pilot.iter().filter(|w| w.z * side > 0.0).map(|&w| this.place(w)).collect();
        places.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let n = ((places.len() as f64 / 40.0).sqrt() as usize).min(MOST);
        if n < 2 {
            // Seldom drawn: a coarse net over all of it.
            this.rows = (0..=4).map(|i| f64::from(i) / 4.0).collect();
            this.columns = vec![(0..=4).map(|i| PI * (f64::from(i) / 2.0 - 1.0)).collect(); 4];
        } else {
            let heights: Vec<f64> = places.iter().map(|p| p[0]).collect();
            this.rows = quantiles(&heights, n, [0.0, 1.0]);
            for row in this.rows.windows(2) {
                let within = places.iter().filter(|p| (row[0]..row[1]).contains(&p[0]));
                let mut azimuths: Vec<f64> = within.map(|p| p[1]).collect();
                azimuths.sort_by(f64::total_cmp);
                this.columns.push(quantiles(&azimuths, n, [-PI, PI]));
            }
        }
        this.places = places;
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

    /// ∫ f dω over each bin, the first component of `f` being the density; and the sum of the errors seen.
    pub(super) fn integrate<const K: usize>(&self, f: impl Fn(DVec3) -> [f64; K]) -> (Vec<[f64; K]>, f64) {
        let of = |h: f64, phi: f64| f(self.direction(h, phi));
        let stop = Stop { tolerance: TOLERANCE, point: self.share, depth: DEPTH, rules: RULES };
        let (mut values, mut total) = (Vec::with_capacity(self.len()), Integral::default());
        let mut places = self.places.clone();
        let mut above = &mut places[..];
        for (cuts_h, columns) in cuts(&self.rows).iter().zip(&self.columns) {
            let high = cuts_h[cuts_h.len() - 1];
            let (row, rest) = split(above, |p| p[0] < high);
            above = rest;
            let mut right = row;
            for cuts_phi in cuts(columns) {
                let end = cuts_phi[cuts_phi.len() - 1];
                let (mut bin, rest) = split(right, |p| p[1] < end);
                right = rest;
                let before = total.value;
                for x in cuts_h.windows(2) {
                    let (mut strip, rest) = split(bin, |p| p[0] < x[1]);
                    bin = rest;
                    for y in cuts_phi.windows(2) {
                        let (cell, rest) = split(strip, |p| p[1] < y[1]);
                        strip = rest;
                        integrate(&of, [[x[0], x[1]], [y[0], y[1]]], cell, stop, &mut total);
                    }
                }
                values.push(std::array::from_fn(|k| total.value[k] - before[k]));
            }
        }
        (values, total.error)
    }
}

/// Largest difference between a cell and its parts that is let be.
const TOLERANCE: f64 = 1e-6;
/// Most cuts of a cell.
const DEPTH: u32 = 20;
/// Most rules on one side: where draws do not follow the density, following them would not end.
const RULES: u64 = 100_000;
