//! A check as the cells of a table.

use crate::stats::{Check, Evidence};

/// Texts of one check, for a table of any form.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cells {
    /// The exact value; empty where there is none.
    pub exact: String,
    /// The estimate ± its standard error, or the deviation of an identity and its bound.
    pub estimate: String,
    /// z or p.
    pub statistic: String,
    /// Smallest relative bias that would have been found.
    pub detects: String,
}

impl Cells {
    /// Of a check that passes with p ≥ `share`.
    pub fn new(check: &Check, share: f64) -> Self {
        let detects = check.detects(share).map_or(String::new(), percent);
        match check.evidence {
            Evidence::P { p } => Self { statistic: format!("p {}", probability(p)), detects, ..Self::default() },
            Evidence::Bound { worst, bound } => {
                Self { estimate: format!("{worst:.1e} (≤ {bound:.1e})"), detects, ..Self::default() }
            }
            Evidence::Z { exact, estimate, se, .. } => {
                let z = check.z().unwrap_or(f64::NAN);
                Self {
                    exact: value(exact),
                    estimate: format!("{} ± {se:.1e}", value(estimate)),
                    statistic: if z.abs() < 1e4 { format!("z {z:+.2}") } else { format!("z {z:+.1e}") },
                    detects,
                }
            }
        }
    }
}

/// Six significant digits.
pub(super) fn value(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    match x.abs().log10().floor() {
        magnitude if (-4.0..6.0).contains(&magnitude) => format!("{x:.*}", (5.0 - magnitude) as usize),
        _ => format!("{x:.4e}"),
    }
}

/// Two significant digits; certainty without any.
pub(super) fn probability(p: f64) -> String {
    if p == 0.0 || p == 1.0 { p.to_string() } else { format!("{p:.1e}") }
}

/// A share in per cent, two significant digits; nothing where it is infinite, as against an exact value of 0.
pub(super) fn percent(share: f64) -> String {
    match 100.0 * share {
        p if !p.is_finite() => String::new(),
        0.0 => "0 %".into(),
        p if p < 1e-3 => format!("{p:.0e} %"),
        p => format!("{p:.*} %", (1.0 - p.log10().floor()).max(0.0) as usize),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_for_people() {
        assert_eq!(
            [0.0, 1.0, 0.25, 123.4567, 1e-9, 1.5e7].map(value),
            ["0", "1.00000", "0.250000", "123.457", "1.0000e-9", "1.5000e7"]
        );
        assert_eq!([0.0, 1.0, 0.034].map(probability), ["0", "1", "3.4e-2"]);
        assert_eq!([0.0, 1e-6, 0.00012, 0.0345, 2.0].map(percent), ["0 %", "1e-4 %", "0.012 %", "3.5 %", "200 %"]);
        assert_eq!(percent(f64::INFINITY), "");
    }

    #[test]
    fn each_evidence_has_its_cells() {
        let check = |evidence| Cells::new(&Check { name: String::new(), evidence }, 1e-8);
        let z = Evidence::Z { exact: 1.0, estimate: 1.02, se: 0.01, dof: f64::INFINITY, rounding: 0.0 };
        assert_eq!(
            [&*check(z).exact, &*check(z).estimate, &*check(z).statistic],
            ["1.00000", "1.02000 ± 1.0e-2", "z +2.00"]
        );
        assert_eq!(check(Evidence::P { p: 0.5 }).statistic, "p 5.0e-1");
        let bound = check(Evidence::Bound { worst: 1e-7, bound: 1e-6 });
        assert_eq!((&*bound.estimate, &*bound.detects), ("1.0e-7 (≤ 1.0e-6)", "1e-4 %"));
    }
}
