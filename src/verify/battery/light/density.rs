//! D1: the density of a light is the law of its samples.
//!
//! Directions drawn towards every specimen, from every reference point, against the integral of its density over bins of
//! the sphere (χ²); the density's total, as E\[1/pdf\] = ∫ dω over what is drawn; and one by one, the density that a sample
//! states against that of the hit that its direction leads to.

use crate::bsdf::Pdf;
use crate::light::{Light, LightSample, Specimen, specimens};
use crate::math::{Ray, offset_origin};
use crate::shape::Surface;
use crate::texture::Textures;
use crate::verify::chart::{Chart, Quadrature, fit};
use crate::verify::measure::{replicates, to_detect};
use crate::verify::{Exhibit, Findings, Task, Topic, Trial};
use glam::{Vec3, Vec3A};
use rand::RngExt;

const D1: Topic = Topic {
    id: "D1",
    title: "directions drawn from lights follow their density: χ² over bins, ∫ pdf dω = 1, pdf of sample = pdf of hit",
    source: "rules of evidence, 'the density is the law'",
};

/// Bins per axis of the rectangle that holds the light.
const BINS: usize = 12;

pub(super) fn tasks() -> Vec<Task> {
    let mut tasks = Vec::new();
    for Specimen { name, light, points } in specimens() {
        for (place, p) in points {
            let at = Placed { light: light.clone(), p: p.into() };
            let work = move |trial: &Trial, found: &mut Findings| {
                at.samples_and_hits(trial, found);
                if !at.light.is_delta() && at.is_seen() {
                    at.shape_and_total(trial, found);
                }
            };
            tasks.push(Task::new(D1, format!("{name}, {place}"), work));
        }
    }
    tasks
}

/// A light and the point that it is drawn from.
struct Placed {
    light: Light,
    p: Vec3A,
}

impl Placed {
    fn draw(&self, u: [f32; 2]) -> Option<LightSample> {
        self.light.sample(self.p, u, &Textures::default())
    }

    /// Whether anything is emitted to where it is seen from.
    fn is_seen(&self) -> bool {
        (0..64).any(|i| self.draw([(i % 8) as f32 / 8.0, (i / 8) as f32 / 8.0]).is_some())
    }

    fn emits(&self, wi: Vec3A, hit: &Surface) -> bool {
        !self.light.le(&hit.uv, hit.color, -wi.dot(hit.ng), &Textures::default()).is_black()
    }

    /// Where a ray goes on behind a hit.
    fn behind(wi: Vec3A, hit: &Surface) -> Ray {
        Ray::new(offset_origin(hit.p, hit.p_error, hit.ng, wi), wi)
    }

    /// Density over solid angle with which a sample may arrive from direction `wi`: summed over all points of the light
    /// that lie there, one behind the other, and that emit towards `p`.
    fn density(&self, wi: Vec3A) -> f64 {
        if self.light.surrounds() {
            return f64::from(self.light.le_and_pdf_from(wi).1);
        }
        let (mut sum, mut ray) = (0.0, Ray::new(self.p, wi));
        // Quadrics and triangles meet a ray twice at most.
        for _ in 0..2 {
            let Some((_, hit)) = self.light.intersect(&ray) else { break };
            if self.emits(wi, &hit) {
                sum += f64::from(self.light.pdf(self.p, hit.p, hit.ng));
            }
            ray = Self::behind(wi, &hit);
        }
        sum
    }

    /// χ² over bins, and E\[1/pdf\] of the directions drawn against ∫ dω where the density is positive: unlike ∫ pdf dω
    /// over uniform directions it has a small variance at silhouettes, where the density of area sampling has no bound.
    fn shape_and_total(&self, trial: &Trial, found: &mut Findings) {
        let mut rng = super::rng(trial.seed);
        let draw = |u| self.draw(u).map(|s| Vec3::from(s.wi));
        // Dim texels are drawn too seldom for a pilot to find them.
        let wide = matches!(self.light, Light::Environment(_));
        let chart = if wide { Chart::sphere(BINS) } else { Chart::of(draw, BINS) };
        let how = trial.pick(Quadrature::default(), Quadrature { strata: 16, rough: 24 });
        let count = trial.work(60_000, 1_000_000);
        let fit = fit(&chart, (rng.random(), count, how), "directions drawn", draw, |w| self.density(w.into()));
        found.checks.chi2("χ² of the shape", fit.test);
        found.exhibits.push(Exhibit::HeatMap(fit.map));

        let inverse = |u: [f32; 2]| match self.draw(u).map(|s| self.density(s.wi)) {
            Some(pdf) if pdf > 0.0 => 1.0 / pdf,
            _ => 0.0,
        };
        let support = |u: [f32; 2]| {
            let inside = chart.direction(u.map(f64::from)).is_some_and(|w| self.density(w.into()) > 0.0);
            chart.area() * f64::from(u8::from(inside))
        };
        let most = trial.work(1 << 12, 1 << 16) << if wide { 5 } else { 0 };
        let guess = replicates(rng.random(), 64, inverse).mean();
        let drawn = to_detect(trial, guess, 3e-3, most, inverse);
        let seen = to_detect(&Trial { seed: rng.random(), ..*trial }, guess, 3e-3, most, support);
        found.checks.equal("E[1/pdf] = solid angle", &drawn, &seen);
    }

