//! Checks that share one significance.

use super::{ALPHA, Chi2, Moments, normal_quantile, sidak, t_limit, two_sided_t, z, z_of_p};
use std::fmt;

/// What speaks for or against a check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Evidence {
    /// An estimate with its standard error, and the exact value.
    Z {
        /// The closed form.
        exact: f64,
        /// The estimate.
        estimate: f64,
        /// Its standard error.
        se: f64,
        /// Degrees of freedom that the standard error was estimated with: replicates − 1; infinite where it is known.
        dof: f64,
        /// Largest absolute error of arithmetic, granted before z is taken.
        rounding: f64,
    },
    /// A p-value of another test.
    P {
        /// The p-value.
        p: f64,
    },
    /// An identity that arithmetic alone limits: the largest relative deviation of all comparisons, and what rounding
    /// explains. Nothing random is in it.
    Bound {
        /// Largest deviation found.
        worst: f64,
        /// Largest deviation allowed.
        bound: f64,
    },
}

impl Evidence {
    /// The mean of independent replicates against its exact value; a relative error of `rounding` is granted.
    pub fn replicated(exact: f64, replicates: &Moments, rounding: f64) -> Self {
        let (estimate, se) = (replicates.mean(), replicates.standard_error());
        Self::Z { exact, estimate, se, dof: replicates.n() as f64 - 1.0, rounding: rounding * exact.abs() }
    }

    /// A mean that must not exceed `limit`: against the value of that hypothesis which is nearest to it, so that only
    /// an excess counts; a relative error of `rounding` is granted.
    pub fn at_most(limit: f64, replicates: &Moments, rounding: f64) -> Self {
        Self::replicated(limit.min(replicates.mean()), replicates, rounding)
    }

    /// Two independent estimates of one number, `a` against `b` (Welch 1947); a relative error of `rounding` is granted.
    pub fn equal(a: &Moments, b: &Moments, rounding: f64) -> Self {
        let [va, vb] = [a, b].map(|m| m.standard_error().powi(2));
        let parts = va.powi(2) / (a.n() as f64 - 1.0) + vb.powi(2) / (b.n() as f64 - 1.0);
        let dof = if parts > 0.0 { (va + vb).powi(2) / parts } else { f64::INFINITY };
        let exact = b.mean();
        Self::Z { exact, estimate: a.mean(), se: (va + vb).sqrt(), dof, rounding: rounding * exact.abs() }
    }
}

/// One named check.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// What is checked.
    pub name: String,
    /// What was found.
    pub evidence: Evidence,
}

impl Check {
    /// (estimate − exact)/SE, where it has one; differences within rounding count as none.
    pub fn t(&self) -> Option<f64> {
        match self.evidence {
            Evidence::Z { exact, estimate, se, rounding, .. } if (estimate - exact).abs() <= rounding => {
                Some(z(exact, exact, se))
            }
            Evidence::Z { exact, estimate, se, rounding, .. } => {
                Some(z(estimate - rounding.copysign(estimate - exact), exact, se))
            }
            Evidence::P { .. } | Evidence::Bound { .. } => None,
        }
    }

    /// The standard normal's quantile that is as unlikely as [`t`](Self::t) is by Student's law with the standard
    /// error's degrees of freedom: right checks follow the normal, however few replicates they have.
    pub fn z(&self) -> Option<f64> {
        let t = self.t()?;
        match self.evidence {
            Evidence::Z { dof, .. } if dof.is_finite() && t.is_finite() => {
                Some(z_of_p(two_sided_t(t, dof)).copysign(t))
            }
            _ => Some(t),
        }
    }

    /// Its p-value; 0 for what is not a number.
    pub fn p(&self) -> f64 {
        match self.evidence {
            Evidence::P { p } if p.is_nan() => 0.0,
            Evidence::P { p } => p,
            Evidence::Bound { worst, bound } => f64::from(worst <= bound),
            Evidence::Z { dof, .. } => self.t().map_or(0.0, |t| two_sided_t(t, dof)),
        }
    }

    /// Smallest relative bias that a test with p ≥ `share` finds with probability 0.99.
    pub fn detects(&self, share: f64) -> Option<f64> {
        match self.evidence {
            Evidence::Z { exact, se, rounding, dof, .. } => {
                Some((rounding + (t_limit(share, dof) + normal_quantile(0.99)) * se) / exact.abs())
            }
            Evidence::Bound { bound, .. } => Some(bound),
            Evidence::P { .. } => None,
        }
    }
}

/// A family of checks that together have significance α.
#[derive(Clone, Debug)]
pub struct Family {
    name: String,
    alpha: f64,
    checks: Vec<Check>,
}

