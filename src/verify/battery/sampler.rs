//! D3: the numbers that everything is drawn with.
//!
//! Every point of a replicate fills the unit square evenly over seeds, pixels, replicates and dimensions (χ²); numbers of
//! different places are independent (χ² of pairs, correlations of products and of replicates' means); no number comes twice
//! in a sample; Sobol points are nets, lattices are lattices, and means of known integrals are right, with the variance that
//! theory promises.

use crate::sampler::{Kind, Specimen, specimens};
use crate::stats::{Moments, chi2_test};
use crate::verify::calibration::poisson_above;
use crate::verify::{Findings, Task, Topic, Trial};
use std::f64::consts::{E, PI};

const D3: Topic = Topic {
    id: "D3",
    title: "numbers are uniform, independent between places, and stratified within replicates",
    source: "Korobov 1959; Sobol 1967; Cranley & Patterson 1976; Owen 1995, 1997; O'Neill 2014; Burley 2020",
};

pub(super) fn tasks() -> Vec<Task> {
    type Part = (&'static str, fn(&Specimen, &Trial, &mut Findings));
    let parts: [Part; 6] = [
        ("uniformity", uniformity),
        ("pairs of places", pairs),
        ("correlations", correlations),
        ("no number twice", repetitions),
        ("integrals", integrals),
        ("stratification", stratification),
    ];
    let of = |specimen: Specimen| {
        parts.map(|(part, work)| {
            Task::new(D3, format!("{}: {part}", specimen.name), move |trial, found| work(&specimen, trial, found))
        })
    };
    specimens()
        .into_iter()
        .flat_map(of)
        .chain([Task::new(D3, "variance of stratified over independent points", gain)])
        .collect()
}

/// χ² of points of the square over `side`² bins of equal area.
fn chi2_square(side: usize, points: impl Iterator<Item = [f32; 2]>) -> f64 {
    let mut counts = vec![0.0; side * side];
    let mut n = 0.0;
    for u in points {
        let [x, y] = u.map(|u| (u * side as f32) as usize);
        counts[y * side + x] += 1.0;
        n += 1.0;
    }
    chi2_test(&counts, &vec![n / (side * side) as f64; side * side], 5.0).p
}

/// One point of a replicate, over seeds, pixels, replicates and dimensions in turn, is uniform.
fn uniformity(s: &Specimen, trial: &Trial, found: &mut Findings) {
    let (s, seed, size) = (*s, trial.seed, u64::from(s.replicate));
    let n: u32 = trial.work(1 << 15, 1 << 19);
    for (what, point) in [("first", 0), ("second", 1), ("last", size - 1)] {
        type Walk = (&'static str, Box<dyn Fn(u32) -> [f32; 2]>);
        let over: [Walk; 7] = [
            ("seeds", Box::new(move |k| s.at(seed.wrapping_add(k.into()), [0, 0], point, 0).next_2d())),
            ("rows", Box::new(move |k| s.at(seed, [7, k], point, 0).next_2d())),
            ("pixels", Box::new(move |k| s.at(seed, [k % 256, k / 256], point, 4).next_2d())),
            ("replicates", Box::new(move |k| s.at(seed, [0, 0], u64::from(k) * size + point, 0).next_2d())),
            ("branches", Box::new(move |k| s.at(seed, [0, 0], point, 0).fork(k).next_2d())),
            ("dimensions", Box::new(move |k| s.at(seed, [0, 0], point, 2 * k).next_2d())),
            (
                "pixels, taken singly",
                Box::new(move |k| {
                    let mut numbers = s.at(seed, [k % 512, k / 512], point, 7);
                    [numbers.next_1d(), numbers.next_1d()]
                }),
            ),
        ];
        for (over, u) in over {
            found.checks.p(format!("χ² of the {what} point over {over}"), chi2_square(32, (0..n).map(u)));
        }
    }
}

/// Another place: what is added to the pixel, the replicate, the seed and the dimension, and which of the pair it is.
struct Place {
    name: &'static str,
    pixel: [u32; 2],
    replicate: u64,
    seed: u64,
    dimension: u32,
    axis: usize,
}

const HERE: Place = Place { name: "itself", pixel: [0, 0], replicate: 0, seed: 0, dimension: 0, axis: 0 };

/// Places that a path, its neighbours or another run take numbers from.
const PLACES: [Place; 9] = [
    Place { name: "y of the pair", axis: 1, ..HERE },
    Place { name: "x of the next pair", dimension: 2, ..HERE },
    Place { name: "y of the next pair", dimension: 2, axis: 1, ..HERE },
    Place { name: "x of pair 17", dimension: 34, ..HERE },
    Place { name: "x of the next pixel", pixel: [1, 0], ..HERE },
    Place { name: "x of the pixel below", pixel: [0, 1], ..HERE },
    Place { name: "y of the pixel across", pixel: [1, 1], axis: 1, ..HERE },
    Place { name: "x of the next replicate", replicate: 1, ..HERE },
    Place { name: "x of the next seed", seed: 1, ..HERE },
];

impl Place {
    fn number(&self, s: &Specimen, seed: u64, pixel: [u32; 2], index: u64) -> f32 {
        let pixel = [pixel[0] + self.pixel[0], pixel[1] + self.pixel[1]];
        let index = index + self.replicate * u64::from(s.replicate);
        s.at(seed.wrapping_add(self.seed), pixel, index, self.dimension).next_2d()[self.axis]
    }
}

/// χ² of (x here, number there) over the square, over pixels far apart and points of the replicate.
fn pairs(s: &Specimen, trial: &Trial, found: &mut Findings) {
    for place in &PLACES {
        let point = |k: u32| {
            let (pixel, index) = ([k % 128 * 3, k / 128 * 3], u64::from(k * 7 % s.replicate));
            [&HERE, place].map(|p| p.number(s, trial.seed, pixel, index))
        };
        found
            .checks
            .p(format!("χ² of x with {}", place.name), chi2_square(16, (0..trial.work(1 << 15, 1 << 19)).map(point)));
    }
}

/// Products that an integrand over two places is made of: of the numbers over a replicate, and of the replicate's means.
fn correlations(s: &Specimen, trial: &Trial, found: &mut Findings) {
    let size = u64::from(s.replicate);
    let replicates = trial.work(1 << 11, 1 << 14).max(trial.work(1 << 17, 1 << 20) / size);
    for place in &PLACES {
        let (mut products, mut means) = (Moments::new(), Moments::new());
        for r in 0..replicates {
            // Every other replicate, so that "the next" is of no other product.
            let pixel = [(r % 64) as u32 * 3, (r / 64) as u32 * 3];
            let (mut product, mut a, mut b) = (0.0, 0.0, 0.0);
            for i in 0..size {
                let [x, y] = [&HERE, place].map(|p| f64::from(p.number(s, trial.seed, pixel, i)) - 0.5);
                (product, a, b) = (product + x * y, a + x, b + y);
            }
            // In units of the variances 1/12 and size/12 of independent numbers; against 1 and not 0, so that detectable
            // correlations are finite.
            products.push(1.0 + 12.0 * product / size as f64);
            means.push(1.0 + 12.0 * a * b / size as f64);
        }
        found.checks.moments(format!("1 + correlation with {}", place.name), 1.0, &products);
        found.checks.moments(format!("1 + correlation of means with {}", place.name), 1.0, &means);
    }
}

/// Equal numbers within one sample: of n(n − 1)/2 pairs one in 2²⁴ by chance, a Poisson count.
fn repetitions(s: &Specimen, trial: &Trial, found: &mut Findings) {
    const NUMBERS: u32 = 64;
    let samples = trial.work(2048, 1 << 15);
    let mut equal = 0;
    for k in 0..samples {
        let mut sampler = s.at(trial.seed, [k % 64, k / 64], u64::from(k * 5), 0);
        let mut numbers = Vec::with_capacity(NUMBERS as usize);
        // As a path takes them: singles and pairs in turn.
        while sampler.dimension() < NUMBERS {
            numbers.push(sampler.next_1d());
            numbers.extend(sampler.next_2d());
        }
        numbers.sort_by(f32::total_cmp);
        equal += numbers.windows(2).filter(|pair| pair[0] == pair[1]).count();
    }
    let mean = f64::from(samples) * f64::from(NUMBERS + 2) * f64::from(NUMBERS + 1) / 2.0 / f64::from(1 << 24);
    // P(count > equal) and a random share of P(count = equal): the p-value of a count becomes uniform.
    let [at_least, more] = [equal, equal + 1].map(|count| poisson_above(count, mean));
    let share = f64::from(s.at(trial.seed ^ 1, [0, 0], 0, 0).next_1d());
    found.checks.p("equal numbers are as rare as chance has it", more + share * (at_least - more));
}

type Integrand = (&'static str, f64, fn([f32; 4]) -> f64);

/// Integrals over the unit cube in closed form: smooth, with an edge, and across two pairs.
const INTEGRANDS: [Integrand; 4] = [
    ("x y", 0.25, |u| f64::from(u[0]) * f64::from(u[1])),
    ("quarter disk", PI / 4.0, |u| f64::from(u8::from(u[0] * u[0] + u[1] * u[1] < 1.0))),
    ("exp over 4-d", (E - 1.0) * (E - 1.0) * (E - 1.0) * (E - 1.0), |u| {
        u.iter().map(|&x| f64::from(x).exp()).product()
    }),
    ("bump across two pairs", 0.25 / 9.0, |u| {
        f64::from(u[0]) * f64::from(u[3]) * f64::from(u[1]).powi(2) * f64::from(u[2]).powi(2)
    }),
];

/// Means of `f` over replicates.
fn means(s: &Specimen, seed: u64, replicates: u64, f: fn([f32; 4]) -> f64) -> Moments {
    let size = u64::from(s.replicate);
    let mean = |r: u64| {
        let sample = |i| {
            let mut numbers = s.at(seed, [9, 1], r * size + i, 0);
            let ([a, b], [c, d]) = (numbers.next_2d(), numbers.next_2d());
            f([a, b, c, d])
        };
        (0..size).map(sample).sum::<f64>() / size as f64
    };
    (0..replicates).map(mean).collect()
}

/// Unbiased over randomisations.
fn integrals(s: &Specimen, trial: &Trial, found: &mut Findings) {
    for (name, exact, f) in INTEGRANDS {
        let replicates = trial.work(1 << 18, 1 << 22) / u64::from(s.replicate);
        // Numbers are cell corners of a grid of 2⁻²⁴: means are low by half a step in each of four dimensions.
        found.checks.replicated(name, exact, &means(s, trial.seed, replicates, f), 4e-7);
    }
}

/// Of Sobol points: one in each elementary interval of every prefix of a power of two. Of lattices: neighbours in y are
/// everywhere the same number of cells apart in x. Of both, the variance of the mean of x is 1/(12 n³), for of n points one
/// lies in each interval of length 1/n, uniform there and independent of the others (Owen 1997); of independent points it
/// is 1/(12 n).
fn stratification(s: &Specimen, trial: &Trial, found: &mut Findings) {
    let n = f64::from(s.replicate);
    let exact = match s.kind {
        Kind::Independent => 1.0 / (12.0 * n),
        Kind::Sobol => {
            found
                .checks
                .holds("every prefix is a (0, 2)-net", [0, 2, 7, 1000].into_iter().all(|d| is_net(s, trial.seed, d)));
            1.0 / (12.0 * n.powi(3))
        }
        Kind::Lattice => {
            found.checks.holds(
                "every replicate is a lattice",
                [0, 2, 7, 1000].into_iter().all(|d| is_lattice(s, trial.seed, d)),
            );
            1.0 / (12.0 * n.powi(3))
        }
    };
    let trials = trial.work(4000, 64_000);
    for axis in 0..2 {
        let square = |r: u64| {
            let x = |i: u32| {
                f64::from(s.at(trial.seed, [4, 4], r * u64::from(s.replicate) + u64::from(i), 6).next_2d()[axis])
            };
            ((0..s.replicate).map(x).sum::<f64>() / n - 0.5).powi(2)
        };
        let squares: Moments = (0..trials).map(square).collect();
        // The sum of n uniform numbers has an excess kurtosis of −1.2/n, so its square has variance σ⁴ (2 − 1.2/n).
        let se = exact * ((2.0 - 1.2 / n) / trials as f64).sqrt();
        found.checks.estimate(format!("variance of the mean of {}", ["x", "y"][axis]), exact, squares.mean(), se);
    }
}

/// Whether the first 2^k points of the first blocks have exactly one point in each of the 2^k boxes of every partition
/// 2^a × 2^(k−a) (Sobol 1967).
fn is_net(s: &Specimen, seed: u64, dimension: u32) -> bool {
    (0..4).all(|block| {
        let points: Vec<[f32; 2]> = (0..u64::from(s.replicate))
            .map(|i| s.at(seed, [1, 2], block * u64::from(s.replicate) + i, dimension).next_2d())
            .collect();
        (0..=s.replicate.ilog2()).all(|k| {
            (0..=k).all(|a| {
                let mut seen = vec![false; 1 << k];
                points[..1 << k].iter().all(|[x, y]| {
                    let column = (x * (1u32 << a) as f32) as usize;
                    let row = (y * (1u32 << (k - a)) as f32) as usize;
                    !std::mem::replace(&mut seen[row << a | column], true)
                })
            })
        })
    })
}

/// Whether the points of the first blocks fill each row and each column of n × n cells once, and the way in x from each row
/// to the next is the same, round the torus (Korobov 1959).
fn is_lattice(s: &Specimen, seed: u64, dimension: u32) -> bool {
    let n = s.replicate;
    (0..4).all(|block| {
        let mut columns = vec![n; n as usize];
        let mut rows = columns.clone();
        for i in 0..u64::from(n) {
            let point = s.at(seed, [1, 2], block * u64::from(n) + i, dimension).next_2d();
            let [x, y] = point.map(|u| (u * n as f32) as u32);
            (rows[y as usize], columns[x as usize]) = (x, y);
        }
        let step = |y: usize| (rows[(y + 1) % n as usize] + n - rows[y]) % n;
        let complete = [&rows, &columns].into_iter().all(|cells| cells.iter().all(|&cell| cell < n));
        complete && (0..n as usize).all(|y| step(y) == step(0))
    })
}

/// Stratified points do better than independent ones: much for a smooth integrand of one pair, whose variance falls
/// as n⁻³ log n (Sobol) or n⁻² (lattices) and not n⁻¹; less where there is an edge or a product over several pairs.
fn gain(trial: &Trial, found: &mut Findings) {
    for (name, _, f) in INTEGRANDS {
        let variance = |kind| means(&Specimen { name, kind, replicate: 512 }, trial.seed, 512, f).variance();
        let independent = variance(Kind::Independent);
        for (kind, smooth) in [(Kind::Sobol, 100.0), (Kind::Lattice, 50.0)] {
            let gain = independent / variance(kind);
            let least = if name == "x y" { smooth } else { 1.5 };
            found.checks.holds(format!("{name}, {kind:?}: the variance falls more than {least} times"), gain > least);
            found
                .words
                .push(format!("{name}: 512 points, {kind:?}: {gain:.1} times less variance than independent ones."));
        }
    }
}
