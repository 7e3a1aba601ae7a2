//! Counts of rare events beside their probability.

use statrs::distribution::{Beta, ContinuousCDF};

/// Interval that holds the probability of an event that came `count` times in `n` with confidence 0.95 at least
/// (Clopper & Pearson 1934).
pub fn clopper_pearson(count: usize, n: usize) -> [f64; 2] {
    let (k, n) = (count as f64, n as f64);
    let quantile = |a: f64, b: f64, p: f64| Beta::new(a, b).map_or(f64::NAN, |beta| beta.inverse_cdf(p));
    let low = if k > 0.0 { quantile(k, n - k + 1.0, 0.025) } else { 0.0 };
    let high = if k < n { quantile(k + 1.0, n - k, 0.975) } else { 1.0 };
    [low, high]
}

/// P(X ≥ count) of a Poisson number.
pub fn poisson_above(count: usize, mean: f64) -> f64 {
    let term = |k: usize| (k as f64 * mean.ln() - mean - (1..=k).map(|i| (i as f64).ln()).sum::<f64>()).exp();
    if count == 0 { 1.0 } else { (1.0 - (0..count).map(term).sum::<f64>()).max(0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_the_tabulated_ones() {
        // None of 1000: the rule of three, exactly 1 − 0.025^(1/1000).
        let [low, high] = clopper_pearson(0, 1000);
        assert!(low == 0.0 && (high - (1.0 - 0.025f64.powf(1e-3))).abs() < 1e-6, "{high}");
        // 4 of 20: 0.0573 … 0.4366.
        let [low, high] = clopper_pearson(4, 20);
        assert!((low - 0.057_334).abs() < 1e-5 && (high - 0.436_614).abs() < 1e-5, "{low} {high}");
    }

    #[test]
    fn poisson_tail() {
        // P(X ≥ 2) of mean 1: 1 − 2/e.
        assert!((poisson_above(2, 1.0) - (1.0 - 2.0 * (-1f64).exp())).abs() < 1e-12);
        assert_eq!(poisson_above(0, 1.0), 1.0);
    }
}
