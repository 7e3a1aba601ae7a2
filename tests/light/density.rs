//! The density is the law: samples of every light against the integral of its density.

use super::*;
use radianza::glam::{DVec2, DVec3};
use radianza::light::specimens;
use radianza::math::{Frame, Ray, offset_origin};
use rayon::prelude::*;

/// Bins per axis of the rectangle that holds the light.
const BINS: usize = 12;
/// Strata per bin and axis of the integral of the density.
const STRATA: u32 = 16;
const SAMPLES: u32 = 150_000;

/// Density over solid angle with which `sample` may arrive from direction `wi`: summed over all points of the light
/// that lie there, one behind the other, and that emit towards `p`.
fn density(light: &Light, p: Vec3, wi: Vec3) -> f64 {
    if let Light::Environment(environment) = light {
        return f64::from(environment.pdf(wi));
    }
    let (mut sum, mut o) = (0.0, p);
    // Quadrics and triangles meet a ray twice at most.
    for _ in 0..2 {
        let Some((_, hit)) = light.intersect(&Ray::new(o, wi)) else { break };
        let front = wi.dot(hit.ng) < 0.0;
        if !light.le(&hit.uv, hit.color, front, &Textures::default()).is_black() {
            sum += f64::from(light.pdf(p, hit.p, hit.ng));
        }
        o = offset_origin(hit.p, hit.p_error, hit.ng, wi);
    }
    sum
}

/// A rectangle of the sphere's equal-area map about `frame.n` (Lambert 1772: the map's distance from the centre is the
/// chord), along the main axes of a cloud of directions.
struct Chart {
    frame: Frame,
    low: DVec2,
    cell: DVec2,
}

impl Chart {
    /// Holds (nearly) all directions of a pilot run.
    fn new(pilot: &[Vec3]) -> Self {
        let centre = pilot.iter().sum::<Vec3>().try_normalize().unwrap_or(Vec3::Z);
        let mut chart = Self { frame: Frame::from_z(centre), low: DVec2::ZERO, cell: DVec2::ONE };
        // Turn the frame so that x is the direction of greatest variance: thin lights fill the rectangle.
        let second = |f: fn(DVec2) -> f64| pilot.iter().map(|&w| f(chart.map(w))).sum::<f64>();
        let turn = 0.5 * (2.0 * second(|p| p.x * p.y)).atan2(second(|p| p.x * p.x - p.y * p.y)) as f32;
        let (sin, cos) = turn.sin_cos();
        let (s, t) = (chart.frame.s, chart.frame.t);
        chart.frame = Frame { s: s * cos + t * sin, t: t * cos - s * sin, n: centre };
        let places = || pilot.iter().map(|&w| chart.map(w));
        let low = places().fold(DVec2::INFINITY, DVec2::min);
        let high = places().fold(DVec2::NEG_INFINITY, DVec2::max);
        if pilot.is_empty() {
            return Self { low: DVec2::splat(-2.0), cell: DVec2::splat(4.0 / BINS as f64), ..chart };
        }
        let size = (high - low) * 1.05;
        Self { low: low - 0.025 * (high - low), cell: size / BINS as f64, ..chart }
    }

    fn map(&self, w: Vec3) -> DVec2 {
        let w = self.frame.to_local(w).as_dvec3().normalize();
        let chord = (w - DVec3::Z).length();
        w.truncate().normalize_or_zero() * chord
    }

    /// Direction at a place of the map; `None` outside the disk of radius 2 that is the sphere.
    fn direction(&self, p: DVec2) -> Option<Vec3> {
        let r2 = p.length_squared();
        let local = (p * (1.0 - 0.25 * r2).max(0.0).sqrt()).extend(1.0 - 0.5 * r2);
        (r2 < 4.0).then(|| self.frame.to_world(local.as_vec3()).normalize())
    }

    fn bin(&self, w: Vec3) -> Option<usize> {
        let p = (self.map(w) - self.low) / self.cell;
        let inside = p.min_element() >= 0.0 && p.max_element() < BINS as f64;
        inside.then(|| p.y as usize * BINS + p.x as usize)
    }

    /// ∫ f dω over a bin, by strata that are refined where f is not smooth: at edges and silhouettes.
    fn integral(&self, bin: usize, rng: &mut Pcg64Mcg, f: impl Fn(Vec3) -> f64) -> f64 {
        let corner = self.low + self.cell * DVec2::new((bin % BINS) as f64, (bin / BINS) as f64);
        let mut mean = |corner: DVec2, size: DVec2, n: u32| {
            let (mut sum, mut low, mut high) = (0.0, f64::INFINITY, 0f64);
            for k in 0..n * n {
                let jitter = DVec2::new(rng.random(), rng.random());
                let p = corner + size * (DVec2::new((k % n).into(), (k / n).into()) + jitter) / f64::from(n);
                let value = self.direction(p).map_or(0.0, &f);
                (sum, low, high) = (sum + value, low.min(value), high.max(value));
            }
            (sum / f64::from(n * n), low >= 0.8 * high)
        };
        let size = self.cell / f64::from(STRATA);
        let strata = (0..STRATA * STRATA).map(|k| {
            let corner = corner + size * DVec2::new((k % STRATA).into(), (k / STRATA).into());
            // Probes that are not summed decide where to look closer: the sum stays unbiased.
            let (_, smooth) = mean(corner, size, 3);
            mean(corner, size, if smooth { 2 } else { 24 }).0
        });
        strata.sum::<f64>() * size.element_product()
    }
}

