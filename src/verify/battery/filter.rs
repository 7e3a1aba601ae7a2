//! D4: pixel filters by importance sampling (Ernst, Stamminger & Greiner 2006): offsets follow the filter's profile.
//!
//! χ² of the offsets over the support, their mean 0, their variance ∫ x² w(x) dx, uncorrelated axes, ∫ w = 1.

use crate::desc::Filter;
use crate::film::{filter_density, filter_offset, filter_radius};
use crate::stats::{Moments, chi2_test};
use crate::verify::measure::replicates;
use crate::verify::{Exhibit, Findings, HeatMap, Task, Topic, Trial};
use crate::warp::{blackman_harris, gaussian};
use clap::ValueEnum;
use glam::Vec2;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

const D4: Topic = Topic {
    id: "D4",
    title: "offsets in a pixel follow the filter",
    source: "Ernst, Stamminger & Greiner 2006; Harris 1978",
};

/// Bins per axis of the support.
const SIDE: usize = 24;

pub(super) fn tasks() -> Vec<Task> {
    Filter::value_variants()
        .iter()
        .map(|&filter| {
            Task::new(D4, format!("{filter:?}"), move |trial, found| {
                profile(filter, found);
                shape(filter, trial, found);
                second_moments(filter, trial, found);
            })
        })
        .collect()
}

/// The filter as its authors define it, not normalised: standard deviation ½ for the Gaussian, radius 3/2.
fn authors(filter: Filter, x: f64) -> f64 {
    match filter {
        Filter::Box => 1.0,
        Filter::Gaussian => gaussian(x, 0.5),
        Filter::BlackmanHarris => blackman_harris(x, 1.5),
    }
}

/// ∫ f dx over the support, by the midpoint rule.
fn integral(filter: Filter, f: impl Fn(f64) -> f64) -> f64 {
    let (n, radius) = (20_000, f64::from(filter_radius(filter)));
    let step = 2.0 * radius / f64::from(n);
    (0..n).map(|i| f((f64::from(i) + 0.5) * step - radius) * step).sum()
}

/// The density is the filter, normalised.
fn profile(filter: Filter, found: &mut Findings) {
    let norm = integral(filter, |x| authors(filter, x));
    let off = |i: u32| {
        let at =
            [i % 50, i / 50].map(|k| (f64::from(k) + 0.5) / 25.0 - 1.0).map(|x| x * f64::from(filter_radius(filter)));
        let stated = filter_density(filter, Vec2::new(at[0] as f32, at[1] as f32));
        (stated - authors(filter, at[0]) * authors(filter, at[1]) / (norm * norm)).abs()
    };
    let worst = (0..2500).map(off).fold(0.0, f64::max) / filter_density(filter, Vec2::ZERO);
    found.checks.bound("density = profile, relative to its maximum", worst, 1e-6);
    let outside = filter_density(filter, Vec2::new(filter_radius(filter) + 0.01, 0.0));
    found.checks.holds("nothing outside the radius", outside == 0.0);
}

/// χ² over bins of the support.
fn shape(filter: Filter, trial: &Trial, found: &mut Findings) {
    let mut rng = Pcg64Mcg::seed_from_u64(trial.seed);
    let n = trial.work(1_000_000, 15_000_000);
    let radius = filter_radius(filter);
    let mut observed = vec![0.0; SIDE * SIDE];
    let mut inside = true;
    for _ in 0..n {
        let x = filter_offset(filter, [rng.random(), rng.random()]);
        inside &= x.abs().max_element() <= radius;
        let [column, row] = [x.x, x.y].map(|x| (((0.5 * x / radius + 0.5) * SIDE as f32) as usize).min(SIDE - 1));
        observed[row * SIDE + column] += 1.0;
    }
    // A separable density: the integral over a bin is the product of two.
    let share = |bin: usize| {
        let (width, points) = (2.0 * f64::from(radius) / SIDE as f64, 200);
        let at = |k: usize| (bin as f64 + (k as f64 + 0.5) / points as f64) * width - f64::from(radius);
        (0..points).map(|k| authors(filter, at(k))).sum::<f64>() * width / points as f64
    };
    let shares: Vec<f64> = (0..SIDE).map(share).collect();
    let norm = shares.iter().sum::<f64>().powi(2);
    let expected: Vec<f64> =
        (0..SIDE * SIDE).map(|i| f64::from(n) * shares[i % SIDE] * shares[i / SIDE] / norm).collect();
    found.checks.holds("no offset beyond the radius", inside);
    found.checks.chi2("χ² of the offsets", chi2_test(&observed, &expected, 20.0));
    let axes = ["x", "y"];
    found.exhibits.push(Exhibit::HeatMap(HeatMap { title: "offsets".into(), axes, columns: SIDE, observed, expected }));
}

fn second_moments(filter: Filter, trial: &Trial, found: &mut Findings) {
    let points = trial.work(1 << 10, 1 << 14);
    let mean = |k: u64, f: fn(Vec2) -> f64| -> Moments {
        replicates(trial.seed.wrapping_add(k), points, |u| f(filter_offset(filter, u)))
    };
    let norm = integral(filter, |x| authors(filter, x));
    let variance = integral(filter, |x| x * x * authors(filter, x)) / norm;
    // Against 1 and not 0, so that detectable deviations are relative to a pixel.
    found.checks.moments("1 + mean of x", 1.0, &mean(1, |x| 1.0 + f64::from(x.x)));
    found.checks.moments("1 + mean of y", 1.0, &mean(2, |x| 1.0 + f64::from(x.y)));
    // The offsets' table is linear within cells of 1/512 of the radius.
    found.checks.replicated("variance of x", variance, &mean(3, |x| f64::from(x.x).powi(2)), 1e-5);
    found.checks.replicated("variance of y", variance, &mean(4, |x| f64::from(x.y).powi(2)), 1e-5);
    found.checks.moments("1 + covariance", 1.0, &mean(5, |x| 1.0 + f64::from(x.x) * f64::from(x.y)));
}
