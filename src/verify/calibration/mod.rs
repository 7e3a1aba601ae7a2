//! Whether checks fail as often as they should: false alarms are bounded, and z-values are as normal as they claim.
//!
//! A check that is right by construction has a z that follows the standard normal, or a p-value that is uniform; a battery
//! at significance α fails one run in 1/α. [`Calibration`] looks at many runs with different seeds and measures both.
//!
//! The sample is drawn so that its members are independent: checks of one task share numbers (the light's samples of one
//! pose, both moments of one filter), so of each task and run one z and one p enter, chosen by a hash of seed and name;
//! tasks and runs have streams of their own. Checks whose estimate may be off by more than 5 % of its standard error
//! through rounding, which is granted to them, have no normal z and are left out; so are yes-or-no checks, and estimates
//! that stand exactly on what is claimed, as one-sided checks do that hold. Where standard errors are widened on purpose
//! ([`Findings::guarded`](super::Findings::guarded)) z spread less than the normal: of those the tails alone are judged.

mod counts;
mod normality;

pub use counts::{clopper_pearson, poisson_above};
pub use normality::{Normality, Tail, kolmogorov_smirnov, normality};

use super::{Report, Section};
use crate::sampler::mix;
use crate::stats::{Check, Chi2, Evidence, sidak, two_sided_t, z_of_p};
use normality::uniform_chi2;
use std::fmt;

/// Share of the standard error that rounding may have in a check whose z is looked at.
const ROUNDING: f64 = 0.05;

/// Significances at which runs are judged again.
pub const ALPHAS: [f64; 5] = [1e-4, 1e-3, 1e-2, 5e-2, 0.2];

/// The standard normal's number that is as unlikely as this evidence, with no rounding granted; `None` where there is
/// no such number, or rounding may have moved it.
fn plain_z(evidence: &Evidence) -> Option<f64> {
    let Evidence::Z { exact, estimate, se, dof, rounding } = *evidence else { return None };
    let t = (estimate - exact) / se;
    let eligible = se > 0.0 && rounding <= ROUNDING * se && t.is_finite() && estimate != exact;
    eligible.then(|| if dof.is_finite() { z_of_p(two_sided_t(t, dof)).copysign(t) } else { t })
}

/// The p-value of a test, unless it is a yes or no.
fn plain_p(evidence: &Evidence) -> Option<f64> {
    match *evidence {
        Evidence::P { p } if p > 0.0 && p < 1.0 => Some(p),
        _ => None,
    }
}

/// One of a section's checks that have such a number, each as likely.
fn one(seed: u64, section: &Section, number: impl Fn(&Evidence) -> Option<f64>) -> Option<f64> {
    let all: Vec<f64> = section.checks.iter().filter_map(|check| number(&check.evidence)).collect();
    let hash = section.subject.bytes().fold(mix(seed), |h, byte| mix(h ^ u64::from(byte)));
    if all.is_empty() { None } else { Some(all[(hash % all.len() as u64) as usize]) }
}

impl Report {
    /// The z-values of this run beside the normal, one of each task.
    pub fn normality(&self) -> Normality {
        normality(&self.numbers(false, plain_z).collect::<Vec<f64>>())
    }

    /// One number of each task whose errors are, or are not, widened on purpose.
    fn numbers(&self, guarded: bool, number: impl Fn(&Evidence) -> Option<f64>) -> impl Iterator<Item = f64> {
        let sections = self.sections.iter().filter(move |section| section.guarded == guarded);
        sections.filter_map(move |section| one(self.seed, section, &number))
    }

    /// Whether the run fails at another significance.
    fn fails_at(&self, alpha: f64) -> bool {
        let share = sidak(alpha, self.random());
        self.checks().any(|(_, check)| check.p() < share)
    }
}

/// What many runs show of the battery's own errors.
#[derive(Clone, Debug, Default)]
pub struct Calibration {
    runs: usize,
    checks: usize,
    failed: [usize; ALPHAS.len()],
    z: Vec<f64>,
    p: Vec<f64>,
    guarded: Vec<f64>,
    culprits: Vec<String>,
}

