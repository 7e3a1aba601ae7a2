//! Means with as many samples as a detectable bias asks for.

use super::Trial;
use crate::sampler::{Kind, Sampler};
use crate::stats::Moments;
use crate::warp::ONE_MINUS_EPSILON;

/// Standard errors between no bias and one that is found: a limit of 6 (5·10⁴ checks at α = 10⁻⁴), Student's law of
/// [`REPLICATES`], and 2.33 for a power of 0.99.
pub const SE_PER_DETECTED: f64 = 9.5;

/// Independent replicates of a mean: enough for their mean to be nearly normal and Student's law to have light tails.
pub const REPLICATES: u64 = 64;

/// Steps of Kronecker points in D dimensions: powers of the inverse of the root of x^(D+1) = x + 1 (Roberts 2018).
fn steps<const D: usize>() -> [f64; D] {
    let root = (0..64).fold(1.5f64, |x, _| (1.0 + x).powf(1.0 / (D as f64 + 1.0)));
    std::array::from_fn(|k| root.powi(-(k as i32) - 1))
}

/// Means of `f` over the unit cube: [`REPLICATES`] randomly shifted sets of `points` Kronecker points, which fill the
/// cube evenly in all its dimensions together (Cranley & Patterson 1976).
pub fn replicates<const D: usize>(seed: u64, points: u64, mut f: impl FnMut([f32; D]) -> f64) -> Moments {
    let [m] = replicates_each(seed, points, |u| [f(u)]);
    m
}

/// Means of several functions over the same points.
pub fn replicates_each<const D: usize, const K: usize>(
    seed: u64,
    points: u64,
    mut f: impl FnMut([f32; D]) -> [f64; K],
) -> [Moments; K] {
    let steps = steps::<D>();
    let mut moments = [Moments::new(); K];
    for replicate in 0..REPLICATES {
        let mut s = Sampler::new(Kind::Independent, seed, [0, 0], replicate, 1);
        let shift: [f64; D] = std::array::from_fn(|_| f64::from(s.next_1d()));
        let mut sum = [0.0; K];
        for i in 0..points {
            let place = |k: usize| ((shift[k] + i as f64 * steps[k]).fract() as f32).min(ONE_MINUS_EPSILON);
            let value = f(std::array::from_fn(place));
            sum.iter_mut().zip(value).for_each(|(sum, value)| *sum += value);
        }
        moments.iter_mut().zip(sum).for_each(|(m, sum)| m.push(sum / points as f64));
    }
    moments
}

/// The mean of `f` with as many points as it takes to detect a relative bias of `aim` against `exact`, at most
/// `most` a replicate. An independent pilot decides, so that the mean stays unbiased; it assumes that variance
/// falls with the number of points, which it does at least.
pub fn to_detect<const D: usize>(
    trial: &Trial,
    exact: f64,
    aim: f64,
    most: u64,
    mut f: impl FnMut([f32; D]) -> f64,
) -> Moments {
    let [m] = to_detect_each(trial, [exact], aim, most, |u| [f(u)]);
    m
}

/// Means of several functions over the same points: as many as the worst of them takes.
pub fn to_detect_each<const D: usize, const K: usize>(
    trial: &Trial,
    exact: [f64; K],
    aim: f64,
    most: u64,
    mut f: impl FnMut([f32; D]) -> [f64; K],
) -> [Moments; K] {
    const PILOT: u64 = 256;
    let pilot = replicates_each(trial.seed ^ 0x0050_494c_4f54, PILOT, &mut f);
    let ratio = |k: usize| SE_PER_DETECTED * pilot[k].standard_error() / (aim * exact[k].abs());
    let ratio = (0..K).map(ratio).fold(0.0, f64::max);
    // The pilot's own error of the error: a fifth more.
    let points = (1.2 * PILOT as f64 * ratio * ratio).clamp(PILOT as f64, most.max(PILOT) as f64);
    replicates_each(trial.seed, points as u64, f)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verify::Size;

    #[test]
    fn the_aim_is_reached() {
        let trial = Trial { seed: 5, size: Size::Default };
        let m = to_detect(&trial, 0.25, 1e-3, 1 << 20, |[x, y]: [f32; 2]| f64::from(x * y));
        assert!(SE_PER_DETECTED * m.standard_error() < 1.2e-3 * 0.25, "{m:?}");
        assert!(m.z(0.25).abs() < 5.0, "{m:?}");
    }
}
