//! The alias method on integers.

/// Bits of the least table: samplers give multiples of 2⁻²⁴.
const BITS: u32 = 24;

/// Bits beyond those that number the columns, in tables of more than 2¹⁶ of them: their probabilities are as fine in
/// proportion as those of 16 entries in the least table.
const FINER: u32 = 20;

/// A choice among n entries by one look-up (Walker 1977; Vose 1991).
///
/// The 2²⁴ numbers that a sampler can give are dealt out to the entries as whole numbers of steps, at least one to each
/// positive weight, and packed into 2ᵏ ≥ n columns of equal height that hold at most two entries each. All in
/// integers: [`probability`](Self::probability) is exactly the share of numbers on which [`choose`](Self::choose)
/// gives the entry. Tables of more than 2¹⁶ columns are [`wide`](Self::is_wide): they have 2ᵏ⁺²⁰ steps, for numbers of as
/// many bits.
#[derive(Clone, Debug)]
pub struct Alias {
    columns: Vec<Column>,
    /// log₂ of a column's height.
    shift: u32,
    /// log₂ of the number of steps, and that number.
    bits: u32,
    steps: f64,
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
    /// Most entries: columns are numbered by u32.
    pub const MAX: usize = 1 << 31;

    /// Proportional to `weights`, up to rounding to whole steps; `None` where none is positive, one is negative or not
    /// finite, or there are more than [`MAX`](Self::MAX).
    pub fn new(weights: &[f64]) -> Option<Self> {
        let n = weights.len().next_power_of_two();
        let columns = n.trailing_zeros();
        let bits = if columns > 16 { columns + FINER } else { BITS };
        let steps = deal(weights, bits)?;
        let shift = bits - columns;
        let height = 1u64 << shift;

        // Each short entry's column is filled up by a tall one, which may become short by that.
        let mut rest: Vec<u64> = steps.iter().copied().chain(std::iter::repeat(0)).take(n).collect();
        let mut columns: Vec<Column> = (0..n as u32).map(|i| Column { split: height as u32, other: i }).collect();
        let (mut short, mut tall): (Vec<usize>, Vec<usize>) = (0..n).partition(|&i| rest[i] < height);
        while let (Some(i), Some(&j)) = (short.pop(), tall.last()) {
            columns[i] = Column { split: rest[i] as u32, other: j as u32 };
            rest[j] -= height - rest[i];
            if rest[j] < height {
                tall.pop();
                short.push(j);
            }
        }
        let probability = steps.iter().map(|&s| (s as f64 / (1u64 << bits) as f64) as f32).collect();
        Some(Self { columns, shift, bits, steps: (1u64 << bits) as f64, probability })
    }

    /// It has more steps than the numbers of a sampler: [`choose`](Self::choose) asks for a number of more than 24 bits.
    #[inline]
    pub fn is_wide(&self) -> bool {
        self.bits > BITS
    }

    /// The entry at `u` in \[0, 1).
    #[inline]
    pub fn choose(&self, u: f64) -> usize {
        // As i64, which is one instruction; the last step also for what has been rounded up to 1.
        let step = ((u * self.steps) as i64 as u64).min((1 << self.bits) - 1);
        let index = (step >> self.shift) as usize;
        let Column { split, other } = self.columns[index];
        let within = step & ((1 << self.shift) - 1);
        if within < u64::from(split) { index } else { other as usize }
    }

    /// Probability of an entry, exact up to 2²⁴ steps and else to half a unit in the last place.
    #[inline]
    pub fn probability(&self, index: usize) -> f32 {
        self.probability[index]
    }
}

/// Deals 2ᵇ steps out in proportion to the weights, at least one to each that is positive; the running sum is rounded, so
/// that nothing is lost.
fn deal(weights: &[f64], bits: u32) -> Option<Vec<u64>> {
    let positive = weights.iter().filter(|&&w| w > 0.0).count() as u64;
    let greatest = weights.iter().copied().fold(0.0, f64::max);
    let valid = weights.iter().all(|w| *w >= 0.0 && w.is_finite());
    if positive == 0 || weights.len() > Alias::MAX || !valid {
        return None;
    }
    // Relative to the greatest, so that the sum is finite.
    let total: f64 = weights.iter().map(|w| w / greatest).sum();
    let shared = ((1 << bits) - positive) as f64;
    let (mut sum, mut seen, mut before) = (0.0, 0, 0);
    let steps = weights.iter().map(|&w| {
        sum += w / greatest;
        seen += u64::from(w > 0.0);
        let until = if seen == positive { 1 << bits } else { seen + (sum / total * shared).round() as u64 };
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
            prop_assert!(!alias.is_wide());
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
        assert_eq!((alias.choose(0.0), alias.choose(1.0 - f64::EPSILON), alias.probability(0)), (0, 0, 1.0));
    }

    /// More columns than there are numbers of 24 bits: every entry has its number, and its probability is close.
    #[test]
    fn many_entries_have_finer_steps() {
        let n = (1 << 17) + 5;
        let weights: Vec<f64> = (0..n).map(|i| if i == 70_000 { 1e5 } else { f64::from(i % 3) }).collect();
        let alias = Alias::new(&weights).unwrap();
        assert!(alias.is_wide());
        let total: f64 = weights.iter().sum();
        let mut counts = vec![0u64; alias.columns.len()];
        for (i, column) in alias.columns.iter().enumerate() {
            counts[i] += u64::from(column.split);
            counts[column.other as usize] += (1 << alias.shift) - u64::from(column.split);
        }
        for (i, &w) in weights.iter().enumerate() {
            let p = counts[i] as f64 / (1u64 << alias.bits) as f64;
            assert!(
                (p - f64::from(alias.probability(i))).abs() <= 1e-7 * p && (p - w / total).abs() <= 1e-5 * w / total
            );
        }
        // The middle of a column's lower part is its own.
        for i in [0, 1, 70_000, (1 << 17) + 1] {
            let u = (i as f64 + 0.5 * f64::from(alias.columns[i].split) / (1u64 << alias.shift) as f64)
                / alias.columns.len() as f64;
            assert!(alias.columns[i].split == 0 || alias.choose(u) == i);
        }
    }
}
