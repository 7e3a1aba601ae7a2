//! Checks that share one significance.

use super::{ALPHA, Chi2, Moments, normal_quantile, sidak, two_sided_p, z, z_limit};
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
        /// Largest absolute error of arithmetic, granted before z is taken.
        rounding: f64,
    },
    /// A p-value of another test.
    P {
        /// The p-value.
        p: f64,
    },
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
    /// Its z, where it has one; differences within rounding count as none.
    pub fn z(&self) -> Option<f64> {
        match self.evidence {
            Evidence::Z { exact, estimate, se, rounding } if (estimate - exact).abs() <= rounding => {
                Some(z(exact, exact, se))
            }
            Evidence::Z { exact, estimate, se, rounding } => {
                Some(z(estimate - rounding.copysign(estimate - exact), exact, se))
            }
            Evidence::P { .. } => None,
        }
    }

    /// Its p-value; 0 for what is not a number.
    pub fn p(&self) -> f64 {
        match self.evidence {
            Evidence::P { p } if p.is_nan() => 0.0,
            Evidence::P { p } => p,
            Evidence::Z { .. } => self.z().map_or(0.0, two_sided_p),
        }
    }

    /// Smallest relative bias that a test at |z| ≤ `limit` finds with probability 0.99.
    pub fn detects(&self, limit: f64) -> Option<f64> {
        match self.evidence {
            Evidence::Z { exact, se, rounding, .. } => {
                Some((rounding + (limit + normal_quantile(0.99)) * se) / exact.abs())
            }
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

    /// The same at another significance.
    pub fn with_alpha(self, alpha: f64) -> Self {
        Self { alpha, ..self }
    }

    /// Adds any check.
    pub fn push(&mut self, name: impl Into<String>, evidence: Evidence) {
        self.checks.push(Check { name: name.into(), evidence });
    }

    /// Adds an estimate from independent replicates against its exact value.
    pub fn moments(&mut self, name: impl Into<String>, exact: f64, replicates: &Moments) {
        self.estimate(name, exact, replicates.mean(), replicates.standard_error());
    }

    /// Adds an estimate with a known standard error.
    pub fn estimate(&mut self, name: impl Into<String>, exact: f64, estimate: f64, se: f64) {
        self.push(name, Evidence::Z { exact, estimate, se, rounding: 0.0 });
    }

    /// Adds an estimate of f32 arithmetic: a relative error of `rounding` is granted.
    pub fn rounded(&mut self, name: impl Into<String>, exact: f64, estimate: f64, se: f64, rounding: f64) {
        self.push(name, Evidence::Z { exact, estimate, se, rounding: rounding * exact.abs() });
    }

    /// Adds two independent estimates that must agree.
    pub fn equal(&mut self, name: impl Into<String>, a: &Moments, b: &Moments) {
        self.estimate(name, b.mean(), a.mean(), a.standard_error().hypot(b.standard_error()));
    }

    /// Adds a χ² test.
    pub fn chi2(&mut self, name: impl Into<String>, test: Chi2) {
        self.p(name, test.p);
    }

    /// Adds a p-value.
    pub fn p(&mut self, name: impl Into<String>, p: f64) {
        self.push(name, Evidence::P { p });
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
        let (share, limit) = (sidak(self.alpha, n), z_limit(self.alpha, n));
        writeln!(f, "{}: {n} checks at α = {:.0e}, |z| ≤ {limit:.2}, p ≥ {share:.1e} each", self.name, self.alpha)?;
        let width = self.checks.iter().map(|c| c.name.chars().count()).max().unwrap_or(0);
        for check in &self.checks {
            let verdict = if check.p() < share { "FAIL" } else { "ok" };
            write!(f, "  {verdict:4} {:width$}", check.name)?;
            match check.evidence {
                Evidence::P { p } => writeln!(f, "  p {p:.3e}")?,
                Evidence::Z { exact, estimate, se, .. } => writeln!(
                    f,
                    "  exact {exact:<12.6e} estimate {estimate:<12.6e} ± {se:.1e}  z {:+.2}  detects {:.3} %",
                    check.z().unwrap_or(f64::NAN),
                    100.0 * check.detects(limit).unwrap_or(f64::NAN),
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
            Evidence::Z { exact: 1.0, estimate: f64::NAN, se: 1.0, rounding: 0.0 },
            Evidence::Z { exact: 1.0, estimate: 1.0, se: f64::NAN, rounding: 0.0 },
        ] {
            let mut family = Family::new("bad");
            family.push("bad", evidence);
            assert!(!family.passes(), "{evidence:?}");
        }
    }

    #[test]
    fn power_is_as_claimed() {
        // At a bias of `detects`, z is normal about limit + Φ⁻¹(0.99): it passes the limit with probability 0.99.
        let check =
            Check { name: String::new(), evidence: Evidence::Z { exact: 2.0, estimate: 2.0, se: 0.01, rounding: 0.0 } };
        let bias = check.detects(3.0).unwrap() * 2.0;
        assert!((super::super::normal_cdf(bias / 0.01 - 3.0) - 0.99).abs() < 1e-9);
    }
}