impl Calibration {
    /// Takes a run; runs without checks count for nothing. Seeds must differ.
    pub fn add(&mut self, report: &Report) {
        if report.checks().next().is_none() {
            return;
        }
        self.runs += 1;
        self.checks += report.random();
        for (failed, alpha) in self.failed.iter_mut().zip(ALPHAS) {
            *failed += usize::from(report.fails_at(alpha));
        }
        self.z.extend(report.numbers(false, plain_z));
        self.p.extend(report.numbers(false, plain_p));
        self.guarded.extend(report.numbers(true, plain_z));
        let named = |(section, check): (&Section, &Check)| {
            format!(
                "seed {}: {}/{}, {}, p = {:.1e}",
                report.seed,
                section.topic.id,
                section.subject,
                check.name,
                check.p()
            )
        };
        self.culprits.extend(report.failures().map(named));
    }

    /// Runs seen.
    pub fn runs(&self) -> usize {
        self.runs
    }

    /// Runs that fail at each of [`ALPHAS`].
    pub fn failed(&self) -> [usize; ALPHAS.len()] {
        self.failed
    }

    /// The z-values, one of each task and run, beside the normal.
    pub fn z(&self) -> Normality {
        normality(&self.z)
    }

    /// The z-values of checks whose errors are widened on purpose, one of each task and run: they stay within the normal.
    pub fn guarded(&self) -> Normality {
        normality(&self.guarded)
    }

    /// The p-values, one of each task and run: how many, χ² over 32 bins and Kolmogorov–Smirnov against the uniform law.
    pub fn p(&self) -> (usize, Chi2, f64) {
        (self.p.len(), uniform_chi2(&self.p), kolmogorov_smirnov(self.p.clone()))
    }

    /// True where nothing speaks against the claim: at one in a thousand each, neither law is refused, no tail is too full,
    /// and at no significance do too many runs fail. Too few may, for Šidák's share is kept by dependent checks too.
    pub fn holds(&self) -> bool {
        let z = self.z();
        let (_, chi2, kolmogorov) = self.p();
        let tails = z.tails.into_iter().chain(self.guarded().tails);
        let tails = tails.into_iter().all(|t| poisson_above(t.observed, t.expected) > 1e-3);
        // Poisson numbers spread more than binomial ones of the same mean.
        let rates = ALPHAS.iter().zip(self.failed).all(|(alpha, k)| poisson_above(k, alpha * self.runs as f64) > 1e-3);
        self.runs > 0 && [z.chi2.p, z.kolmogorov, chi2.p, kolmogorov].iter().all(|&p| p > 1e-3) && tails && rates
    }
}

