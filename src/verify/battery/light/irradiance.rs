//! Irradiance by drawing the light, by directions about the normal, and by directions about the light.

use crate::bsdf::Pdf;
use crate::light::Light;
use crate::math::{Frame, Ray, offset_origin};
use crate::stats::Moments;
use crate::texture::Textures;
use crate::verify::chart::Chart;
use crate::verify::measure::{replicates, to_detect};
use crate::verify::{Findings, Trial};
use crate::warp::cosine_hemisphere;
use glam::{Vec3, Vec3A};
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
        let Some(s) = self.light.sample(self.p.into(), u, self.textures) else { return 0.0 };
        let (Pdf::SolidAngle(pdf) | Pdf::Discrete(pdf)) = s.pdf;
        f64::from(s.le.0.x) * f64::from(s.wi.dot(self.n.into()).max(0.0)) / f64::from(pdf)
    }

    /// Radiance from `wi`, one lane: front and back of a surface count as a viewer in vacuum sees them, the nearer
    /// first.
    fn seen(&self, wi: Vec3A) -> f64 {
        self.layers(wi, 1)
    }

    /// Radiance that up to `count` layers of the light emit along `wi`, one behind the other and none hiding the next:
    /// what samples of the light stand for before shadow rays.
    fn layers(&self, wi: Vec3A, count: u32) -> f64 {
        if self.light.surrounds() {
            return f64::from(self.light.le_from(wi).0.x);
        }
        let (mut sum, mut ray) = (0.0, Ray::new(self.p, wi));
        for _ in 0..count {
            let Some((_, hit)) = self.light.intersect(&ray) else { break };
            sum += f64::from(self.light.le(&hit.uv, hit.color, -wi.dot(hit.ng), self.textures).0.x);
            ray = Ray::new(offset_origin(hit.p, hit.p_error, hit.ng, wi), wi);
        }
        sum
    }

    /// Most points a replicate; pictures need more, for they have small texels.
    fn most(&self, trial: &Trial) -> u64 {
        let wide = matches!(self.light, Light::Environment(_));
        trial.work(1 << 13, 1 << 16) << if wide { 4 } else { 0 }
    }

    /// The irradiance by drawing the light, with `exact` or about as much to go by.
    pub(super) fn by_light(&self, trial: &Trial, exact: f64) -> Moments {
        to_detect(trial, exact, AIM, self.most(trial), |u| self.sampled(u))
    }

    /// The irradiance by cosine-weighted directions: E = π times the mean radiance.
    pub(super) fn by_hemisphere(&self, trial: &Trial, exact: f64) -> Moments {
        let frame = Frame::from_z(self.n);
        let trial = Trial { seed: trial.seed.wrapping_add(1), ..*trial };
        to_detect(&trial, exact, AIM, self.most(&trial).max(trial.work(1 << 16, 1 << 19)), |u| {
            PI * self.seen(frame.to_world(cosine_hemisphere(u)))
        })
    }

    /// The irradiance by directions uniform over a chart that holds the light.
    pub(super) fn by_chart(&self, trial: &Trial, exact: f64) -> Moments {
        let chart = Chart::of(|u| self.light.sample(self.p.into(), u, self.textures).map(|s| s.wi.into()), 1);
        let trial = Trial { seed: trial.seed.wrapping_add(2), ..*trial };
        to_detect(&trial, exact, AIM, self.most(&trial), |u: [f32; 2]| {
            // Quadrics and triangles meet a ray twice at most.
            let value = |wi: Vec3| self.layers(wi.into(), 2) * f64::from(wi.dot(self.n).max(0.0)) * chart.area();
            chart.direction(u.map(f64::from)).map_or(0.0, value)
        })
    }

    /// About how much it is.
    pub(super) fn guess(&self, trial: &Trial) -> f64 {
        replicates(trial.seed ^ 0x0067_7565_7373, 64, |u| self.sampled(u)).mean()
    }

    /// The light's samples and directions about the normal, each against the exact value.
    pub(super) fn check(&self, trial: &Trial, found: &mut Findings, name: &str, exact: f64) {
        found.checks.replicated(format!("{name}: light"), exact, &self.by_light(trial, exact), ROUNDING);
        found.checks.replicated(format!("{name}: hemisphere"), exact, &self.by_hemisphere(trial, exact), ROUNDING);
    }

    /// The light's samples against directions that meet it, where there is no closed form.
    pub(super) fn agree(&self, trial: &Trial, found: &mut Findings, name: &str) {
        let guess = self.guess(trial);
        let met = match self.light {
            Light::Environment(_) => self.by_hemisphere(trial, guess),
            _ => self.by_chart(trial, guess),
        };
        found.checks.equal(name, &self.by_light(trial, guess), &met);
    }
}
