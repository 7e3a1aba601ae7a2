//! The warps: χ² of every density, round trips through the inverses, tables that draw exactly what they state.

use glam::{Vec2, Vec3};
use proptest::prelude::*;
use radianza::sampler::{Kind, Sampler};
use radianza::stats::{Chi2, Family, chi2_test};
use radianza::warp::{self, Quantiles, Table1, Table2};
use std::f64::consts::TAU;
use std::sync::LazyLock;

/// Independent points.
fn points(n: u64) -> impl Iterator<Item = [f32; 2]> {
    (0..n).map(|i| Sampler::new(Kind::Independent, 1, [0, 0], i, 1).next_2d())
}

/// χ² of directions against a density, on bins of equal solid angle of the cap 1 − z < `cap`.
fn chi2_directions(sample: impl Fn([f32; 2]) -> Vec3, pdf: impl Fn(Vec3) -> f64, cap: f64) -> Chi2 {
    const ROWS: usize = 20;
    const COLUMNS: usize = 40;
    const SUB: usize = 8;
    let n = 400_000;
    let (dz, dphi) = (cap / ROWS as f64, TAU / COLUMNS as f64);
    let mut observed = vec![0.0; ROWS * COLUMNS + 1];
    for w in points(n).map(sample) {
        assert!((w.length() - 1.0).abs() < 1e-6, "{w}");
        // 1 − z from the sine: a narrow cone has no digits left in z.
        let sin2 = w.x as f64 * w.x as f64 + w.y as f64 * w.y as f64;
        let height = if w.z > 0.0 { sin2 / (1.0 + (1.0 - sin2).max(0.0).sqrt()) } else { 1.0 - w.z as f64 };
        // A point on the edge between bins belongs to the upper one.
        let row = (height * (1.0 - 1e-6) / dz) as usize;
        let column = (((w.y as f64).atan2(w.x as f64).rem_euclid(TAU)) / dphi) as usize;
        // Rounding may carry a point over the rim; farther out is a miss.
        let inside = height < cap * (1.0 + 1e-5);
        observed[if inside { row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1) } else { ROWS * COLUMNS }] += 1.0;
    }
    let mut expected = vec![0.0; ROWS * COLUMNS + 1];
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            // Midpoint rule over the bin.
            let mut sum = 0.0;
            for i in 0..SUB {
                for j in 0..SUB {
                    let height = (row as f64 + (i as f64 + 0.5) / SUB as f64) * dz;
                    let phi = (column as f64 + (j as f64 + 0.5) / SUB as f64) * dphi;
                    let sin = (height * (2.0 - height)).sqrt();
                    let w = Vec3::new((sin * phi.cos()) as f32, (sin * phi.sin()) as f32, (1.0 - height) as f32);
                    sum += pdf(w);
                }
            }
            expected[row * COLUMNS + column] = n as f64 * sum / (SUB * SUB) as f64 * dz * dphi;
        }
    }
    let total: f64 = expected.iter().sum();
    assert!((total / n as f64 - 1.0).abs() < 1e-4, "∫ pdf = {}", total / n as f64);
    chi2_test(&observed, &expected, 5.0)
}

#[test]
fn directions_have_their_density() {
    let mut family = Family::new("densities of directions");
    let hemisphere = |w: Vec3| (w.z > 0.0) as u32 as f64 * warp::UNIFORM_HEMISPHERE_PDF as f64;
    family.chi2("uniform hemisphere", chi2_directions(warp::uniform_hemisphere, hemisphere, 2.0));
    let cosine = |w: Vec3| warp::cosine_hemisphere_pdf(w.z) as f64;
    family.chi2("cosine hemisphere", chi2_directions(warp::cosine_hemisphere, cosine, 2.0));
    let sphere = |_| warp::UNIFORM_SPHERE_PDF as f64;
    family.chi2("uniform sphere", chi2_directions(warp::uniform_sphere, sphere, 2.0));
    for one_minus_cos in [1e-14f32, 1e-8, 1e-4, 0.3, 1.0, 1.7] {
        let pdf = |_| warp::uniform_cone_pdf(one_minus_cos) as f64;
        let sample = |u| warp::uniform_cone(u, one_minus_cos);
        family.chi2(format!("cone {one_minus_cos:e}"), chi2_directions(sample, pdf, one_minus_cos as f64));
    }
    family.assert();
}

/// χ² of points of the plane that must be uniform over the bins that `bin` sorts them into.
fn chi2_bins(bins: usize, n: u64, bin: impl Fn([f32; 2]) -> usize) -> Chi2 {
    let mut counts = vec![0.0; bins];
    points(n).for_each(|u| counts[bin(u)] += 1.0);
    chi2_test(&counts, &vec![n as f64 / bins as f64; bins], 5.0)
}