impl fmt::Display for Calibration {
    /// Markdown.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (z, (count, chi2, kolmogorov)) = (self.z(), self.p());
        writeln!(
            f,
            "{} runs of {:.0} random checks each on average.\n",
            self.runs,
            self.checks as f64 / self.runs.max(1) as f64
        )?;
        writeln!(
            f,
            "| α of a run | runs that fail | rate | 95 % interval (Clopper–Pearson) |\n| --- | --- | --- | --- |"
        )?;
        for (alpha, failed) in ALPHAS.into_iter().zip(self.failed) {
            let [low, high] = clopper_pearson(failed, self.runs);
            let rate = failed as f64 / self.runs.max(1) as f64;
            writeln!(f, "| {alpha} | {failed} | {rate:.4} | {low:.4} … {high:.4} |")?;
        }
        let n = z.count;
        writeln!(
            f,
            "\n{n} z-values, one of each task and run, against the standard normal: χ² of 32 bins p = {:.3}, \
             Kolmogorov–Smirnov p = {:.3}.\n",
            z.chi2.p, z.kolmogorov
        )?;
        writeln!(f, "| beyond | observed | expected |\n| --- | --- | --- |")?;
        for Tail { limit, observed, expected } in z.tails {
            writeln!(f, "| ±{limit} | {observed} | {expected:.2} |")?;
        }
        writeln!(f, "\n| z | observed | expected |\n| --- | --- | --- |")?;
        // A line a unit: four bins of the histogram, what lies beyond added to the outermost.
        for from in -4i32..4 {
            let first = (1 + 4 * (from + 4)) as usize;
            let low = if from == -4 { 0 } else { first };
            let high = if from == 3 { z.observed.len() } else { first + 4 };
            let sum = |counts: &[f64]| counts[low..high].iter().sum::<f64>();
            writeln!(f, "| {from} … {} | {} | {:.1} |", from + 1, sum(&z.observed), sum(&z.expected))?;
        }
        writeln!(
            f,
            "\n{count} p-values of other tests, one of each task and run, against the uniform law: χ² of 32 bins p = {:.3}, \
             Kolmogorov–Smirnov p = {kolmogorov:.3}.",
            chi2.p
        )?;
        let guarded = self.guarded();
        writeln!(
            f,
            "\n{} z-values of rendered images, whose errors are widened for events that no sample has met: they may spread \
             less than the normal, and not more.\n",
            guarded.count
        )?;
        writeln!(f, "| beyond | observed | expected at most |\n| --- | --- | --- |")?;
        for Tail { limit, observed, expected } in guarded.tails {
            writeln!(f, "| ±{limit} | {observed} | {expected:.2} |")?;
        }
        if !self.culprits.is_empty() {
            writeln!(f, "\nFalse alarms:\n")?;
        }
        self.culprits.iter().try_for_each(|culprit| writeln!(f, "- {culprit}"))?;
        writeln!(
            f,
            "\n{}",
            if self.holds() { "False alarms are bounded." } else { "Checks fail more or less often than they claim." }
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::normal_quantile;
    use crate::verify::{Size, Topic};
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;
    use std::time::Duration;

    /// Runs of six tasks with three checks each, whose z are normal times `spread` plus `bias`.
    fn calibrate(spread: f64, bias: f64) -> Calibration {
        let mut rng = Pcg64Mcg::seed_from_u64(7);
        let mut calibration = Calibration::default();
        for seed in 0..1000 {
            let mut section = |k: usize| {
                let mut check = |_| {
                    let z = spread * normal_quantile(rng.random_range(1e-12..1.0)) + bias;
                    let evidence = Evidence::Z {
                        exact: 1.0,
                        estimate: 1.0 + 0.01 * z,
                        se: 0.01,
                        dof: f64::INFINITY,
                        rounding: 1e-9,
                    };
                    Check { name: "z".into(), evidence }
                };
                let mut checks: Vec<Check> = (0..3).map(&mut check).collect();
                // Of no use: too much rounding, and a yes.
                let evidence = Evidence::Z { exact: 1.0, estimate: 1.0, se: 0.01, dof: f64::INFINITY, rounding: 0.1 };
                checks.push(Check { name: "rounded".into(), evidence });
                checks.push(Check { name: "holds".into(), evidence: Evidence::P { p: 1.0 } });
                let p = rng.random::<f64>().powf(spread);
                checks.push(Check { name: "p".into(), evidence: Evidence::P { p } });
                let topic = Topic { id: "X9", title: "", source: "" };
                let (exhibits, words) = (Vec::new(), Vec::new());
                Section { topic, subject: k.to_string(), checks, exhibits, words, guarded: false, time: Duration::ZERO }
            };
            let sections = (0..6).map(&mut section).collect();
            calibration.add(&Report {
                size: Size::Default,
                seed,
                alpha: 1e-4,
                sections,
                notes: Vec::new(),
                time: Duration::ZERO,
            });
        }
        calibration
    }

    #[test]
    fn right_checks_are_calibrated() {
        let right = calibrate(1.0, 0.0);
        assert!(right.holds(), "{right}");
        assert_eq!((right.runs(), right.z().count, right.p().0), (1000, 6000, 6000));
        // 36 checks a run at a family-wise significance of 0.2, of which the rounded and the certain ones never fail.
        assert!((80..200).contains(&right.failed()[4]), "{right}");
    }

    #[test]
    fn wrong_standard_errors_and_biases_are_seen() {
        for (spread, bias) in [(1.1, 0.0), (0.9, 0.0), (1.0, 0.1)] {
            let wrong = calibrate(spread, bias);
            assert!(!wrong.holds(), "{wrong}");
        }
    }
}
