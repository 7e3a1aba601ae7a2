//! A map of directions into bins of equal solid angle, and the goodness of fit of a density over them.

use super::HeatMap;
use crate::math::Frame;
use crate::stats::{Chi2, chi2_test};
use crate::warp::ONE_MINUS_EPSILON;
use glam::{DVec2, DVec3, Vec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A rectangle of square bins on the equal-area map of the sphere about `frame.n` (Lambert 1772: the distance from the
/// map's centre is the chord), along the main axes of a cloud of directions.
#[derive(Clone, Copy, Debug)]
pub struct Chart {
    frame: Frame,
    low: DVec2,
    cell: DVec2,
    bins: usize,
}

/// How finely a density is integrated over a bin.
#[derive(Clone, Copy, Debug)]
pub struct Quadrature {
    /// Strata per bin and axis.
    pub strata: u32,
    /// Points per stratum and axis where the density is not smooth: at edges and silhouettes.
    pub rough: u32,
}

impl Default for Quadrature {
    fn default() -> Self {
        Self { strata: 6, rough: 10 }
    }
}

impl Chart {
    /// The whole sphere, in `bins` × `bins` bins of which those at the corners lie outside the map.
    pub fn sphere(bins: usize) -> Self {
        let cell = DVec2::splat(4.0 / bins as f64);
        Self { frame: Frame::from_z(Vec3::Z), low: DVec2::splat(-2.0), cell, bins }
    }

    /// Holds the directions that `draw` gives on a grid of the unit square, borders included, with a margin of 2.5 % on
    /// each side, in `bins` × `bins` bins; the whole sphere where there are none.
    pub fn of(mut draw: impl FnMut([f32; 2]) -> Option<Vec3>, bins: usize) -> Self {
        let at = |k: u32| (k as f32 / 96.0).min(ONE_MINUS_EPSILON);
        let pilot: Vec<Vec3> = (0..97 * 97).filter_map(|i| draw([at(i % 97), at(i / 97)])).collect();
        let pilot = &pilot;
        let centre = pilot.iter().sum::<Vec3>().try_normalize().unwrap_or(Vec3::Z);
        let mut chart = Self { frame: Frame::from_z(centre), low: DVec2::ZERO, cell: DVec2::ONE, bins };
        if pilot.is_empty() {
            return Self::sphere(bins);
        }
        // Turn the frame so that x is the direction of greatest variance: thin clouds fill the rectangle.
        let second = |f: fn(DVec2) -> f64| pilot.iter().map(|&w| f(chart.map(w))).sum::<f64>();
        let turn = 0.5 * (2.0 * second(|p| p.x * p.y)).atan2(second(|p| p.x * p.x - p.y * p.y)) as f32;
        let (sin, cos) = turn.sin_cos();
        let (s, t) = (chart.frame.s, chart.frame.t);
        chart.frame = Frame { s: s * cos + t * sin, t: t * cos - s * sin, n: centre.into() };
        let places = || pilot.iter().map(|&w| chart.map(w));
        let low = places().fold(DVec2::INFINITY, DVec2::min);
        let high = places().fold(DVec2::NEG_INFINITY, DVec2::max);
        let margin = 0.025 * (high - low);
        Self { low: low - margin, cell: (high - low + 2.0 * margin) / bins as f64, ..chart }
    }

    /// Bins per axis.
    pub fn bins(&self) -> usize {
        self.bins
    }

    /// Area of the rectangle \[sr\]; what of it lies outside the map of the sphere included.
    pub fn area(&self) -> f64 {
        self.cell.element_product() * (self.bins * self.bins) as f64
    }

    /// The bin that holds a direction, row by row.
    pub fn bin(&self, w: Vec3) -> Option<usize> {
        let p = (self.map(w) - self.low) / self.cell;
        let inside = p.min_element() >= 0.0 && p.max_element() < self.bins as f64;
        inside.then(|| p.y as usize * self.bins + p.x as usize)
    }

    /// The direction at a place of the rectangle, in [0, 1)²: uniform over solid angle where the place is. `None` where
    /// the rectangle leaves the sphere.
    pub fn direction(&self, u: [f64; 2]) -> Option<Vec3> {
        self.unmap(self.low + self.cell * self.bins as f64 * DVec2::from(u))
    }

    /// ∫ f dω over a bin and the variance of that number, by jittered strata that are refined where f is not smooth.
    pub fn integral(&self, bin: usize, how: Quadrature, rng: &mut Pcg64Mcg, f: impl Fn(Vec3) -> f64) -> [f64; 2] {
        let corner = self.low + self.cell * DVec2::new((bin % self.bins) as f64, (bin / self.bins) as f64);
        let mut mean = |corner: DVec2, size: DVec2, n: u32| {
            let (mut sum, mut low, mut high) = (0.0, f64::INFINITY, 0f64);
            for k in 0..n * n {
                let jitter = DVec2::new(rng.random(), rng.random());
                let p = corner + size * (DVec2::new((k % n).into(), (k / n).into()) + jitter) / f64::from(n);
                let value = self.unmap(p).map_or(0.0, &f);
                (sum, low, high) = (sum + value, low.min(value), high.max(value));
            }
            (sum / f64::from(n * n), low >= 0.8 * high)
        };
        let Quadrature { strata, rough } = how;
        let size = self.cell / f64::from(strata);
        let (mut sum, mut variance) = (0.0, 0.0);
        for k in 0..strata * strata {
            let corner = corner + size * DVec2::new((k % strata).into(), (k / strata).into());
            // Probes that are not summed decide where to look closer: the sum stays unbiased. They reach beyond the
            // stratum, or a pole just inside its edge would be missed, mass and variance alike.
            let (_, smooth) = mean(corner - 0.25 * size, 1.5 * size, 4);
            let n = if smooth { 2 } else { rough };
            // Two independent means tell how far theirs may be off.
            let [a, b] = [mean(corner, size, n).0, mean(corner, size, n).0];
            sum += 0.5 * (a + b);
            variance += 0.25 * (a - b).powi(2);
        }
        let area = size.element_product();
        [sum * area, variance * area * area]
    }

    /// Where a direction lies on the map.
    fn map(&self, w: Vec3) -> DVec2 {
        let w = self.frame.to_local(w).as_dvec3().normalize();
        w.truncate().normalize_or_zero() * (w - DVec3::Z).length()
    }

    /// The direction at a place of the map; `None` outside the disk of radius 2 that is the sphere.
    fn unmap(&self, p: DVec2) -> Option<Vec3> {
        let r2 = p.length_squared();
        let local = (p * (1.0 - 0.25 * r2).max(0.0).sqrt()).extend(1.0 - 0.5 * r2);
        (r2 < 4.0).then(|| self.frame.to_world(local.as_vec3()).normalize().into())
    }
}

/// Outcome of [`fit`].
#[derive(Clone, Debug)]
pub struct Fit {
    /// χ² of the directions drawn against the density's integrals over the bins.
    pub test: Chi2,
    /// Share of the draws that gave a direction inside the chart.
    pub inside: f64,
    /// ∫ pdf dω over the chart, by quadrature.
    pub integral: f64,
    /// The counts.
    pub map: HeatMap,
}

/// χ² of `count` directions of `draw` that lie on the chart against ∫ `density` dω over its bins, given how many they
/// are: the test is of the shape alone, and leaves the density's total, which quadrature does not know as well, to
/// others. The quadrature's own variance is added to that of the counts; only poles of the density make it matter.
pub fn fit(
    chart: &Chart,
    (seed, count, how): (u64, u32, Quadrature),
    title: impl Into<String>,
    mut draw: impl FnMut([f32; 2]) -> Option<Vec3>,
    density: impl Fn(Vec3) -> f64,
) -> Fit {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let bins = chart.bins() * chart.bins();
    let mut observed = vec![0.0; bins];
    for _ in 0..count {
        if let Some(bin) = draw([rng.random(), rng.random()]).and_then(|w| chart.bin(w)) {
            observed[bin] += 1.0;
        }
    }
    let integrals: Vec<[f64; 2]> = (0..bins).map(|bin| chart.integral(bin, how, &mut rng, &density)).collect();
    let (drawn, integral) = (observed.iter().sum::<f64>(), integrals.iter().map(|[p, _]| p).sum::<f64>());
    // A bin that the support only touches may be missed by the quadrature: it is merged, not refused.
    let expected: Vec<f64> = integrals.iter().map(|[p, _]| (drawn * p / integral).max(1e-6)).collect();
    let shrunk = |(i, &o): (usize, &f64)| {
        let (e, variance) = (expected[i], integrals[i][1] * (drawn / integral).powi(2));
        (e + (o - e) * (e / (e + variance)).sqrt()).max(0.0)
    };
    let counts: Vec<f64> = observed.iter().enumerate().map(shrunk).collect();
    // Small counts have a heavier tail than χ² at the significance of thousands of checks.
    let test = chi2_test(&counts, &expected, 20.0);
    let map = HeatMap {
        title: title.into(),
        axes: ["along the greatest spread", "across"],
        columns: chart.bins(),
        observed,
        expected,
    };
    Fit { test, inside: drawn / f64::from(count), integral, map }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp::{cosine_hemisphere, cosine_hemisphere_pdf, uniform_cone};

    fn chart(draw: impl Fn([f32; 2]) -> Vec3) -> Chart {
        Chart::of(|u| Some(draw(u)), 12)
    }

    #[test]
    fn places_and_directions_are_inverse() {
        let chart = chart(|u| uniform_cone(u, 0.4));
        let size = 12.0;
        for bin in 0..144 {
            let place = [(bin % 12) as f64 + 0.5, (bin / 12) as f64 + 0.5].map(|x| x / size);
            assert_eq!(chart.direction(place).and_then(|w| chart.bin(w)), Some(bin));
        }
        // The cap of 1 − cos θ = 0.4 fills π/4 of the square about it.
        let omega = std::f64::consts::TAU * 0.4;
        assert!((chart.area() / omega - 4.0 / std::f64::consts::PI * 1.05f64.powi(2)).abs() < 0.01);
    }

    #[test]
    fn a_right_density_fits_and_a_wrong_one_does_not() {
        let chart = chart(cosine_hemisphere);
        let how = (3, 100_000, Quadrature::default());
        let right = fit(&chart, how, "", |u| Some(cosine_hemisphere(u)), |w| cosine_hemisphere_pdf(w.z).into());
        assert!(right.test.p > 1e-3 && right.inside > 0.999 && (right.integral - 1.0).abs() < 1e-3, "{right:?}");
        let wrong = fit(&chart, how, "", |u| Some(cosine_hemisphere(u)), |w| f64::from(w.z.max(0.0)).powf(1.1));
        assert!(wrong.test.p < 1e-9, "{:?}", wrong.test);
    }
}
