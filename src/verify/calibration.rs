//! Whether checks fail as often as they should: false alarms are bounded, and z-values are as normal as they claim.
//!
//! A check that is right by construction has a z that follows the standard normal, or a p-value that is uniform; a battery
//! at significance α fails one run in 1/α. [`Calibration`] looks at many runs with different seeds and measures both.
//!
//! The sample is drawn so that its members are independent: checks of one task share numbers (the light's samples of one
//! pose, both moments of one filter), so of each task and run one z and one p enter, chosen by a hash of seed and name;
//! tasks and runs have streams of their own. Checks whose estimate may be off by more than 5 % of its standard error
//! through rounding, which is granted to them, have no normal z and are left out; so are yes-or-no checks.

use super::{Report, Section};
use crate::sampler::mix;
use crate::stats::{Check, Chi2, Evidence, chi2_test, normal_cdf, sidak, two_sided_p, two_sided_t, z_of_p};
use statrs::distribution::{Beta, ContinuousCDF};
use std::fmt;

/// Share of the standard error that rounding may have in a check whose z is looked at.
const ROUNDING: f64 = 0.05;

/// Significances at which runs are judged again.
pub const ALPHAS: [f64; 5] = [1e-4, 1e-3, 1e-2, 5e-2, 0.2];

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
fn uniform_chi2(u: &[f64]) -> Chi2 {
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

/// Interval that holds the probability of an event that came `count` times in `n` with confidence 0.95 at least
/// (Clopper & Pearson 1934).
pub fn clopper_pearson(count: usize, n: usize) -> [f64; 2] {
    let (k, n) = (count as f64, n as f64);
    let quantile = |a: f64, b: f64, p: f64| Beta::new(a, b).map_or(f64::NAN, |beta| beta.inverse_cdf(p));
    let low = if k > 0.0 { quantile(k, n - k + 1.0, 0.025) } else { 0.0 };
    let high = if k < n { quantile(k + 1.0, n - k, 0.975) } else { 1.0 };
    [low, high]
}

/// The standard normal's number that is as unlikely as this evidence, with no rounding granted; `None` where there is
/// no such number, or rounding may have moved it.
fn plain_z(evidence: &Evidence) -> Option<f64> {
    let Evidence::Z { exact, estimate, se, dof, rounding } = *evidence else { return None };
    let t = (estimate - exact) / se;
    let eligible = se > 0.0 && rounding <= ROUNDING * se && t.is_finite();
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
        normality(&self.sections.iter().filter_map(|s| one(self.seed, s, plain_z)).collect::<Vec<f64>>())
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
        self.z.extend(report.sections.iter().filter_map(|s| one(report.seed, s, plain_z)));
        self.p.extend(report.sections.iter().filter_map(|s| one(report.seed, s, plain_p)));
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

    /// The p-values, one of each task and run: how many, χ² over 32 bins and Kolmogorov–Smirnov against the uniform law.
    pub fn p(&self) -> (usize, Chi2, f64) {
        (self.p.len(), uniform_chi2(&self.p), kolmogorov_smirnov(self.p.clone()))
    }

    /// True where nothing speaks against the claim: neither law is refused at one in a thousand, no tail is fuller than the
    /// same allows, and at no significance do more runs fail than it promises, up to the interval of their number.
    pub fn holds(&self) -> bool {
        let z = self.z();
        let (_, chi2, kolmogorov) = self.p();
        let tails = z.tails.iter().all(|t| poisson_above(t.observed, t.expected) > 1e-3);
        let rates = ALPHAS.iter().zip(self.failed).all(|(&alpha, k)| clopper_pearson(k, self.runs)[0] <= alpha);
        self.runs > 0 && [z.chi2.p, z.kolmogorov, chi2.p, kolmogorov].iter().all(|&p| p > 1e-3) && tails && rates
    }
}

/// P(X ≥ count) of a Poisson number.
fn poisson_above(count: usize, mean: f64) -> f64 {
    let term = |k: usize| (k as f64 * mean.ln() - mean - (1..=k).map(|i| (i as f64).ln()).sum::<f64>()).exp();
    if count == 0 { 1.0 } else { (1.0 - (0..count).map(term).sum::<f64>()).max(0.0) }
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
            "\n{n} z-values, one of each task and run, against the standard normal: χ² of 32 bins p = {:.3}, Kolmogorov–Smirnov p = {:.3}.\n",
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
            "\n{count} p-values of other tests, one of each task and run, against the uniform law: χ² of 32 bins p = {:.3}, Kolmogorov–Smirnov p = {kolmogorov:.3}.",
            chi2.p
        )?;
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
                Section { topic, subject: k.to_string(), checks, exhibits, words, time: Duration::ZERO }
            };
            let sections = (0..6).map(&mut section).collect();
            calibration.add(&Report { size: Size::Default, seed, alpha: 1e-4, sections, time: Duration::ZERO });
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
