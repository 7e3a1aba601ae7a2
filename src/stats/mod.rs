//! Moments, standard errors, z, χ², Šidák: the tools of the rule that a check is a hypothesis test and not a tolerance.
//!
//! An estimate and its standard error come from independent replicates ([`Moments`]); a closed form is tested by
//! z = (mean − exact)/SE, a density by χ² against its integrals over bins. The N tests of a [`Family`] share one
//! significance α by Šidák's correction, so that a correct program fails one family in 1/α.

mod chi2;
mod family;
mod moments;

pub use chi2::{Chi2, chi2_test};
pub use family::{Check, Evidence, Family};
pub use moments::Moments;

use statrs::distribution::{ContinuousCDF, Normal};

/// Significance that a family of checks shares where nothing else is said.
pub const ALPHA: f64 = 1e-4;

/// (mean − exact)/SE. Where the standard error is 0, the estimate is a constant: 0 if it is `exact`, else infinite.
pub fn z(mean: f64, exact: f64, se: f64) -> f64 {
    let difference = mean - exact;
    if difference == 0.0 && se >= 0.0 { 0.0 } else { difference / se }
}

/// z of the difference of two independent estimates.
pub fn two_sample_z(a: &Moments, b: &Moments) -> f64 {
    z(a.mean(), b.mean(), a.standard_error().hypot(b.standard_error()))
}

/// Φ(x), the distribution function of the standard normal.
pub fn normal_cdf(x: f64) -> f64 {
    Normal::standard().cdf(x)
}

/// Φ⁻¹(p).
pub fn normal_quantile(p: f64) -> f64 {
    Normal::standard().inverse_cdf(p)
}

/// Significance of each of `n` independent tests that together have significance α: 1 − (1 − α)^(1/n) (Šidák 1967).
/// It is conservative for positively dependent tests.
pub fn sidak(alpha: f64, n: usize) -> f64 {
    -((-alpha).ln_1p() / n.max(1) as f64).exp_m1()
}

/// Two-sided threshold on |z| of each of `n` tests that together have significance `alpha`.
pub fn z_limit(alpha: f64, n: usize) -> f64 {
    -normal_quantile(0.5 * sidak(alpha, n))
}

/// p-value of |z|, two-sided.
pub fn two_sided_p(z: f64) -> f64 {
    if z.is_nan() { 0.0 } else { 2.0 * normal_cdf(-z.abs()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_the_tabulated_ones() {
        assert!((normal_quantile(0.975) - 1.959_963_984_540_054).abs() < 1e-9);
        assert!((normal_cdf(-3.0) - 1.349_898_031_630_094_6e-3).abs() < 1e-12);
        assert!((z_limit(0.05, 1) - 1.959_963_984_540_054).abs() < 1e-9);
    }

    #[test]
    fn sidak_keeps_the_family_at_alpha() {
        for n in [1, 10, 1_000_000] {
            let each = sidak(ALPHA, n);
            let family = -(n as f64 * (-each).ln_1p()).exp_m1();
            assert!((family / ALPHA - 1.0).abs() < 1e-9, "{n}: {family}");
        }
    }

    #[test]
    fn a_constant_estimate_is_right_or_infinitely_wrong() {
        assert_eq!(z(1.0, 1.0, 0.0), 0.0);
        assert_eq!(z(2.0, 1.0, 0.0), f64::INFINITY);
        assert!(z(f64::NAN, 1.0, 0.0).is_nan());
        assert_eq!(two_sided_p(f64::NAN), 0.0);
    }
}
