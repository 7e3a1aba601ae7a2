//! Estimates that must not exceed a limit.

use crate::stats::{Evidence, two_sided_t};

/// Evidence against `estimate` ≤ `limit`: against the value of that hypothesis which is nearest to it, so that only an
/// excess counts ([`Evidence::at_most`] for what is no mean of replicates); an error of `rounding` is granted.
pub(super) fn at_most(limit: f64, estimate: f64, se: f64, dof: f64, rounding: f64) -> Evidence {
    Evidence::Z { exact: limit.min(estimate), estimate, se, dof, rounding }
}

/// p of the worst of several estimates ± standard error that must not exceed `limit`, as if it had stood alone: the
/// probability that the least of as many p-values is as small as theirs (Šidák 1967).
pub(super) fn worst_p(estimates: impl Iterator<Item = (f64, f64)>, limit: f64, dof: f64) -> f64 {
    let (mut n, mut least) = (0, 1.0f64);
    for (estimate, se) in estimates {
        n += 1;
        let excess = estimate - limit;
        let p = if excess > 0.0 { 0.5 * two_sided_t(excess / se, dof) } else { 1.0 };
        least = if p.is_nan() { 0.0 } else { least.min(p) };
    }
    -((-least.min(1.0 - 1e-16)).ln_1p() * f64::from(n)).exp_m1()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Check;

    #[test]
    fn only_an_excess_counts() {
        let p = |estimate: f64| Check { name: String::new(), evidence: at_most(1.0, estimate, 0.01, 63.0, 0.0) }.p();
        assert_eq!(p(0.5), 1.0);
        assert!(p(1.01) > 0.1 && p(1.1) < 1e-12);
    }

    #[test]
    fn the_worst_of_many_is_less_surprising() {
        let alone = worst_p([(1.03, 0.01)].into_iter(), 1.0, 63.0);
        let among = worst_p([(0.9, 0.01), (1.03, 0.01), (1.0, 0.01)].into_iter(), 1.0, 63.0);
        assert!((alone - 0.002).abs() < 1e-3 && (among / alone - 3.0).abs() < 0.02, "{alone} {among}");
        assert!(worst_p([(0.5, 0.0), (0.9, 0.1)].into_iter(), 1.0, 63.0) > 0.999);
    }
}