/// χ² for every specimen from every reference point; a last bin counts failed draws and directions off the chart.
#[test]
fn samples_follow_the_density() {
    let mut family = Family::new("directions drawn from lights");
    let cases: Vec<_> = specimens()
        .into_iter()
        .filter(|s| !s.light.is_delta())
        .flat_map(|s| s.points.clone().into_iter().map(move |(place, p)| (s.name, place, s.light.clone(), p)))
        .collect();
    let results: Vec<_> = cases.par_iter().map(|(name, place, light, p)| (name, place, fit(light, *p))).collect();
    for (name, place, p) in results {
        family.p(format!("{name}, {place}"), p);
    }
    family.assert();
}

fn fit(light: &Light, p: Vec3) -> f64 {
    let mut rng = Pcg64Mcg::new(12);
    let textures = Textures::default();
    let mut draw = || light.sample(p, [rng.random(), rng.random()], &textures).map(|s| s.wi);
    let pilot: Vec<Vec3> = (0..10_000).filter_map(|_| draw()).collect();
    let chart = Chart::new(&pilot);
    let outside = BINS * BINS;
    let mut observed = vec![0.0; outside + 1];
    for _ in 0..SAMPLES {
        observed[draw().and_then(|w| chart.bin(w)).unwrap_or(outside)] += 1.0;
    }
    let mut expected: Vec<f64> =
        (0..outside).map(|i| f64::from(SAMPLES) * chart.integral(i, &mut rng, |w| density(light, p, w))).collect();
    // Failed draws, and what is off the chart: ∫ pdf = 1 − their share. Half a percent is granted to the quadrature,
    // whose f32 directions do not resolve the 1/cos of silhouettes; the shape is then tested without it.
    let total = expected.iter().sum::<f64>() / f64::from(SAMPLES);
    if (total - 1.0).abs() < 5e-3 {
        expected.iter_mut().for_each(|e| *e /= total);
    }
    expected.push((f64::from(SAMPLES) - expected.iter().sum::<f64>()).max(0.0));
    // A bin that the light only touches may be missed by the quadrature: it is merged, not refused.
    expected.iter_mut().for_each(|e| *e = e.max(1e-6));
    chi2_test(&observed, &expected, 5.0).p
}

/// What `sample` says of its density is what `pdf` says of the direction; the light emits there what was promised; and
/// the shadow ray ends before the light.
#[test]
fn samples_and_hits_agree() {
    let textures = Textures::default();
    for specimen in specimens() {
        for (place, p) in &specimen.points {
            let (light, mut rng) = (&specimen.light, Pcg64Mcg::new(13));
            let (mut drawn, mut missed) = (0, 0);
            for _ in 0..20_000 {
                let Some(s) = light.sample(*p, [rng.random(), rng.random()], &textures) else { continue };
                let name = || format!("{}, {place}: {s:?}", specimen.name);
                assert!((s.wi.length() - 1.0).abs() < 1e-6 && s.le.is_finite() && !s.le.is_black(), "{}", name());
                let Some(pdf) = solid_angle_pdf(s.pdf) else { continue };
                drawn += 1;
                if let Light::Environment(environment) = light {
                    // At a texel's edge rounding may lead to its neighbour.
                    let same = environment.le(s.wi) == s.le && (environment.pdf(s.wi) / pdf - 1.0).abs() < 1e-6;
                    missed += u32::from(!same);
                    continue;
                }

                // The hit nearest to the point drawn; rounding at the rim may miss it.
                let first = light.intersect(&Ray::new(*p, s.wi));
                let behind = first.and_then(|(t, hit)| {
                    let o = offset_origin(hit.p, hit.p_error, hit.ng, s.wi);
                    light.intersect(&Ray::new(o, s.wi)).map(|(t2, hit)| (t + t2, hit))
                });
                let near = |h: &(f32, _)| (h.0 - s.distance).abs();
                let hit = first.into_iter().chain(behind).min_by(|a, b| near(a).total_cmp(&near(b)));
                let Some((t, hit)) = hit else {
                    missed += 1;
                    continue;
                };
                let cos = s.wi.dot(hit.ng).abs();
                let short = (t - s.distance).abs();
                if cos < 1e-3 || short > 1e-2 * t + 1e-5 * (p.length() + hit.p.length()) / cos {
                    missed += 1;
                    continue;
                }
                // A direction off by an ulp moves the hit by d, and the cosine on a sphere of radius r by d/(r cos).
                let tolerance = 1e-4 + 1e-6 * (1.0 + t) / (cos * cos);
                let again = light.pdf(*p, hit.p, hit.ng);
                assert!((again / pdf - 1.0).abs() < tolerance, "{again} at {cos}: {}", name());
                assert_eq!(s.le, light.le(&hit.uv, hit.color, s.wi.dot(hit.ng) < 0.0, &textures), "{}", name());

                // Nothing of the light is met in the last hundredth of the shadow ray, if its point is seen at all.
                let alone = behind.is_none_or(|(t2, _)| t2 > 1.05 * first.map_or(0.0, |(t, _)| t));
                if !alone || first.is_none_or(|first| near(&first) > near(&(t, hit))) {
                    continue;
                }
                let start = *p + s.wi * (0.99 * s.distance);
                let ray = Ray { t_max: 0.01 * s.distance, ..Ray::new(start, s.wi) };
                assert!(light.intersect(&ray).is_none(), "shadowed by itself: {}", name());
            }
            assert!(missed * 50 <= drawn, "{}, {place}: {missed} of {drawn} missed", specimen.name);
        }
    }
}
