//! A scene that carries its exact answer (`[expect]`) against the renderer, for each way of estimating that it names.
//!
//! Three kinds of checks speak for one way:
//!
//! * the mean over the region against the answer, by Student's t over independent replicates of that mean;
//! * the region in tiles, which finds faults of opposite sign that the mean hides: the worst of their t, with Šidák over
//!   the tiles (single pixels would mislead: where light comes by rare events most have seen too few);
//! * a census of samples that are no radiance: not finite, or negative.

use super::measure::{REPLICATES, SE_PER_DETECTED};
use super::picture;
use super::replicated::{Renders, Replicated, renders, skewness};
use super::{Findings, Trial};
use crate::desc::{Expect, Filter, Integrator, SamplerKind, Strategy};
use crate::film::CLASSES;
use crate::render::{Error, Settings};
use crate::sampler::hash;
use crate::scene::Scene;
use crate::stats::{Moments, two_sided_t};

/// Relative error that f32 arithmetic may leave on an estimate without variance.
pub const ROUNDING: f64 = 1e-5;

/// All strategies, each the oracle of the next.
pub const STRATEGIES: [Strategy; 5] =
    [Strategy::Uniform, Strategy::Cosine, Strategy::Bsdf, Strategy::Light, Strategy::Mis];

/// Both samplers.
pub const SAMPLERS: [SamplerKind; 2] = [SamplerKind::Independent, SamplerKind::Sobol];

/// How much is spent on one way of estimating.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Relative bias to detect.
    pub aim: f64,
    /// Most rays.
    pub rays: f64,
}

/// One estimator of the answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way {
    /// Which part of the rendering equation.
    pub integrator: Integrator,
    /// How the hemisphere is sampled.
    pub strategy: Strategy,
    /// Where the numbers come from.
    pub sampler: SamplerKind,
}

impl std::fmt::Display for Way {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?}/{:?}/{:?}", self.integrator, self.strategy, self.sampler)
    }
}

/// The ways that an answer holds for; the last is the renderer's own choice where it is among them.
pub fn ways(expect: &Expect) -> Vec<Way> {
    fn or<T: Copy>(list: &[T], all: &[T]) -> Vec<T> {
        if list.is_empty() { all.to_vec() } else { list.to_vec() }
    }
    let mut ways = Vec::new();
    for &integrator in &or(&expect.integrators, &[Integrator::Path]) {
        for &strategy in &or(&expect.strategies, &STRATEGIES) {
            for &sampler in &or(&expect.samplers, &SAMPLERS) {
                ways.push(Way { integrator, strategy, sampler });
            }
        }
    }
    let usual = |way: &Way| way.integrator == Integrator::Path && way.strategy == Strategy::Mis;
    ways.sort_by_key(usual);
    ways
}

/// Checks one answer, estimated in one way. `size` is that of the whole image.
pub fn check(
    scene: &Scene,
    size: [u32; 2],
    expect: &Expect,
    way: Way,
    effort: Effort,
    trial: &Trial,
    found: &mut Findings,
) {
    let region = expect.region.unwrap_or([0, 0, size[0], size[1]]);
    let settings = Settings {
        size,
        crop: region,
        camera: 0,
        spp: 1,
        time: None,
        replicate: 1,
        integrator: way.integrator,
        strategy: way.strategy,
        sampler: way.sampler,
        seed: trial.seed,
        max_depth: expect.max_depth,
        filter: Filter::Box,
        transport: !expect.layers.is_empty(),
        threads: 0,
        tile: u32::MAX,
    };
    let render = || {
        let spp = match expect.spp {
            Some(spp) => spp.div_ceil(REPLICATES as u32).next_power_of_two(),
            None => samples(scene, &settings, expect, effort)?,
        };
        renders(
            scene,
            &Settings {
                spp,
                seed: hash(&[trial.seed, way.integrator as u64, way.strategy as u64, way.sampler as u64]),
                ..settings.clone()
            },
        )
    };
    match render() {
        Ok(renders) => judge(&way.to_string(), expect, &renders, found),
        Err(e) => found.checks.holds(format!("{way}: {e}"), false),
    }
}

/// Samples of a pixel in a replicate, a power of two: as many as an independent pilot says that it takes to detect the
/// aim, and for Student's law to hold. A mean of rare events is skew: with a skewness γ of the mean, p-values near 1e-8
/// are off by the factor exp(60 γ) (Edgeworth), so the γ of a replicate must fall below 0.25, that of the mean of
/// all below 0.03.
fn samples(scene: &Scene, settings: &Settings, expect: &Expect, effort: Effort) -> Result<u32, Error> {
    const SKEWNESS: f64 = 0.25;
    const FIRST: u32 = 64;
    let [x0, y0, x1, y1] = settings.crop;
    let pixels = (x1 - x0) * (y1 - y0);
    let spp = FIRST.div_ceil(pixels).next_power_of_two();
    let pilot = renders(scene, &Settings { spp, seed: hash(&[settings.seed, 0x5049_4c4f_54]), ..settings.clone() })?;
    let (mut by_aim, mut by_skewness) = (1.0, 1.0f64);
    for (_, exact, image) in quantities(expect, &pilot) {
        let (channel, exact) = brightest(exact);
        let means = image.means(image.whole(), channel);
        let moments: Moments = means.iter().copied().collect();
        if exact > 0.0 {
            by_skewness = by_skewness.max((skewness(&means) / SKEWNESS).powi(2));
        }
        // Layers are parts: what the whole needs decides.
        if by_aim == 1.0 && exact > 0.0 {
            by_aim = 1.2 * (SE_PER_DETECTED * moments.standard_error() / (effort.aim * exact)).powi(2);
        }
    }
    let most = effort.rays / (pilot.rays as f64 / f64::from(spp));
    let least = f64::from((2 * FIRST).div_ceil(pixels));
    let wanted = (f64::from(spp) * by_aim.max(by_skewness)).min(most).max(least);
    Ok((wanted as u32).clamp(1, 1 << 24).next_power_of_two())
}

