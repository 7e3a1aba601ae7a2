//! What must hold of every draw and every pair of directions, up to rounding.

use super::{Claims, Density, Rgb, Scattering};
use crate::sampler::{Kind, Sampler};
use crate::verify::{Findings, Trial};
use crate::warp::uniform_sphere;
use glam::DVec3;

/// Draws, or pairs of directions, that are looked at.
pub(super) const LOOKS: u64 = 3000;

/// Numbers of one look.
pub(super) fn stream(trial: &Trial, salt: u32, i: u64) -> Sampler {
    Sampler::new(Kind::Independent, trial.seed, [salt, 1], i, 1)
}

pub(super) fn numbers(s: &mut Sampler) -> [f32; 3] {
    let [u, v] = s.next_2d();
    [s.next_1d(), u, v]
}

pub(super) fn uniform(s: &mut Sampler) -> DVec3 {
    uniform_sphere(s.next_2d()).as_dvec3().normalize()
}

fn largest(x: Rgb) -> f64 {
    x.into_iter().fold(0.0, |a, b| if b.is_nan() { b } else { f64::max(a, b) })
}

/// True of radiance: finite and not negative.
fn sound(x: Rgb) -> bool {
    x.iter().all(|x| x.is_finite() && *x >= 0.0)
}

/// Largest relative difference of two values, to the larger of all of them.
fn difference(a: Rgb, b: Rgb) -> f64 {
    let scale = largest(a).max(largest(b));
    if scale == 0.0 { 0.0 } else { largest(std::array::from_fn(|k| (a[k] - b[k]).abs())) / scale }
}

/// Of draws towards `wo`: `sample().pdf` = `pdf(wi)`, weight = f |cos|/pdf, both within `rounding`; and a census of
/// what is negative, no number, or no direction. Of uniform directions: f > 0 only where pdf > 0, for else light is
/// lost.
pub fn draws(found: &mut Findings, trial: &Trial, name: &str, s: &impl Scattering, wo: DVec3, rounding: f64) {
    let (mut pdf_off, mut weight_off) = (0f64, 0f64);
    let (mut bad, mut unreached, mut continuous) = (0, 0, 0);
    for i in 0..trial.work(LOOKS, 10 * LOOKS) {
        let mut u = stream(trial, 2, i);
        if let Some(draw) = s.sample(wo, numbers(&mut u)) {
            let unit = (draw.wi.length() - 1.0).abs() < 1e-4;
            match draw.density {
                Density::SolidAngle(pdf) => {
                    continuous += 1;
                    let (f, again) = s.both(wo, draw.wi);
                    let weight = f.map(|f| f * draw.wi.z.abs() / again);
                    bad += u32::from(!(unit && sound(draw.weight) && sound(f) && pdf > 0.0 && pdf.is_finite()));
                    pdf_off = pdf_off.max((pdf - again).abs() / pdf.max(again));
                    weight_off = weight_off.max(difference(draw.weight, weight));
                }
                Density::Discrete(p) => bad += u32::from(!(unit && sound(draw.weight) && p > 0.0 && p <= 1.0)),
            }
        }
        let wi = uniform(&mut u);
        let (f, pdf) = s.both(wo, wi);
        bad += u32::from(!(sound(f) && pdf >= 0.0 && pdf.is_finite()));
        unreached += u32::from(pdf == 0.0 && largest(f) * wi.z.abs() > 1e-6);
    }
    found.checks.holds(format!("{name}: no NaN, infinity or negative value"), bad == 0);
    found.checks.holds(format!("{name}: no light where nothing is drawn"), unreached == 0);
    if continuous > 0 {
        found.checks.bound(format!("{name}: sample().pdf = pdf(wi)"), pdf_off, rounding);
        found.checks.bound(format!("{name}: weight = f cos/pdf"), weight_off, rounding);
    }
    if bad > 0 {
        found.words.push(format!("{name}: {bad} draws or values are negative or no numbers"));
    }
    if unreached > 0 {
        found.words.push(format!("{name}: {unreached} directions are lit but never drawn"));
    }
}

/// How much f changes, summed over the coordinates of `a` and `b`, where one of them is another by the rounding of f32.
/// Near the edge of a narrow lobe that is far more than f itself is rounded by.
fn sensitivity(s: &impl Scattering, a: DVec3, b: DVec3) -> Rgb {
    let f = s.eval(a, b);
    let steps = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * f64::from(f32::EPSILON));
    let moved = steps.iter().flat_map(|step| [s.eval(a + step, b), s.eval(a, b + step)]);
    moved.fold([0.0; 3], |sum, g| std::array::from_fn(|k| sum[k] + (g[k] - f[k]).abs()))
}

/// f(a → b)/η_b² = f(b → a)/η_a² within `claims.rounding`, for directions drawn and for uniform pairs on one side. Of a
/// pair beyond it, what the rounding of the directions explains is granted.
pub fn reciprocity(found: &mut Findings, trial: &Trial, name: &str, s: &impl Scattering, claims: &Claims) {
    let (mut worst, mut compared) = (0f64, 0);
    let mut compare = |a: DVec3, b: DVec3, eta: f64| {
        let (ab, ba) = (s.eval(a, b), s.eval(b, a).map(|f| f * eta * eta));
        let mut off = difference(ab, ba);
        if off > claims.rounding {
            let granted = largest(sensitivity(s, a, b)) + largest(sensitivity(s, b, a)) * eta * eta;
            off -= granted / largest(ab).max(largest(ba));
        }
        worst = worst.max(off);
        compared += u32::from(largest(ab).max(largest(ba)) > 0.0);
    };
    for i in 0..trial.work(LOOKS, 10 * LOOKS) {
        let mut u = stream(trial, 3, i);
        let (mut a, b) = (uniform(&mut u), uniform(&mut u));
        if !claims.two_sided {
            a.z = a.z.abs();
        }
        if let Some(draw) = s.sample(a, numbers(&mut u)) {
            let answers = claims.two_sided || draw.wi.z > 0.0;
            if answers && matches!(draw.density, Density::SolidAngle(_)) {
                compare(a, draw.wi, draw.eta);
            }
        }
        compare(a, if a.z * b.z < 0.0 { -b } else { b }, 1.0);
    }
    if compared > 0 {
        found.checks.bound(format!("{name}: f(a, b) = f(b, a)"), worst, claims.rounding);
    }
}
