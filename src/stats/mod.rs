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

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

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

/// p-value of |t|, two-sided, by Student's law with `dof` degrees of freedom (infinite: the normal).
pub fn two_sided_t(t: f64, dof: f64) -> f64 {
    if t.is_nan() || dof.is_nan() {
        return 0.0;
    }
    match StudentsT::new(0.0, 1.0, dof) {
        // Beyond these the two laws differ by less than the error of the standard error's own estimate.
        Ok(student) if dof < 1e5 => 2.0 * student.sf(t.abs()),
        _ => two_sided_p(t),
    }
}

/// The |z| whose two-sided p-value is `p`.
pub fn z_of_p(p: f64) -> f64 {
    -normal_quantile(0.5 * p.clamp(f64::MIN_POSITIVE, 1.0))
}

/// Two-sided threshold on |t| of a test with p ≥ `share`, by Student's law with `dof` degrees of freedom.
pub fn t_limit(share: f64, dof: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    while two_sided_t(high, dof) > share && high < 1e9 {
        high *= 2.0;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if two_sided_t(middle, dof) > share { low = middle } else { high = middle }
    }
    high
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
    fn student_has_heavier_tails() {
        // Tabulated: t of 5 degrees of freedom at 0.1 %, two-sided, is 6.8688.
        assert!((t_limit(1e-3, 5.0) - 6.868_826_6).abs() < 1e-6);
        assert!((t_limit(1e-8, f64::INFINITY) - z_of_p(1e-8)).abs() < 1e-6);
        assert!((two_sided_t(6.0, 63.0) / 1.061_49e-7 - 1.0).abs() < 1e-3, "{:e}", two_sided_t(6.0, 63.0));
    }

    #[test]
    fn a_constant_estimate_is_right_or_infinitely_wrong() {
        assert_eq!(z(1.0, 1.0, 0.0), 0.0);
        assert_eq!(z(2.0, 1.0, 0.0), f64::INFINITY);
        assert!(z(f64::NAN, 1.0, 0.0).is_nan());
        assert_eq!(two_sided_p(f64::NAN), 0.0);
    }
}