    /// What `sample` says of its density is what `pdf` says of the direction; the light emits there what was promised;
    /// and the shadow ray ends before the light.
    fn samples_and_hits(&self, trial: &Trial, found: &mut Findings) {
        let mut rng = super::rng(trial.seed ^ 1);
        let (mut drawn, mut missed, mut worst) = (0, 0, 0f64);
        let (mut sound, mut unshadowed) = (true, true);
        for _ in 0..trial.work(10_000, 200_000) {
            let Some(s) = self.draw([rng.random(), rng.random()]) else { continue };
            sound &= (s.wi.length() - 1.0).abs() < 1e-6 && s.le.is_finite() && !s.le.is_black();
            let Pdf::SolidAngle(pdf) = s.pdf else { continue };
            drawn += 1;
            match self.compare(&s, pdf) {
                Some(hit) => {
                    worst = worst.max(hit.deviation);
                    sound &= hit.promised;
                    unshadowed &= hit.unshadowed;
                }
                None => missed += 1,
            }
        }
        found.checks.holds("unit directions, finite radiance, that of the hit", sound);
        if drawn > 0 {
            found.checks.bound("pdf of sample = pdf of hit", worst, 1e-4);
            found.checks.holds("no shadow ray meets its own light", unshadowed);
            found.checks.holds("98 % of the directions meet what was drawn", missed * 50 <= drawn);
        }
    }

    /// A sample beside the hit that its direction leads to; `None` where rounding at an edge or rim leads elsewhere.
    fn compare(&self, s: &LightSample, pdf: f32) -> Option<Compared> {
        if self.light.surrounds() {
            // At a texel's or a disk's edge rounding may lead beyond it.
            let deviation = f64::from(self.light.le_and_pdf_from(s.wi).1 / pdf - 1.0).abs();
            return (self.light.le_from(s.wi) == s.le && deviation < 1e-6).then_some(Compared {
                deviation,
                promised: true,
                unshadowed: true,
            });
        }

        // The hit nearest to the point drawn.
        let first = self.light.intersect(&Ray::new(self.p, s.wi));
        let second =
            first.and_then(|(t, hit)| self.light.intersect(&Self::behind(s.wi, &hit)).map(|(t2, hit)| (t + t2, hit)));
        let off = |h: &(f32, Surface)| (h.0 - s.distance).abs();
        let (t, hit) = first.into_iter().chain(second).min_by(|a, b| off(a).total_cmp(&off(b)))?;
        let cos = s.wi.dot(hit.ng).abs();
        // As far as rounding moves a hit.
        let near = 1e-5 * (self.p.length() + hit.p.length()) / cos;
        if cos < 1e-3 || off(&(t, hit)) > 1e-2 * t + near {
            return None;
        }

        // A direction off by an ulp moves the hit by d, and the cosine on a sphere of radius r by d/(r cos).
        let rounding = 1e-6 * (1.0 + t) / (cos * cos);
        let deviation = (self.light.pdf(self.p, hit.p, hit.ng) / pdf - 1.0).abs() - rounding;
        let mut le = self.light.le(&hit.uv, hit.color, -s.wi.dot(hit.ng), &Textures::default());
        if let Light::Triangle(triangle) = &self.light
            && triangle.is_pictured()
        {
            // Rounding leads to a point beside the one drawn: over the edge of a cell the density steps.
            if deviation > 1e-4 {
                return None;
            }
            if (le.luminance() / s.le.luminance() - 1.0).abs() < 1e-3 {
                le = s.le;
            }
        }

        // Nothing of the light is met on the way to the point, if that is seen at all: near a silhouette rounding may lose the
        // farther of two hits, and the point may be that one.
        let alone = second.is_none_or(|(t2, _)| t2 > 1.05 * first.map_or(0.0, |(t, _)| t));
        let nearest = first.is_some_and(|first| off(&first) <= off(&(t, hit)) && off(&first) <= near);
        let to = s.p - self.p;
        let shadow = Ray { t_max: to.length() - s.margin, ..Ray::new(self.p, to.normalize()) };
        let hidden = match &self.light {
            Light::Quadric(quadric) => quadric.shape.hides_own_point(&shadow, shadow.t_max),
            other => other.intersect(&shadow).is_some(),
        };
        Some(Compared {
            deviation: f64::from(deviation).max(0.0),
            promised: le == s.le,
            unshadowed: !(alone && nearest && hidden),
        })
    }
}

/// A sample beside its hit.
struct Compared {
    /// Relative, of the densities, beyond what the rounding of the direction explains.
    deviation: f64,
    /// The hit emits what the sample says.
    promised: bool,
    /// The shadow ray ends before the light.
    unshadowed: bool,
}
