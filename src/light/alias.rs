//! The alias method on integers.

/// Steps of probability: samplers give multiples of 2⁻²⁴.
const BITS: u32 = 24;

/// A choice among n entries by one look-up (Walker 1977; Vose 1991).
///
/// The 2²⁴ numbers that a sampler can give are dealt out to the entries as whole numbers of steps, at least one to each
/// positive weight, and packed into 2ᵏ ≥ n columns of equal height that hold at most two entries each. All in
/// integers: [`probability`](Self::probability) is exactly the share of numbers on which [`choose`](Self::choose)
/// gives the entry.
#[derive(Clone, Debug)]
pub struct Alias {
    columns: Vec<Column>,
    /// log₂ of a column's height.
    shift: u32,
    /// Of each entry.
    probability: Vec<f32>,
}

/// The lower `split` steps belong to the column's own entry, the others to `other`.
#[derive(Clone, Copy, Debug)]
struct Column {
    split: u32,
    other: u32,
}

impl Alias {
    /// Most entries.
    pub const MAX: usize = 1 << (BITS - 1);

    /// Proportional to `weights`, up to rounding to steps of 2⁻²⁴; `None` where none is positive, one is negative or
    /// not finite, or there are more than [`MAX`](Self::MAX).
    pub fn new(weights: &[f64]) -> Option<Self> {
        let steps = deal(weights)?;
        let n = steps.len().next_power_of_two();
        let shift = BITS - n.trailing_zeros();
        let height = 1u32 << shift;

        // Each short entry's column is filled up by a tall one, which may become short by that.
        let mut rest: Vec<u32> = steps.iter().copied().chain(std::iter::repeat(0)).take(n).collect();
        let mut columns: Vec<Column> = (0..n as u32).map(|i| Column { split: height, other: i }).collect();
        let (mut short, mut tall): (Vec<usize>, Vec<usize>) = (0..n).partition(|&i| rest[i] < height);
        while let (Some(i), Some(&j)) = (short.pop(), tall.last()) {
            columns[i] = Column { split: rest[i], other: j as u32 };
            rest[j] -= height - rest[i];
            if rest[j] < height {
                tall.pop();
                short.push(j);
            }
        }
        let probability = steps.iter().map(|&s| s as f32 / (1u32 << BITS) as f32).collect();
        Some(Self { columns, shift, probability })
    }

    /// The entry at `u` in \[0, 1).
    #[inline]
    pub fn choose(&self, u: f32) -> usize {
        let step = ((u * (1u32 << BITS) as f32) as u32).min((1 << BITS) - 1);
        let index = (step >> self.shift) as usize;
        let Column { split, other } = self.columns[index];
        if step & ((1 << self.shift) - 1) < split { index } else { other as usize }
    }

    /// Probability of an entry, exact.
    #[inline]
    pub fn probability(&self, index: usize) -> f32 {
        self.probability[index]
    }
}

/// Deals 2²⁴ steps out in proportion to the weights, at least one to each that is positive; the running sum is rounded,
/// so that nothing is lost.
fn deal(weights: &[f64]) -> Option<Vec<u32>> {
    let positive = weights.iter().filter(|&&w| w > 0.0).count() as u32;
    let greatest = weights.iter().copied().fold(0.0, f64::max);
    let valid = weights.iter().all(|w| *w >= 0.0 && w.is_finite());
    if positive == 0 || weights.len() > Alias::MAX || !valid {
        return None;
    }
    // Relative to the greatest, so that the sum is finite.
    let total: f64 = weights.iter().map(|w| w / greatest).sum();
    let shared = f64::from((1 << BITS) - positive);
    let (mut sum, mut seen, mut before) = (0.0, 0, 0);
    let steps = weights.iter().map(|&w| {
        sum += w / greatest;
        seen += u32::from(w > 0.0);
        let until = if seen == positive { 1 << BITS } else { seen + (sum / total * shared).round() as u32 };
        let steps = until - before;
        before = until;
        steps
    });
    Some(steps.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn probabilities_are_exact(weights in prop::collection::vec(prop_oneof![Just(0.0), 0.0..1e3f64, Just(1e-30)], 1..40)) {
            let Some(alias) = Alias::new(&weights) else {
                prop_assert!(weights.iter().all(|&w| w == 0.0));
                return Ok(());
            };
            // Every step belongs to one entry: count them column by column.
            let height = 1u64 << alias.shift;
            let mut counts = vec![0u64; alias.columns.len()];
            for (i, column) in alias.columns.iter().enumerate() {
                counts[i] += u64::from(column.split);
                counts[column.other as usize] += height - u64::from(column.split);
            }
            let total: f64 = weights.iter().sum();
            for (i, &w) in weights.iter().enumerate() {
                let p = counts[i] as f64 / f64::from(1u32 << BITS);
                prop_assert_eq!(p, f64::from(alias.probability(i)));
                prop_assert_eq!(p > 0.0, w > 0.0);
                prop_assert!((p - w / total).abs() <= (weights.len() + 1) as f64 / f64::from(1u32 << BITS));
            }
        }
    }

    #[test]
    fn one_entry_takes_all() {
        let alias = Alias::new(&[3.0]).unwrap();
        assert_eq!((alias.choose(0.0), alias.choose(0.999_999_94), alias.probability(0)), (0, 0, 1.0));
    }
}
