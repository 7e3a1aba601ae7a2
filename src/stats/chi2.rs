//! Goodness of fit of counts.

use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Outcome of [`chi2_test`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chi2 {
    /// Σ (observed − expected)²/expected over the merged bins.
    pub statistic: f64,
    /// Merged bins − 1.
    pub dof: usize,
    /// Probability of a statistic this large if the expectation is right.
    pub p: f64,
}

/// Pearson's χ² test of `observed` counts against `expected` ones. Both lists have the same total in expectation:
/// where draws may fail, a bin counts the failures. Bins with less than `min_expected` (usually 5) are merged. A count
/// where nothing at all was expected, and anything not finite, gives p = 0; fewer than two merged bins decide nothing
/// (`dof` 0, p = 1).
pub fn chi2_test(observed: &[f64], expected: &[f64], min_expected: f64) -> Chi2 {
    assert_eq!(observed.len(), expected.len(), "as many observed as expected bins");
    let refused = Chi2 { statistic: f64::INFINITY, dof: 0, p: 0.0 };
    let mut bins: Vec<[f64; 2]> = Vec::with_capacity(observed.len());
    let mut pool = [0.0; 2];
    for (&o, &e) in observed.iter().zip(expected) {
        if !(o.is_finite() && e.is_finite() && e >= 0.0) || (e == 0.0 && o > 0.0) {
            return refused;
        }
        if e >= min_expected {
            bins.push([o, e]);
        } else {
            pool = [pool[0] + o, pool[1] + e];
            if pool[1] >= min_expected {
                bins.push(std::mem::take(&mut pool));
            }
        }
    }

    // What is left of the pool joins the smallest bin.
    if let Some(smallest) = bins.iter_mut().min_by(|a, b| a[1].total_cmp(&b[1])) {
        *smallest = [smallest[0] + pool[0], smallest[1] + pool[1]];
    }
    let statistic = bins.iter().map(|[o, e]| (o - e).powi(2) / e).sum();
    let dof = bins.len().saturating_sub(1);
    let p = match ChiSquared::new(dof as f64) {
        Ok(distribution) => distribution.sf(statistic),
        Err(_) => 1.0,
    };
    Chi2 { statistic, dof, p }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tabulated_quantile() {
        // Four bins of 100, statistic 7.8147: the 5 % point of three degrees of freedom.
        let d = (7.814_727_903_251_178f64 * 100.0 / 2.0).sqrt();
        let test = chi2_test(&[100.0 + d, 100.0 - d, 100.0, 100.0], &[100.0; 4], 5.0);
        assert_eq!(test.dof, 3);
        assert!((test.p - 0.05).abs() < 1e-9, "{}", test.p);
    }

    #[test]
    fn small_bins_are_merged() {
        let expected = [1.0, 2.0, 3.0, 50.0, 1.0, 0.0];
        let test = chi2_test(&expected, &expected, 5.0);
        assert_eq!((test.statistic, test.dof, test.p), (0.0, 1, 1.0));
    }

    #[test]
    fn the_impossible_is_refused() {
        assert_eq!(chi2_test(&[10.0, 1.0], &[11.0, 0.0], 5.0).p, 0.0);
        assert_eq!(chi2_test(&[10.0, f64::NAN], &[11.0, 5.0], 5.0).p, 0.0);
    }
}
