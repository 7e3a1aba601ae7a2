//! Irradiance by drawing the light, by directions about the normal, and by directions about the light.

use crate::bsdf::Pdf;
use crate::light::Light;
use crate::math::{Frame, Ray};
use crate::spectrum::Spectrum;
use crate::stats::Moments;
use crate::texture::Textures;
use crate::verify::chart::Chart;
use crate::verify::measure::{replicates, to_detect};
use crate::verify::{Findings, Trial};
use crate::warp::cosine_hemisphere;
use glam::Vec3;
use std::f64::consts::PI;

/// Relative bias that each estimate is given points for: below half a percent, for the pilot knows its own error only
/// roughly, and so that the difference of two detects half a percent still.
const AIM: f64 = 3e-3;

/// Relative error of the arithmetic of a sample: some roundings of f32.
pub(super) const ROUNDING: f64 = 2e-6;

/// A light, and the surface that it falls on.
pub(super) struct Lit<'a> {
    /// The light.
    pub light: &'a Light,
    /// Where it falls.
    pub p: Vec3,
    /// Normal there.
    pub n: Vec3,
    /// Textures of its emission.
    pub textures: &'a Textures,
}

impl Lit<'_> {
    /// E = ∫ L cosθ dω estimated by L cosθ/pdf of directions drawn towards the light, one lane.
    fn sampled(&self, u: [f32; 2]) -> f64 {
        let Some(s) = self.light.sample(self.p, u, self.textures) else { return 0.0 };
        let (Pdf::SolidAngle(pdf) | Pdf::Discrete(pdf)) = s.pdf;
        f64::from(s.le.0.x) * f64::from(self.n.dot(s.wi).max(0.0)) / f64::from(pdf)
    }

    /// Radiance from `wi`, one lane: front and back of a surface count as a viewer in vacuum sees them, the nearer
    /// first.
    fn seen(&self, wi: Vec3) -> f64 {
        let le = match self.light {
            Light::Environment(environment) => environment.le(wi),
            light => light
                .intersect(&Ray::new(self.p, wi))
                .map_or(Spectrum::ZERO, |(_, hit)| light.le(&hit.uv, hit.color, wi.dot(hit.ng) < 0.0, self.textures)),
        };
        f64::from(le.0.x)
    }

    /// The irradiance by drawing the light, with `exact` or about as much to go by.
    pub(super) fn by_light(&self, trial: &Trial, exact: f64) -> Moments {
        to_detect(trial, exact, AIM, trial.pick(1 << 14, 1 << 18), |u| self.sampled(u))
    }

    /// The irradiance by cosine-weighted directions: E = π times the mean radiance.
    pub(super) fn by_hemisphere(&self, trial: &Trial, exact: f64) -> Moments {
        let frame = Frame::from_z(self.n);
        let trial = Trial { seed: trial.seed.wrapping_add(1), ..*trial };
        to_detect(&trial, exact, AIM, trial.pick(1 << 13, 1 << 18), |u| {
            PI * self.seen(frame.to_world(cosine_hemisphere(u)))
        })
    }

    /// The irradiance by directions uniform over a chart that holds the light.
    pub(super) fn by_chart(&self, trial: &Trial, exact: f64) -> Moments {
        let pilot = (0..64u32).flat_map(|i| (0..64u32).map(move |j| [i, j].map(|k| (k as f32 + 0.5) / 64.0)));
        let pilot: Vec<Vec3> =
            pilot.filter_map(|u| self.light.sample(self.p, u, self.textures)).map(|s| s.wi).collect();
        let chart = Chart::around(&pilot, 1);
        let trial = Trial { seed: trial.seed.wrapping_add(2), ..*trial };
        to_detect(&trial, exact, AIM, trial.pick(1 << 13, 1 << 18), |u: [f32; 2]| {
            let value = |wi: Vec3| self.seen(wi) * f64::from(wi.dot(self.n).max(0.0)) * chart.area();
            chart.direction(u.map(f64::from)).map_or(0.0, value)
        })
    }

    /// About how much it is.
    pub(super) fn guess(&self, trial: &Trial) -> f64 {
        replicates(trial.seed ^ 0x6775_6573_73, 64, |u| self.sampled(u)).mean()
    }

    /// The light's samples and directions about the normal, each against the exact value.
    pub(super) fn check(&self, trial: &Trial, found: &mut Findings, name: &str, exact: f64) {
        found.checks.replicated(format!("{name}: light"), exact, &self.by_light(trial, exact), ROUNDING);
        found.checks.replicated(format!("{name}: hemisphere"), exact, &self.by_hemisphere(trial, exact), ROUNDING);
    }

    /// The light's samples against directions about the light, where there is no closed form.
    pub(super) fn agree(&self, trial: &Trial, found: &mut Findings, name: &str) {
        let guess = self.guess(trial);
        found.checks.equal(name, &self.by_light(trial, guess), &self.by_chart(trial, guess));
    }
}
