//! Numbers beside the law that they should follow.

use crate::stats::{Chi2, chi2_test, normal_cdf, two_sided_p};

/// How many of n numbers lie beyond a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tail {
    /// The limit on |z|.
    pub limit: f64,
    /// How many lie beyond.
    pub observed: usize,
    /// How many should on average.
    pub expected: f64,
}

/// Numbers that should follow the standard normal, beside it.
#[derive(Clone, Debug)]
pub struct Normality {
    /// How many there are.
    pub count: usize,
    /// Borders of the histogram's bins; below the first and above the last are bins too.
    pub edges: Vec<f64>,
    /// Numbers in each bin, one bin more than borders.
    pub observed: Vec<f64>,
    /// Numbers that the normal promises.
    pub expected: Vec<f64>,
    /// χ² over 32 bins of equal probability; says nothing (`dof` 0) of fewer than 160 numbers.
    pub chi2: Chi2,
    /// p-value of the largest distance between the distribution functions (Kolmogorov–Smirnov).
    pub kolmogorov: f64,
    /// |z| beyond 2, 3 and 4.
    pub tails: [Tail; 3],
}

/// Compares numbers with the standard normal. The tests assume that they are independent.
pub fn normality(z: &[f64]) -> Normality {
    let edges: Vec<f64> = (-16..=16).map(|i| 0.25 * f64::from(i)).collect();
    let n = z.len() as f64;
    let mut observed = vec![0.0; edges.len() + 1];
    z.iter().for_each(|&z| observed[edges.partition_point(|&edge| edge <= z)] += 1.0);
    let below = |i: usize| match i {
        0 => 0.0,
        i if i > edges.len() => 1.0,
        i => normal_cdf(edges[i - 1]),
    };
    let expected = (0..=edges.len()).map(|i| n * (below(i + 1) - below(i))).collect();
    let uniform: Vec<f64> = z.iter().map(|&z| normal_cdf(z)).collect();
    let tail = |limit: f64| Tail {
        limit,
        observed: z.iter().filter(|z| z.abs() > limit).count(),
        expected: n * two_sided_p(limit),
    };
    Normality {
        count: z.len(),
        edges,
        observed,
        expected,
        chi2: uniform_chi2(&uniform),
        kolmogorov: kolmogorov_smirnov(uniform),
        tails: [2.0, 3.0, 4.0].map(tail),
    }
}

/// χ² of numbers that should be uniform on [0, 1], over 32 bins.
pub(super) fn uniform_chi2(u: &[f64]) -> Chi2 {
    const BINS: usize = 32;
    let mut observed = vec![0.0; BINS];
    u.iter().for_each(|u| observed[((u * BINS as f64) as usize).min(BINS - 1)] += 1.0);
    chi2_test(&observed, &[u.len() as f64 / BINS as f64; BINS], 5.0)
}

/// p-value of the largest distance D of the empirical distribution function from the uniform one:
/// 2 Σ (−1)^(k−1) exp(−2k²λ²) with λ = (√n + 0.12 + 0.11/√n) D (Kolmogorov 1933; Stephens 1970). 1 of nothing.
pub fn kolmogorov_smirnov(mut u: Vec<f64>) -> f64 {
    if u.is_empty() {
        return 1.0;
    }
    u.sort_by(f64::total_cmp);
    let n = u.len() as f64;
    let off = |(i, &u): (usize, &f64)| (u - i as f64 / n).max((i as f64 + 1.0) / n - u);
    let d = u.iter().enumerate().map(off).fold(0.0, f64::max);
    let lambda = (n.sqrt() + 0.12 + 0.11 / n.sqrt()) * d;
    if lambda < 0.2 {
        return 1.0;
    }
    let term = |k: i32| if k % 2 == 1 { 2.0 } else { -2.0 } * (-2.0 * (f64::from(k) * lambda).powi(2)).exp();
    (1..100).map(term).sum::<f64>().clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::normal_quantile;

    #[test]
    fn kolmogorov_s_quantile() {
        // Of D = 1.3581/√n about 5 % in large samples: numbers shifted by it.
        let n = 100_000;
        let d = 1.358_1 / (n as f64).sqrt();
        let u = (0..n).map(|i| ((i as f64 + 0.5) / n as f64 * (1.0 - d)) + d).collect();
        assert!((kolmogorov_smirnov(u) - 0.05).abs() < 1e-3);
        assert_eq!(kolmogorov_smirnov(Vec::new()), 1.0);
    }

    #[test]
    fn a_histogram_holds_all_numbers() {
        let z: Vec<f64> = (0..1000).map(|i| normal_quantile((i as f64 + 0.5) / 1000.0)).chain([9.0, -9.0]).collect();
        let found = normality(&z);
        assert_eq!((found.observed.iter().sum::<f64>(), found.observed.len()), (1002.0, found.edges.len() + 1));
        assert!((found.expected.iter().sum::<f64>() - 1002.0).abs() < 1e-9);
        assert!(found.kolmogorov > 0.99 && found.chi2.p > 0.9 && found.tails[2].observed == 2);
    }
}
