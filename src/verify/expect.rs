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
use super::replicated::{Census, Renders, Replicated, renders, skewness};
use super::tiles::{estimates, unseen, worst};
use super::{Findings, Trial};
use crate::desc::{Expect, Filter, Integrator, SamplerKind, Strategy};
use crate::film::CLASSES;
use crate::render::{Error, Settings};
use crate::sampler::hash;
use crate::scene::Scene;
use crate::stats::{Evidence, Moments};

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
    census: &mut Census,
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
    let seed = hash(&[trial.seed, way.integrator as u64, way.strategy as u64, way.sampler as u64]);
    let render = || {
        let spp = match expect.spp {
            Some(spp) => spp.div_ceil(REPLICATES as u32).next_power_of_two(),
            None => samples(scene, &settings, expect, effort)?,
        };
        Ok((spp, renders(scene, &Settings { spp, seed, ..settings.clone() })?))
    };
    match render() {
        Ok((spp, renders)) => {
            judge(&way.to_string(), expect, &renders, spp, found);
            census.add(&way.to_string(), &renders);
        }
        Err::<_, Error>(e) => found.checks.holds(format!("{way}: {e}"), false),
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
    let spp = f64::from(spp);

    // Layers are parts: what the whole needs decides for the aim, any of them for the skewness.
    let quantities = quantities(expect, &pilot).into_iter().map(|(_, exact, image)| (brightest(exact), image));
    let bright: Vec<_> = quantities.filter(|((_, exact), _)| *exact > 0.0).collect();
    let mut wanted = SE_PER_DETECTED * unseen(1.0, f64::from(pixels) * REPLICATES as f64) / effort.aim;
    for (i, ((channel, exact), image)) in bright.into_iter().enumerate() {
        let means = image.means(image.whole(), channel);
        let moments: Moments = means.iter().copied().collect();
        if i == 0 {
            let ratio = SE_PER_DETECTED * moments.standard_error() / (effort.aim * exact);
            wanted = wanted.max(1.2 * spp * ratio * ratio);
        }
        wanted = wanted.max(spp * (skewness(&means) / SKEWNESS).powi(2));
    }
    let most = effort.rays * spp / pilot.rays as f64;
    let least = f64::from(FIRST.div_ceil(pixels));
    Ok((wanted.min(most).max(least) as u32).clamp(1, 1 << 24).next_power_of_two())
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

/// Compares with what is expected; `samples` of a pixel are in each replicate.
fn judge(way: &str, expect: &Expect, renders: &Renders, samples: u32, found: &mut Findings) {
    let granted = ROUNDING + expect.tolerance;
    for (what, exact, image) in quantities(expect, renders) {
        let first = found.checks.checks().len();
        // Grey answers have three equal channels: one is tested.
        let grey = exact.iter().all(|&x| x == exact[0]);
        for c in if grey { 1..2 } else { 0..3 } {
            let name = if grey { format!("{what} {way}") } else { format!("{what} {way} {}", ["R", "G", "B"][c]) };
            let moments = image.moments(image.whole(), c);
            if exact[c] == 0.0 {
                // No radiance is negative: a mean of 0 is 0 in all samples.
                found.checks.holds(format!("{name} is nothing"), moments.mean() == 0.0);
            } else {
                let [n, dof] =
                    [moments.n() as f64 * image.pixel_count() * f64::from(samples), moments.n() as f64 - 1.0];
                let se = moments.standard_error().hypot(unseen(exact[c], n));
                let (exact, rounding) = (exact[c], granted * exact[c]);
                found.checks.push(name, Evidence::Z { exact, estimate: moments.mean(), se, dof, rounding });
            }
        }
        let (c, value) = brightest(exact);
        if value > 0.0 && image.pixel_count() > 1.0 {
            let tiles = estimates(image, c, value, samples).into_iter();
            let (p, n) = worst(tiles.map(|tile| tile.minus_exact(value).p_of_zero(granted * value)));
            found.checks.p(format!("{what} {way}: worst of {n} tiles"), p);
        }
        if found.checks.checks()[first..].iter().any(|check| check.p() < picture::SUSPECT) {
            found.exhibits.extend(picture::of_expected(&format!("{what} {way}"), image, exact));
        }
    }
}
