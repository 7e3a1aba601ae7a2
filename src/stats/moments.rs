//! Mean and variance of a stream of numbers.

/// Number, mean and sum of squared deviations of what was pushed (Welford 1962); two of them merge exactly as if one
/// had seen both streams (Chan, Golub & LeVeque 1979).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    n: u64,
    mean: f64,
    m2: f64,
}

impl Moments {
    /// Of nothing.
    pub const fn new() -> Self {
        Self { n: 0, mean: 0.0, m2: 0.0 }
    }

    /// From the sums Σ1, Σx and Σx².
    pub fn from_sums(n: u64, sum: f64, sum2: f64) -> Self {
        let mean = if n == 0 { 0.0 } else { sum / n as f64 };
        Self { n, mean, m2: (sum2 - mean * sum).max(0.0) }
    }

    /// Takes one number.
    #[inline]
    pub fn push(&mut self, x: f64) {
        self.n += 1;
        let d = x - self.mean;
        self.mean += d / self.n as f64;
        self.m2 += d * (x - self.mean);
    }

    /// Takes all that `other` saw.
    pub fn merge(&mut self, other: &Self) {
        if other.n == 0 {
            return;
        }
        let n = (self.n + other.n) as f64;
        let d = other.mean - self.mean;
        self.mean += d * other.n as f64 / n;
        self.m2 += other.m2 + d * d * self.n as f64 * other.n as f64 / n;
        self.n += other.n;
    }

    /// How many numbers.
    pub fn n(&self) -> u64 {
        self.n
    }

    /// Σx/n; 0 of nothing.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Unbiased sample variance Σ(x − x̄)²/(n − 1); infinite for n < 2, where nothing is known.
    pub fn variance(&self) -> f64 {
        if self.n < 2 { f64::INFINITY } else { self.m2 / (self.n - 1) as f64 }
    }

    /// Standard error √(s²/n) of the mean.
    pub fn standard_error(&self) -> f64 {
        (self.variance() / self.n.max(1) as f64).sqrt()
    }

    /// z of the mean against its exact value.
    pub fn z(&self, exact: f64) -> f64 {
        super::z(self.mean, exact, self.standard_error())
    }
}

impl FromIterator<f64> for Moments {
    fn from_iter<I: IntoIterator<Item = f64>>(numbers: I) -> Self {
        let mut moments = Self::new();
        moments.extend(numbers);
        moments
    }
}

impl Extend<f64> for Moments {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, numbers: I) {
        numbers.into_iter().for_each(|x| self.push(x));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn merging_is_seeing_both(a in prop::collection::vec(-1e3f64..1e3, 0..40), b in prop::collection::vec(-1e3f64..1e3, 2..40)) {
            let mut merged: Moments = a.iter().copied().collect();
            merged.merge(&b.iter().copied().collect());
            let all: Vec<f64> = a.iter().chain(&b).copied().collect();
            let n = all.len() as f64;
            let mean = all.iter().sum::<f64>() / n;
            let variance = all.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
            prop_assert_eq!(merged.n(), all.len() as u64);
            prop_assert!((merged.mean() - mean).abs() < 1e-10 * 1e3);
            prop_assert!((merged.variance() - variance).abs() < 1e-10 * 1e6);
            let sums = Moments::from_sums(all.len() as u64, all.iter().sum(), all.iter().map(|x| x * x).sum());
            prop_assert!((sums.variance() - variance).abs() < 1e-9 * 1e6);
        }
    }

    #[test]
    fn one_number_has_no_known_error() {
        let one: Moments = [3.0].into_iter().collect();
        assert_eq!((one.mean(), one.standard_error()), (3.0, f64::INFINITY));
    }
}