#[test]
fn points_have_their_density() {
    let mut family = Family::new("densities of points");
    let n = 400_000;
    family.chi2(
        "disk",
        chi2_bins(20 * 40, n, |u| {
            let p = warp::uniform_disk(u);
            let ring = (p.length_squared() * 20.0) as usize;
            let sector = ((p.y.atan2(p.x) as f64).rem_euclid(TAU) / TAU * 40.0) as usize;
            ring.min(19) * 40 + sector.min(39)
        }),
    );
    family.chi2(
        "triangle",
        // 20² congruent small triangles: cells of the lattice, each of two halves.
        chi2_bins(400, n, |u| {
            let [b0, b1, b2] = warp::uniform_triangle(u);
            assert!(b0 >= 0.0 && b1 >= 0.0 && b2 >= -1e-7);
            let (x, y) = (b0 * 20.0, b1 * 20.0);
            let (i, j) = (x as usize, y as usize);
            let upper = (x.fract() + y.fract() > 1.0) as usize;
            // Row j holds 2 (20 − j) − 1 triangles.
            let before = j * (40 - j);
            (before + (2 * i + upper).min(38 - 2 * j)).min(399)
        }),
    );
    let cdf_bins = |cdf: f64| ((cdf * 100.0) as usize).min(99);
    family.chi2(
        "tent",
        chi2_bins(100, n, |u| {
            let t = warp::tent(u[0], 1.5) as f64 / 1.5;
            cdf_bins(if t < 0.0 { 0.5 * (1.0 + t).powi(2) } else { 1.0 - 0.5 * (1.0 - t).powi(2) })
        }),
    );

    // The filters that are drawn by quantiles, against the integral of the very window.
    type Window = (&'static str, fn(f64) -> f64);
    let windows: [Window; 2] =
        [("gaussian", |x| warp::gaussian(x, 0.5)), ("blackman-harris", |x| warp::blackman_harris(x, 1.5))];
    for (name, window) in windows {
        const BINS: usize = 100;
        let quantiles = Quantiles::new(window, 1.5);
        let mut counts = vec![0.0; BINS];
        points(n).for_each(|u| {
            counts[(((quantiles.sample(u[0]) as f64 + 1.5) / 3.0 * BINS as f64) as usize).min(BINS - 1)] += 1.0;
        });
        let integral = |i: usize| {
            (0..100).map(|k| window((i as f64 + (k as f64 + 0.5) / 100.0) / BINS as f64 * 3.0 - 1.5)).sum::<f64>()
        };
        let total: f64 = (0..BINS).map(integral).sum();
        let expected: Vec<f64> = (0..BINS).map(|i| n as f64 * integral(i) / total).collect();
        family.chi2(name, chi2_test(&counts, &expected, 5.0));
    }
    family.assert();
}

#[test]
fn table_draws_exactly_what_it_states() {
    // All 2²⁴ numbers that a sampler can return.
    let table = Table1::new(&[0.0, 3.0, 1e-20, 0.0, 1e6, 0.5, 0.0]).unwrap();
    let mut counts = [0u32; 7];
    for k in 0..1u32 << 24 {
        let draw = table.sample(k as f32 / (1 << 24) as f32);
        counts[draw.index] += 1;
        if k % 4099 == 0 {
            assert_eq!(draw.pdf, table.pdf(draw.x), "{draw:?}");
            assert_eq!(draw.pdf, table.probability(draw.index) * 7.0);
        }
    }
    for (i, &count) in counts.iter().enumerate() {
        assert_eq!(count as f32 / (1 << 24) as f32, table.probability(i), "entry {i}");
    }
    assert!(counts[2] >= 1, "a positive weight is never lost");
    assert_eq!([counts[0], counts[3], counts[6]], [0; 3]);
}

#[test]
fn table_follows_its_weights() {
    let mut family = Family::new("tables");
    let n = 200_000;
    let [width, height] = [37, 23];
    let weights: Vec<f32> =
        (0..width * height).map(|i| if i % 7 == 3 { 0.0 } else { ((i * 31) % 101) as f32 }).collect();
    let total: f64 = weights.iter().map(|&w| w as f64).sum();
    let expected: Vec<f64> = weights.iter().map(|&w| w as f64 / total * n as f64).collect();
    let one = Table1::new(&weights).unwrap();
    let two = Table2::new(&weights, [width, height]).unwrap();
    assert_eq!((one.total(), two.total()), (total, total));
    let (mut counts1, mut counts2) = (vec![0.0; weights.len()], vec![0.0; weights.len()]);
    for u in points(n) {
        counts1[one.sample(u[0]).index] += 1.0;
        let draw = two.sample(u);
        let [x, y] = draw.p;
        assert_eq!(draw.index, [(x * width as f32) as usize, (y * height as f32) as usize]);
        assert_eq!(draw.pdf, two.pdf(draw.p));
        let stated = weights[draw.index[1] * width + draw.index[0]] as f64 / total * (width * height) as f64;
        assert!((draw.pdf as f64 / stated - 1.0).abs() < 1e-3, "{} for {stated}", draw.pdf);
        counts2[draw.index[1] * width + draw.index[0]] += 1.0;
    }
    family.chi2("one dimension", chi2_test(&counts1, &expected, 5.0));
    family.chi2("two dimensions", chi2_test(&counts2, &expected, 5.0));
    family.assert();
}

#[test]
fn table_refuses_what_is_no_density() {
    for weights in [&[][..], &[0.0, 0.0], &[1.0, -1.0], &[1.0, f32::NAN], &[f32::INFINITY]] {
        assert!(Table1::new(weights).is_none(), "{weights:?}");
        assert!(Table2::new(weights, [weights.len(), 1]).is_none(), "{weights:?}");
    }
    assert!(Table2::new(&[1.0; 6], [2, 2]).is_none());
    assert!(Table2::new(&[1.0; 4], [usize::MAX, 2]).is_none());
    assert!(Table2::new(&[f32::MAX; 4], [2, 2]).is_some());
}

fn close(a: [f32; 2], b: [f32; 2], tolerance: f32) -> bool {
    (Vec2::from(a) - Vec2::from(b)).abs().max_element() <= tolerance
}

static GAUSSIAN: LazyLock<Quantiles> = LazyLock::new(|| Quantiles::new(|x| warp::gaussian(x, 0.5), 1.5));

proptest! {
    #[test]
    fn inverses_undo_the_maps(u in [0.0f32..1.0, 0.0f32..1.0], exponent in -14f32..0.3) {
        prop_assert!(close(warp::uniform_disk_inverse(warp::uniform_disk(u)), u, 1e-6));
        prop_assert!(close(warp::cosine_hemisphere_inverse(warp::cosine_hemisphere(u)), u, 1e-6));
        prop_assert!(close(warp::uniform_hemisphere_inverse(warp::uniform_hemisphere(u)), u, 1e-5));
        // At the pole opposite, a direction's last digit is worth √ε of u.
        prop_assert!(close(warp::uniform_sphere_inverse(warp::uniform_sphere(u)), u, 1e-5));
        let k = 10f32.powf(exponent);
        let back = warp::uniform_cone_inverse(warp::uniform_cone(u, k), k);
        prop_assert!(close(back, u, 1e-5), "cone {k}: {u:?} {back:?}");
        let [b0, b1, _] = warp::uniform_triangle(u);
        prop_assert!(close(warp::uniform_triangle_inverse([b0, b1]), u, 1e-6));
        prop_assert!((warp::tent_inverse(warp::tent(u[0], 1.3), 1.3) - u[0]).abs() < 1e-6);
        let quantiles = &*GAUSSIAN;
        let x = quantiles.sample(u[0]);
        prop_assert!((quantiles.inverse(x) - u[0]).abs() < 1e-4);
        // The density is the slope of the inverse.
        let slope = (quantiles.inverse(x + 1e-3) - quantiles.inverse(x - 1e-3)) / 2e-3;
        prop_assert!((slope / quantiles.pdf(x) - 1.0).abs() < 0.05 || u[0] < 0.01 || u[0] > 0.99, "{slope}");
        prop_assert!(quantiles.pdf(x) > 0.0 && quantiles.pdf(1.6) == 0.0 && quantiles.pdf(-1.6) == 0.0);
    }

    #[test]
    fn tables_invert(weights in prop::collection::vec(0.0f32..10.0, 12), u in [0.0f32..1.0, 0.0f32..1.0]) {
        prop_assume!(weights.iter().any(|&w| w > 1e-3));
        let one = Table1::new(&weights).unwrap();
        let draw = one.sample(u[0]);
        prop_assert!((0.0..1.0).contains(&draw.x));
        // An entry of small probability spreads u over more of x than x can hold.
        prop_assert!((one.inverse(draw.x) - u[0]).abs() < 1e-6 * draw.pdf.max(1.0));
        let (index, probability, left) = one.choose(u[0]);
        prop_assert_eq!((index, probability), (draw.index, one.probability(index)));
        prop_assert!((0.0..1.0).contains(&left));
        let two = Table2::new(&weights, [4, 3]).unwrap();
        let draw = two.sample(u);
        prop_assert!(close(two.inverse(draw.p), u, 1e-5), "{:?} {:?}", two.inverse(draw.p), u);
    }
}
