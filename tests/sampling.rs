//! The numbers: uniformity, nets, independence, known variances and integrals.

use proptest::prelude::*;
use radianza::sampler::{Kind, Sampler};
use radianza::stats::{Family, Moments, chi2_test};
use std::f64::consts::PI;

const KINDS: [Kind; 2] = [Kind::Independent, Kind::Sobol];

/// Sizes of replicates that take both ways of computing a Sobol point.
const REPLICATES: [u32; 2] = [64, 1024];

/// The pair at `dimension` of one sample.
fn pair(kind: Kind, seed: u64, pixel: [u32; 2], index: u64, replicate: u32, dimension: u32) -> [f32; 2] {
    let mut sampler = Sampler::new(kind, seed, pixel, index, replicate);
    sampler.skip_to(dimension);
    sampler.next_2d()
}

#[test]
fn scrambled_prefixes_are_nets() {
    // The first 2^k points of every aligned block have exactly one point in each of the 2^k boxes of every elementary
    // partition 2^a × 2^(k−a) (Sobol 1967): t = 0.
    for (replicate, blocks) in [(256u32, 4), (4096, 2)] {
        for dimension in [0, 2, 7, 1000] {
            for block in 0..blocks {
                for k in 0..=replicate.ilog2() {
                    for a in 0..=k {
                        let mut seen = vec![false; 1 << k];
                        for i in 0..1u64 << k {
                            let index = block * replicate as u64 + i;
                            let [x, y] = pair(Kind::Sobol, 5, [1, 2], index, replicate, dimension);
                            let column = (x * (1u32 << a) as f32) as usize;
                            let row = (y * (1u32 << (k - a)) as f32) as usize;
                            let taken = std::mem::replace(&mut seen[row << a | column], true);
                            assert!(!taken, "replicate {replicate} dimension {dimension} k {k} a {a}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn every_point_is_uniform_on_the_square() {
    // Over seeds, pixels, replicates and dimensions in turn, the same point of the net fills the square evenly.
    let mut family = Family::new("uniformity of one point");
    let n = 1 << 16;
    for kind in KINDS {
        for replicate in REPLICATES {
            for (what, point) in [("first", 0), ("second", 1), ("last", replicate as u64 - 1)] {
                type Walk = (&'static str, Box<dyn Fn(u32) -> [f32; 2]>);
                let over: [Walk; 5] = [
                    ("seeds", Box::new(move |k| pair(kind, k as u64, [0, 0], point, replicate, 0))),
                    ("rows", Box::new(move |k| pair(kind, 0, [7, k], point, replicate, 0))),
                    ("pixels", Box::new(move |k| pair(kind, 0, [k % 256, k / 256], point, replicate, 4))),
                    (
                        "replicates",
                        Box::new(move |k| pair(kind, 0, [0, 0], k as u64 * replicate as u64 + point, replicate, 0)),
                    ),
                    ("dimensions", Box::new(move |k| pair(kind, 0, [0, 0], point, replicate, 2 * k))),
                ];
                for (over, u) in over {
                    const SIDE: usize = 32;
                    let mut counts = vec![0.0; SIDE * SIDE];
                    for k in 0..n {
                        let [x, y] = u(k).map(|u| (u * SIDE as f32) as usize);
                        counts[y * SIDE + x] += 1.0;
                    }
                    let expected = vec![n as f64 / (SIDE * SIDE) as f64; SIDE * SIDE];
                    let name = format!("{kind:?}/{replicate} {what} point over {over}");
                    family.chi2(name, chi2_test(&counts, &expected, 5.0));
                }
            }
        }
    }
    family.assert();
}

#[test]
fn numbers_of_different_places_are_uncorrelated() {
    // Means of replicates, of x − ½ and of the products that an integrand over two places is made of.
    let mut family = Family::new("correlations");
    let replicates = 1 << 13;
    for kind in KINDS {
        for size in [4u32, 64, 512] {
            let mean = |a: &dyn Fn(u64) -> f32, b: &dyn Fn(u64) -> f32, r: u64| {
                let product = |i| (a(i) - 0.5) as f64 * (b(i) - 0.5) as f64;
                (0..size as u64).map(|i| product(r * size as u64 + i)).sum::<f64>() / size as f64
            };
            let at = move |pixel: [u32; 2], shift: u64, d: u32, axis: usize| {
                move |i: u64| pair(kind, 3, pixel, i + shift, size, d)[axis]
            };
            let here = at([10, 10], 0, 0, 0);
            type Place = (&'static str, Box<dyn Fn(u64) -> f32>);
            let others: [Place; 7] = [
                ("y of the pair", Box::new(at([10, 10], 0, 0, 1))),
                ("x of the next pair", Box::new(at([10, 10], 0, 2, 0))),
                ("y of the next pair", Box::new(at([10, 10], 0, 2, 1))),
                ("x of pair 17", Box::new(at([10, 10], 0, 34, 0))),
                ("x of the next pixel", Box::new(at([11, 10], 0, 0, 0))),
                ("x of the pixel below", Box::new(at([10, 11], 0, 0, 0))),
                ("x of the next replicate", Box::new(at([10, 10], size as u64, 0, 0))),
            ];
            for (what, other) in &others {
                let products: Moments = (0..replicates / 4).map(|r| mean(&here, other, r)).collect();
                family.moments(format!("{kind:?}/{size} x with {what}"), 0.0, &products);
            }
            // The means of two places over one replicate.
            let single = |u: &dyn Fn(u64) -> f32, r: u64| {
                (0..size as u64).map(|i| (u(r * size as u64 + i) - 0.5) as f64).sum::<f64>()
            };
            for (what, other) in &others {
                let products: Moments = (0..replicates / 4).map(|r| single(&here, r) * single(other, r)).collect();
                // x and y of an Owen-scrambled net are uncorrelated too.
                family.moments(format!("{kind:?}/{size} mean x with mean {what}"), 0.0, &products);
            }
        }
    }
    family.assert();
}

#[test]
fn owen_s_variance_of_a_linear_integrand() {
    // f(x) = x: of n scrambled points one lies in each interval of length 1/n, uniform there and independent of the
    // others, so the variance of their mean is 1/(12 n³), against 1/(12 n) of independent points (Owen 1997).
    let mut family = Family::new("variance of the mean of x");
    for size in [1u32, 4, 64, 256, 512] {
        for kind in KINDS {
            for axis in 0..2 {
                let n = size as f64;
                let exact = if kind == Kind::Sobol { 1.0 / (12.0 * n.powi(3)) } else { 1.0 / (12.0 * n) };
                let squares: Moments = (0..4000u64)
                    .map(|r| {
                        let x = |i| pair(kind, 11, [4, 4], r * size as u64 + i, size, 6)[axis] as f64;
                        let mean = (0..size as u64).map(x).sum::<f64>() / n;
                        (mean - 0.5).powi(2)
                    })
                    .collect();
                family.moments(format!("{kind:?}/{size} axis {axis}"), exact, &squares);
            }
        }
    }
    family.assert();
}

#[test]
fn known_integrals_come_out_and_smooth_ones_sooner() {
    let mut family = Family::new("integrals over the unit cube");
    type Integrand = (&'static str, f64, fn([f32; 4]) -> f64);
    let integrands: [Integrand; 4] = [
        ("x y", 0.25, |u| u[0] as f64 * u[1] as f64),
        ("quarter disk", PI / 4.0, |u| (u[0] * u[0] + u[1] * u[1] < 1.0) as u32 as f64),
        ("exp over 4-d", (1.0f64.exp() - 1.0).powi(4), |u| u.iter().map(|&x| (x as f64).exp()).product()),
        ("bump across two pairs", 0.25 / 9.0, |u| {
            u[0] as f64 * u[3] as f64 * (u[1] as f64).powi(2) * (u[2] as f64).powi(2)
        }),
    ];
    for size in REPLICATES {
        for (name, exact, f) in integrands {
            let [independent, sobol] = KINDS.map(|kind| {
                (0..400 * 1024 / size as u64)
                    .map(|r| {
                        let sample = |i| {
                            let mut s = Sampler::new(kind, 2, [9, 1], r * size as u64 + i, size);
                            let ([a, b], [c, d]) = (s.next_2d(), s.next_2d());
                            f([a, b, c, d])
                        };
                        (0..size as u64).map(sample).sum::<f64>() / size as f64
                    })
                    .collect::<Moments>()
            });
            family.moments(format!("{name}, independent/{size}"), exact, &independent);
            family.moments(format!("{name}, sobol/{size}"), exact, &sobol);
            let gain = independent.variance() / sobol.variance();
            println!("{name}/{size}: variance of independent over Sobol points {gain:.1}");
            // Theory: n² n^-3 log n against n^-1 for the smooth one in one pair; discontinuities and products over
            // several pairs gain less.
            let least = if name == "x y" { 100.0 } else { 1.5 };
            assert!(gain > least, "{name}/{size}: {gain}");
        }
    }
    family.assert();
}

#[test]
fn number_never_reaches_one() {
    for kind in KINDS {
        for replicate in REPLICATES {
            for index in 0..20_000 {
                let mut s = Sampler::new(kind, 0, [0, 0], index, replicate);
                for _ in 0..20 {
                    assert!((0.0..1.0).contains(&s.next_1d()));
                }
            }
        }
    }
}

proptest! {
    #[test]
    fn a_sample_is_a_function_of_its_place(seed in any::<u64>(), pixel in any::<[u32; 2]>(), index in any::<u64>(),
                                           log in 0u32..32, dimension in any::<u32>()) {
        for kind in KINDS {
            let u = pair(kind, seed, pixel, index, 1 << log, dimension);
            prop_assert!(u.iter().all(|x| (0.0..1.0).contains(x)));
            prop_assert_eq!(u, pair(kind, seed, pixel, index, 1 << log, dimension));
        }
    }
}