impl Family {
    /// An empty family at α = [`ALPHA`].
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), alpha: ALPHA, checks: Vec::new() }
    }

    /// This family at another significance.
    pub fn with_alpha(self, alpha: f64) -> Self {
        Self { alpha, ..self }
    }

    /// Adds any check.
    pub fn push(&mut self, name: impl Into<String>, evidence: Evidence) {
        self.checks.push(Check { name: name.into(), evidence });
    }

    /// Adds an estimate from independent replicates against its exact value.
    pub fn moments(&mut self, name: impl Into<String>, exact: f64, replicates: &Moments) {
        self.replicated(name, exact, replicates, 0.0);
    }

    /// Adds replicates of an estimate in f32 arithmetic, which is granted a relative error of `rounding`.
    pub fn replicated(&mut self, name: impl Into<String>, exact: f64, replicates: &Moments, rounding: f64) {
        self.push(name, Evidence::replicated(exact, replicates, rounding));
    }

    /// Adds an estimate with a known standard error.
    pub fn estimate(&mut self, name: impl Into<String>, exact: f64, estimate: f64, se: f64) {
        self.push(name, Evidence::Z { exact, estimate, se, dof: f64::INFINITY, rounding: 0.0 });
    }

    /// Adds an estimate of f32 arithmetic: a relative error of `rounding` is granted.
    pub fn rounded(&mut self, name: impl Into<String>, exact: f64, estimate: f64, se: f64, rounding: f64) {
        let rounding = rounding * exact.abs();
        self.push(name, Evidence::Z { exact, estimate, se, dof: f64::INFINITY, rounding });
    }

    /// Adds two independent estimates that must agree.
    pub fn equal(&mut self, name: impl Into<String>, a: &Moments, b: &Moments) {
        self.push(name, Evidence::equal(a, b, 0.0));
    }

    /// Adds a χ² test.
    pub fn chi2(&mut self, name: impl Into<String>, test: Chi2) {
        self.p(name, test.p);
    }

    /// Adds a p-value.
    pub fn p(&mut self, name: impl Into<String>, p: f64) {
        self.push(name, Evidence::P { p });
    }

    /// Adds an identity: the largest relative deviation that was found, and the largest that arithmetic explains.
    pub fn bound(&mut self, name: impl Into<String>, worst: f64, bound: f64) {
        self.push(name, Evidence::Bound { worst, bound });
    }

    /// Adds a yes or no.
    pub fn holds(&mut self, name: impl Into<String>, holds: bool) {
        self.p(name, f64::from(holds));
    }

    /// The checks, taken out.
    pub fn into_checks(self) -> Vec<Check> {
        self.checks
    }

    /// The checks so far.
    pub fn checks(&self) -> &[Check] {
        &self.checks
    }

    /// The checks that fail at the family's significance: their p is below Šidák's share of α.
    pub fn failures(&self) -> impl Iterator<Item = &Check> {
        let share = sidak(self.alpha, self.checks.len());
        self.checks.iter().filter(move |check| check.p() < share)
    }

    /// True where no check fails. A family without checks has shown nothing and does not pass.
    pub fn passes(&self) -> bool {
        !self.checks.is_empty() && self.failures().next().is_none()
    }

    /// Prints the table; panics where the family does not pass.
    #[track_caller]
    pub fn assert(&self) {
        println!("{self}");
        assert!(self.passes(), "{self}");
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let n = self.checks.len();
        let share = sidak(self.alpha, n);
        let limit = t_limit(share, f64::INFINITY);
        writeln!(f, "{}: {n} checks at α = {:.0e}, |z| ≤ {limit:.2}, p ≥ {share:.1e} each", self.name, self.alpha)?;
        let width = self.checks.iter().map(|c| c.name.chars().count()).max().unwrap_or(0);
        for check in &self.checks {
            let verdict = if check.p() < share { "FAIL" } else { "ok" };
            write!(f, "  {verdict:4} {:width$}", check.name)?;
            match check.evidence {
                Evidence::P { p } => writeln!(f, "  p {p:.3e}")?,
                Evidence::Bound { worst, bound } => writeln!(f, "  worst {worst:.1e} of {bound:.1e}")?,
                Evidence::Z { exact, estimate, se, .. } => writeln!(
                    f,
                    "  exact {exact:<12.6e} estimate {estimate:<12.6e} ± {se:.1e}  z {:+.2}  detects {:.3} %",
                    check.z().unwrap_or(f64::NAN),
                    100.0 * check.detects(share).unwrap_or(f64::NAN),
                )?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_family_fails_by_its_worst_member() {
        let mut family = Family::new("example");
        assert!(!family.passes());
        family.estimate("right", 1.0, 1.01, 0.01);
        family.rounded("rounded", 1.0, 1.0 + 1e-7, 0.0, 1e-6);
        family.p("fits", 0.3);
        assert!(family.passes(), "{family}");
        family.estimate("wrong", 1.0, 1.1, 0.01);
        assert_eq!(family.failures().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["wrong"]);
        assert!(family.to_string().contains("FAIL wrong"));
    }

    #[test]
    fn what_is_no_number_fails() {
        for evidence in [
            Evidence::P { p: f64::NAN },
            Evidence::Bound { worst: f64::NAN, bound: 1.0 },
            Evidence::Z { exact: 1.0, estimate: f64::NAN, se: 1.0, dof: 9.0, rounding: 0.0 },
            Evidence::Z { exact: 1.0, estimate: 1.0, se: f64::NAN, dof: 9.0, rounding: 0.0 },
        ] {
            let mut family = Family::new("bad");
            family.push("bad", evidence);
            assert!(!family.passes(), "{evidence:?}");
        }
    }

    #[test]
    fn power_is_as_claimed() {
        // At a bias of `detects`, z is normal about limit + Φ⁻¹(0.99): it passes the limit with probability 0.99.
        let evidence = Evidence::Z { exact: 2.0, estimate: 2.0, se: 0.01, dof: f64::INFINITY, rounding: 0.0 };
        let check = Check { name: String::new(), evidence };
        let bias = check.detects(super::super::two_sided_p(3.0)).unwrap() * 2.0;
        assert!((super::super::normal_cdf(bias / 0.01 - 3.0) - 0.99).abs() < 1e-9);
    }

    #[test]
    fn few_replicates_are_judged_by_student() {
        // The two-sided 1 % point of 10 degrees of freedom is 3.1693, of the normal 2.5758.
        let evidence = Evidence::Z { exact: 1.0, estimate: 4.169_272_667, se: 1.0, dof: 10.0, rounding: 0.0 };
        let check = Check { name: String::new(), evidence };
        assert!((check.p() - 0.01).abs() < 1e-8, "{}", check.p());
        assert!((check.z().unwrap() - 2.575_829_3).abs() < 1e-6);
    }
}