/// What is expected: name, exact RGB, image.
fn quantities<'a>(expect: &Expect, renders: &'a Renders) -> Vec<(String, [f64; 3], &'a Replicated)> {
    let beauty = expect.radiance.map(|value| ("L".to_string(), value.rgb(), &renders.beauty));
    let layer = |name: &String| CLASSES.iter().position(|class| class == name).and_then(|i| renders.layers.get(i));
    let layers = expect.layers.iter().filter_map(|(name, value)| Some((name.clone(), value.rgb(), layer(name)?)));
    beauty.into_iter().chain(layers).collect()
}

/// The channel with the largest value.
fn brightest(rgb: [f64; 3]) -> (usize, f64) {
    (0..3).map(|c| (c, rgb[c])).fold((0, rgb[0]), |best, x| if x.1 > best.1 { x } else { best })
}

/// Compares with what is expected.
fn judge(way: &str, expect: &Expect, renders: &Renders, found: &mut Findings) {
    let granted = ROUNDING + expect.tolerance;
    for (what, exact, image) in quantities(expect, renders) {
        // Grey answers have three equal channels: one is tested.
        let channels = if exact.iter().all(|&x| x == exact[0]) { 1..2 } else { 0..3 };
        let first = found.checks.checks().len();
        for c in channels.clone() {
            let moments = image.moments(image.whole(), c);
            let name = match channels.len() {
                1 => format!("{what} {way}"),
                _ => format!("{what} {way} {}", ["R", "G", "B"][c]),
            };
            if exact[c] == 0.0 {
                // No radiance is negative: a mean of 0 is 0 in all samples.
                found.checks.holds(format!("{name} is nothing"), moments.mean() == 0.0);
            } else {
                found.checks.replicated(name, exact[c], &moments, granted);
            }
        }
        let (c, value) = brightest(exact);
        if value > 0.0 {
            let (p, tiles) = worst_tile(image, c, value, granted);
            found.checks.p(format!("{what} {way}: worst of {tiles} tiles"), p);
        }
        if found.checks.checks()[first..].iter().any(|check| check.p() < picture::SUSPECT) {
            found.exhibits.extend(picture::of_expected(&format!("{what} {way}"), image, exact));
        }
    }
    found.checks.holds(format!("{way}: every sample is a radiance"), renders.bad_count == 0);
    if let Some((seed, bad)) = renders.bad.first() {
        found.words.push(format!(
            "{way}: {} samples are no radiance; the first is sample {} of pixel {:?} with seed {seed}: {:?}.",
            renders.bad_count, bad.index, bad.pixel, bad.rgb
        ));
    }
}

/// p of the worst of at most 16 tiles, and how many there are. Tiles see fewer rare events than the region, so their
/// skewness, pooled over all of them, is taken out of t by Hall's transformation (Hall 1992, "On the removal of skewness
/// by transformation"):
///
/// ```text
/// g(t) = t + a t² + a² t³/3 + a/2,   a = γ/(3 √n)
/// ```
fn worst_tile(image: &Replicated, channel: usize, exact: f64, granted: f64) -> (f64, usize) {
    let side = image.size[0].max(image.size[1]).div_ceil(4);
    let tiles = image.tiles(side);
    let means: Vec<Vec<f64>> = tiles.iter().map(|&tile| image.means(tile, channel)).collect();
    let gamma = means.iter().map(|m| skewness(m)).sum::<f64>() / tiles.len() as f64;
    let a = gamma / (3.0 * (REPLICATES as f64).sqrt());
    let p_of = |means: &Vec<f64>| {
        let moments: Moments = means.iter().copied().collect();
        let off = moments.mean() - exact;
        let t = (off.abs() - granted * exact).max(0.0).copysign(off) / moments.standard_error();
        match t {
            _ if off.abs() <= granted * exact => 1.0,
            _ if t.is_infinite() => 0.0,
            t => two_sided_t(t + a * t * t + a * a * t.powi(3) / 3.0 + a / 2.0, REPLICATES as f64 - 1.0),
        }
    };
    let p = means.iter().map(p_of).fold(1.0, f64::min);
    // 1 − (1 − p)^n without cancellation.
    (-(tiles.len() as f64 * (-p).ln_1p()).exp_m1(), tiles.len())
}
