//! The density from the other end: what is said of it, and what it is.

use super::identities::{LOOKS, numbers, stream, uniform};
use super::{Density, Draw, Rgb, Scattering};
use crate::verify::{Findings, Trial};
use glam::DVec3;

/// A scattering function whose density is what it says from the other end: the law of the same draws, where that is right.
#[derive(Clone, Copy, Debug)]
pub struct Reversed<S>(pub S);

impl<S: Scattering> Scattering for Reversed<S> {
    fn sample(&self, wo: DVec3, u: [f32; 3]) -> Option<Draw> {
        self.0.sample(wo, u)
    }
    fn eval(&self, wo: DVec3, wi: DVec3) -> Rgb {
        self.0.eval(wo, wi)
    }
    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.0.pdf_rev(wi, wo).unwrap_or(0.0)
    }
}

/// pdf_rev(wo, wi) = pdf(wi, wo) within `rounding`, for directions drawn from `wo` and for uniform ones. Of a pair beyond it,
/// what the rounding of the directions explains is granted.
pub fn reverse(found: &mut Findings, trial: &Trial, name: &str, s: &impl Scattering, wo: DVec3, rounding: f64) {
    let (mut worst, mut compared) = (0f64, 0);
    let mut compare = |wi: DVec3| {
        let (Some(said), is) = (s.pdf_rev(wo, wi), s.pdf(wi, wo)) else { return };
        let largest = said.max(is);
        if largest > 0.0 {
            compared += 1;
            let mut off = (said - is).abs() / largest;
            if off.is_nan() || off > rounding {
                off -= sensitivity(s, wo, wi) / largest;
            }
            worst = if off.is_nan() { f64::INFINITY } else { worst.max(off) };
        }
    };
    for i in 0..trial.work(LOOKS, 10 * LOOKS) {
        let mut u = stream(trial, 4, i);
        if let Some(Draw { wi, density: Density::SolidAngle(_), .. }) = s.sample(wo, numbers(&mut u)) {
            compare(wi);
        }
        compare(uniform(&mut u));
    }
    if compared > 0 {
        found.checks.bound(format!("{name}: pdf_rev(wo, wi) = pdf(wi, wo)"), worst, rounding);
    }
}

/// How much both change, summed over the coordinates, where one of them is another by the rounding of f32.
fn sensitivity(s: &impl Scattering, wo: DVec3, wi: DVec3) -> f64 {
    let both = |wo, wi| [s.pdf_rev(wo, wi).unwrap_or(0.0), s.pdf(wi, wo)];
    let here = both(wo, wi);
    let steps = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * f64::from(f32::EPSILON));
    let moved = steps.iter().flat_map(|step| [both(wo + step, wi), both(wo, wi + step)]);
    moved.map(|there| (there[0] - here[0]).abs() + (there[1] - here[1]).abs()).sum()
}
