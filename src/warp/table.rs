//! Piecewise-constant densities on the unit interval and square.

use super::to_unit;

/// Steps of probability: the numbers of the samplers are multiples of 2⁻²⁴, so a table of such multiples is drawn
/// with exactly the probabilities that it states.
const GRID: u32 = 1 << 24;

/// A draw from a [`Table1`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draw1 {
    /// Where, in [0, 1).
    pub x: f32,
    /// Density over [0, 1).
    pub pdf: f32,
    /// Which entry.
    pub index: usize,
}

/// A draw from a [`Table2`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draw2 {
    /// Where, in [0, 1)².
    pub p: [f32; 2],
    /// Density over [0, 1)².
    pub pdf: f32,
    /// Column and row.
    pub index: [usize; 2],
}

/// A density on [0, 1) that is constant on each of n equal intervals, or a choice among n entries.
///
/// Probabilities are multiples of 2⁻²⁴ and at least that for every positive weight, so nothing that may matter is
/// lost however large its neighbours are; `pdf` and `probability` state the law that is drawn, not the one that was
/// asked for, from which each differs by less than n 2⁻²⁴ of the whole.
#[derive(Clone, Debug)]
pub struct Table1 {
    /// n + 1 numbers, 0 to 1.
    cdf: Vec<f32>,
    total: f64,
}

impl Table1 {
    /// Proportional to `weights`; `None` where none is positive, one is negative or not finite, or there are more
    /// than 2²³.
    pub fn new(weights: &[f32]) -> Option<Self> {
        let mut cdf = vec![0.0; weights.len() + 1];
        let total = accumulate(weights, &mut cdf)?;
        Some(Self { cdf, total })
    }

    /// Number of entries.
    #[allow(clippy::len_without_is_empty)] // never empty
    pub fn len(&self) -> usize {
        self.cdf.len() - 1
    }

    /// Sum of the weights.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// The place at probability `u`; what is left of `u` places it within the entry.
    #[inline]
    pub fn sample(&self, u: f32) -> Draw1 {
        let (index, within, probability) = draw(&self.cdf, u);
        let n = self.len();
        Draw1 { x: place(index, within, n), pdf: probability * n as f32, index }
    }

    /// Chooses an entry at probability `u`: its index, its probability and what is left of `u`, uniform on [0, 1).
    #[inline]
    pub fn choose(&self, u: f32) -> (usize, f32, f32) {
        let (index, within, probability) = draw(&self.cdf, u);
        (index, probability, within)
    }

    /// Probability of an entry.
    #[inline]
    pub fn probability(&self, index: usize) -> f32 {
        self.cdf[index + 1] - self.cdf[index]
    }

    /// Density at `x`; 0 outside [0, 1).
    #[inline]
    pub fn pdf(&self, x: f32) -> f32 {
        if (0.0..1.0).contains(&x) { self.probability(bin(x, self.len())) * self.len() as f32 } else { 0.0 }
    }

    /// Inverse of [`Table1::sample`], for `x` where the density is positive.
    pub fn inverse(&self, x: f32) -> f32 {
        invert(&self.cdf, x)
    }
}

/// A density on [0, 1)² that is constant on each cell of a grid: a density over rows, and in each row one over columns.
#[derive(Clone, Debug)]
pub struct Table2 {
    size: [usize; 2],
    rows: Table1,
    /// `size[1]` distribution functions of `size[0]` + 1 numbers.
    columns: Vec<f32>,
}

impl Table2 {
    /// Proportional to `weights`, `size` = columns and rows, row by row; `None` as for [`Table1::new`], or where the
    /// number of weights is another.
    pub fn new(weights: &[f32], size: [usize; 2]) -> Option<Self> {
        let [width, height] = size;
        if width.checked_mul(height) != Some(weights.len()) || weights.is_empty() {
            return None;
        }
        // A row without weight is never drawn and stays 0.
        let mut columns = vec![0.0; (width + 1) * height];
        let mut row_weights = Vec::with_capacity(height);
        for (row, cdf) in weights.chunks_exact(width).zip(columns.chunks_exact_mut(width + 1)) {
            let valid = row.iter().all(|w| *w >= 0.0 && w.is_finite());
            row_weights.push(if row.iter().all(|&w| w == 0.0) { 0.0 } else { accumulate(row, cdf)? });
            valid.then_some(())?;
        }
        // Rows are weighed by their share of the greatest, so that no sum leaves the range of f32.
        let greatest = row_weights.iter().copied().fold(0.0, f64::max);
        let shares: Vec<f32> = row_weights
            .iter()
            .map(|&w| if w > 0.0 { ((w / greatest) as f32).max(f32::MIN_POSITIVE) } else { 0.0 })
            .collect();
        let mut rows = Table1::new(&shares)?;
        rows.total = row_weights.iter().sum();
        Some(Self { size, rows, columns })
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Sum of the weights.
    pub fn total(&self) -> f64 {
        self.rows.total
    }

    /// The place at `u`; `u[1]` chooses the row.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> Draw2 {
        let (index, within, pdf) = self.choose(u);
        Draw2 { p: [0, 1].map(|i| place(index[i], within[i], self.size[i])), pdf, index }
    }

