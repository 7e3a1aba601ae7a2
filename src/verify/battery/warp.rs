//! D2: the maps of the unit square.
//!
//! For every specimen: χ² of its points against the integrals of its density, ∫ pdf = 1, and the way back through its
//! inverse. Tables draw every number that a sampler can give exactly as often as they state.

use crate::stats::chi2_test;
use crate::verify::{Exhibit, Findings, HeatMap, Task, Topic, Trial};
use crate::warp::{Specimen, Table1, Warp, specimens};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

const D2: Topic = Topic {
    id: "D2",
    title: "maps of the unit square follow their density: χ² over bins, ∫ pdf = 1, inverse(map(u)) = u",
    source: "rules of evidence, 'the density is the law'",
};

/// Bins per axis of the chart: a multiple of the tables' columns and rows.
const SIDE: usize = 32;

/// Midpoints per bin and axis.
const POINTS: usize = 4;

pub(super) fn tasks() -> Vec<Task> {
    let maps = specimens().into_iter().map(|Specimen { name, warp }| {
        Task::new(D2, name, move |trial, found| {
            shape(&warp, trial, found);
            round_trip(&warp, trial, found);
        })
    });
    maps.chain([Task::new(D2, "table over all numbers of a sampler", exhausted)]).collect()
}

fn shape(warp: &Warp, trial: &Trial, found: &mut Findings) {
    let mut rng = Pcg64Mcg::seed_from_u64(trial.seed);
    let n = trial.work(500_000, 8_000_000);
    let mut observed = vec![0.0; SIDE * SIDE];
    let mut outside = 0f64;
    for _ in 0..n {
        let place = warp.place([rng.random(), rng.random()]);
        outside = place.iter().fold(outside, |worst, x| worst.max(x - 1.0).max(-x));
        let [x, y] = place.map(|x| ((x * SIDE as f64) as usize).min(SIDE - 1));
        observed[y * SIDE + x] += 1.0;
    }
    let step = 1.0 / (SIDE * POINTS) as f64;
    let integral = |bin: usize| {
        let corner = [bin % SIDE * POINTS, bin / SIDE * POINTS];
        let point = |k: usize| {
            let at = [corner[0] + k % POINTS, corner[1] + k / POINTS];
            warp.density(at.map(|i| (i as f64 + 0.5) * step))
        };
        (0..POINTS * POINTS).map(point).sum::<f64>() * step * step
    };
    let integrals: Vec<f64> = (0..SIDE * SIDE).map(integral).collect();
    let total: f64 = integrals.iter().sum();
    let expected: Vec<f64> = integrals.iter().map(|p| f64::from(n) * p / total).collect();
    found.checks.chi2("χ² of the shape", chi2_test(&observed, &expected, 20.0));
    // All densities are linear or constant over a bin: the midpoint rule is exact but for f32.
    found.checks.bound("∫ pdf = 1", (total - 1.0).abs(), 1e-6);
    found.checks.bound("nothing lies outside", outside.max(0.0), 1e-5);
    let title = "points drawn".into();
    found.exhibits.push(Exhibit::HeatMap(HeatMap {
        title,
        axes: ["first", "second"],
        columns: SIDE,
        observed,
        expected,
    }));
}

fn round_trip(warp: &Warp, trial: &Trial, found: &mut Findings) {
    let mut rng = Pcg64Mcg::seed_from_u64(trial.seed ^ 1);
    let off = |u: [f32; 2]| {
        let back = warp.round_trip(u);
        (back[0] - u[0]).abs().max((back[1] - u[1]).abs())
    };
    let worst = (0..trial.work(50_000, 1_000_000)).map(|_| off([rng.random(), rng.random()])).fold(0.0, f32::max);
    // At the sphere's lower pole a direction's last digit is worth √ε of u; a table's entry of small probability spreads
    // its share of u over more digits than the place has.
    found.checks.bound("inverse(map(u)) = u", worst.into(), 1e-5);
}

/// All 2²⁴ numbers that a sampler gives: an identity.
fn exhausted(_: &Trial, found: &mut Findings) {
    let weights = [0.0, 3.0, 1e-20, 0.0, 1e6, 0.5, 0.0];
    let Some(table) = Table1::new(&weights) else { return found.checks.holds("the weights make a table", false) };
    let mut counts = [0u32; 7];
    let mut stated = true;
    for k in 0..1u32 << 24 {
        let u = k as f32 / (1 << 24) as f32;
        counts[table.choose(u).0] += 1;
        if k % 4099 == 0 {
            let draw = table.sample(u);
            stated &= draw.pdf == table.pdf(draw.x) && draw.pdf == table.probability(draw.index) * 7.0;
        }
    }
    let exact = |i: usize| counts[i] as f32 / (1 << 24) as f32 == table.probability(i);
    found.checks.holds("each entry comes as often as stated", (0..7).all(exact));
    found.checks.holds(
        "a positive weight is never lost, others never come",
        (0..7).all(|i| (counts[i] > 0) == (weights[i] > 0.0)),
    );
    found.checks.holds("density of a draw = density at its place", stated);
}