    /// Chooses a cell: its column and row, what is left of `u`, uniform on [0, 1)², and the density over [0, 1)².
    #[inline]
    pub fn choose(&self, u: [f32; 2]) -> ([usize; 2], [f32; 2], f32) {
        let (row, y, row_probability) = draw(&self.rows.cdf, u[1]);
        let (column, x, probability) = draw(self.row(row), u[0]);
        let [width, height] = self.size.map(|n| n as f32);
        ([column, row], [x, y], row_probability * height * probability * width)
    }

    /// Density at `p`; 0 outside [0, 1)².
    #[inline]
    pub fn pdf(&self, p: [f32; 2]) -> f32 {
        if !p.iter().all(|x| (0.0..1.0).contains(x)) {
            return 0.0;
        }
        let cdf = self.row(bin(p[1], self.size[1]));
        let column = bin(p[0], self.size[0]);
        self.rows.pdf(p[1]) * (cdf[column + 1] - cdf[column]) * self.size[0] as f32
    }

    /// Inverse of [`Table2::sample`], for `p` where the density is positive.
    pub fn inverse(&self, p: [f32; 2]) -> [f32; 2] {
        [invert(self.row(bin(p[1], self.size[1])), p[0]), self.rows.inverse(p[1])]
    }

    #[inline]
    fn row(&self, index: usize) -> &[f32] {
        let stride = self.size[0] + 1;
        &self.columns[index * stride..][..stride]
    }
}

/// Fills the n + 1 numbers of a distribution function on the grid of 2⁻²⁴; returns the sum of the weights. Each
/// positive weight has one step reserved, the rest is shared in proportion and rounded in the running sum, so that
/// the last number is exactly 1.
fn accumulate(weights: &[f32], cdf: &mut [f32]) -> Option<f64> {
    if weights.len() > GRID as usize / 2 || !weights.iter().all(|w| *w >= 0.0 && w.is_finite()) {
        return None;
    }
    let total: f64 = weights.iter().map(|&w| w as f64).sum();
    let positive = weights.iter().filter(|w| **w > 0.0).count() as u32;
    if positive == 0 {
        return None;
    }
    let shared = (GRID - positive) as f64 / total;
    let (mut sum, mut reserved) = (0.0, 0);
    for (i, &w) in weights.iter().enumerate() {
        sum += w as f64;
        reserved += (w > 0.0) as u32;
        // The whole sum must give the whole grid, whatever the order of additions rounded to.
        let steps = if reserved == positive { GRID } else { reserved + (sum * shared).round() as u32 };
        cdf[i + 1] = steps as f32 / GRID as f32;
    }
    Some(total)
}

/// Entry whose interval of the distribution function holds `u`, how far in it `u` lies, and its probability.
#[inline]
fn draw(cdf: &[f32], u: f32) -> (usize, f32, f32) {
    // cdf[0] = 0 ≤ u: the entry is the last that begins at u or before. Empty entries begin where the next one does.
    // Halved without branches, which would be guessed wrong half of the time.
    let (mut index, mut size) = (0, cdf.len() - 1);
    while size > 1 {
        let half = size / 2;
        index += usize::from(cdf[index + half] <= u) * half;
        size -= half;
    }
    let (low, probability) = (cdf[index], cdf[index + 1] - cdf[index]);
    (index, to_unit((u - low) / probability), probability)
}

/// The number of the unit interval that lies `within` an entry of n. Where rounding carries it over an edge it is brought
/// back: the next entry may have no weight at all.
#[inline]
fn place(index: usize, within: f32, n: usize) -> f32 {
    let mut x = to_unit((index as f32 + within) / n as f32);
    while bin(x, n) > index {
        x = x.next_down();
    }
    while bin(x, n) < index {
        x = x.next_up();
    }
    x
}

/// Inverse of [`draw`] for the place `x` of the unit interval.
fn invert(cdf: &[f32], x: f32) -> f32 {
    let n = cdf.len() - 1;
    let index = bin(x, n);
    let within = to_unit(x * n as f32 - index as f32);
    to_unit(cdf[index] + within * (cdf[index + 1] - cdf[index]))
}

/// Interval of n that holds `x`.
#[inline]
fn bin(x: f32, n: usize) -> usize {
    ((x * n as f32) as usize).min(n - 1)
}
