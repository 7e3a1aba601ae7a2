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
use crate::desc::{self, Expect, Filter, Integrator, SamplerKind, Strategy};
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

/// Samplers that every answer is found with: independent numbers, and those that the renderer takes by itself.
pub const SAMPLERS: [SamplerKind; 2] = [SamplerKind::Independent, SamplerKind::Lattice];

/// How much is spent on a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Relative bias to detect.
    pub aim: f64,
    /// Most rays for the renderer's own way: path, MIS, lattices. It shows what the scene can detect.
    pub own: f64,
    /// Most rays for each other way.
    pub others: f64,
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

/// Checks all answers that `desc`, of which `scene` was compiled, carries.
pub fn checks(desc: &desc::Scene, scene: &Scene, effort: Effort, trial: &Trial, found: &mut Findings) {
    let size = desc.cameras.first().and_then(|camera| camera.resolution).unwrap_or([8, 8]);
    let mut census = Census::default();
    for (i, expect) in desc.expect.iter().enumerate() {
        let ways = ways(expect);
        for (k, &way) in ways.iter().enumerate() {
            let seed = hash(&[trial.seed, i as u64, k as u64]);
            let rays = if k + 1 == ways.len() { effort.own } else { effort.others };
            let label = if desc.expect.len() > 1 { format!("{way} {}", i + 1) } else { way.to_string() };
            let settings = settings(size, expect, way, seed);
            match estimate(scene, &settings, expect, effort.aim, rays) {
                Ok((renders, events)) => {
                    judge(&label, expect, &renders, &events, found);
                    census.add(&label, &renders);
                }
                Err(e) => found.checks.holds(format!("{label}: {e}"), false),
            }
        }
    }
    census.report(found);
    found.guarded = true;
}

fn settings(size: [u32; 2], expect: &Expect, way: Way, seed: u64) -> Settings {
    Settings {
        size,
        crop: expect.region.unwrap_or([0, 0, size[0], size[1]]),
        camera: 0,
        spp: 1,
        time: None,
        replicate: 1,
        integrator: way.integrator,
        strategy: way.strategy,
        sampler: way.sampler,
        seed,
        max_depth: expect.max_depth,
        filter: Filter::Box,
        transport: !expect.layers.is_empty(),
        threads: 0,
        tile: u32::MAX,
    }
}

/// Renders with as many samples as the file says, or else as it takes, and with the size of each quantity's events.
fn estimate(
    scene: &Scene,
    settings: &Settings,
    expect: &Expect,
    aim: f64,
    rays: f64,
) -> Result<(Renders, Vec<f64>), Error> {
    const FIRST: u32 = 64;
    const PILOT: u64 = 1 << 32;
    let [x0, y0, x1, y1] = settings.crop;
    let pixels = x1.saturating_sub(x0).saturating_mul(y1.saturating_sub(y0)).max(1);
    let first = FIRST.div_ceil(pixels).next_power_of_two();
    let seed = hash(&[settings.seed, PILOT]);
    let pilot = renders(scene, &Settings { spp: first, seed, ..settings.clone() })?;
    let events = events(expect, &pilot);
    let spp = match expect.spp {
        Some(spp) => spp.div_ceil(REPLICATES as u32),
        None => {
            let most = rays * f64::from(first) / pilot.rays as f64;
            let wanted = f64::from(first) * growth(expect, &pilot, &events, aim);
            wanted.min(most).max(f64::from(FIRST.div_ceil(pixels))) as u32
        }
    };
    let spp = spp.clamp(1, 1 << 24).next_power_of_two();
    Ok((renders(scene, &Settings { spp, ..settings.clone() })?, events))
}

/// The size of the largest event of each quantity: what one sample may be off the mean. At least the answer itself (a path
/// that roulette ends), and at least as much as makes the largest deviation of a replicate of the pilot. Stratified points need it
/// most: of N points nearly N p hit what has probability p, most replicates by the same number, so that their spread
/// says nothing of the few that do not.
fn events(expect: &Expect, pilot: &Renders) -> Vec<f64> {
    let size = |(_, exact, image): (String, [f64; 3], &Replicated)| {
        let (channel, exact) = brightest(exact);
        let means = image.means(image.whole(), channel);
        let mean = means.iter().sum::<f64>() / means.len() as f64;
        let largest = means.iter().map(|x| (x - mean).abs()).fold(0.0, f64::max);
        exact.max(largest * image.pixel_count() * pilot.samples)
    };
    quantities(expect, pilot).into_iter().map(size).collect()
}

/// How many times the pilot's samples it takes to detect the aim, and for Student's law to hold. A mean of rare events is
/// skew: with a skewness γ of the mean, p-values near 1e-8 are off by the factor exp(60 γ) (Edgeworth), so the γ of a
/// replicate must fall below 0.25, that of the mean of all below 0.03.
fn growth(expect: &Expect, pilot: &Renders, events: &[f64], aim: f64) -> f64 {
    const SKEWNESS: f64 = 0.25;
    let mut most = 0.0f64;
    // Layers are parts: what the whole needs decides for the aim, any of them for the skewness.
    for (i, (_, exact, image)) in quantities(expect, pilot).into_iter().enumerate() {
        let (channel, exact) = brightest(exact);
        if exact == 0.0 {
            continue;
        }
        let means = image.means(image.whole(), channel);
        if i == 0 {
            let se = means.iter().copied().collect::<Moments>().standard_error();
            let samples = REPLICATES as f64 * image.pixel_count() * pilot.samples;
            let by_spread = 1.2 * (SE_PER_DETECTED * se / (aim * exact)).powi(2);
            most = by_spread + SE_PER_DETECTED * unseen(events[i], samples) / (aim * exact);
        }
        most = most.max((skewness(&means) / SKEWNESS).powi(2));
    }
    most
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

/// Compares with what is expected; `events` are the largest of each quantity.
fn judge(way: &str, expect: &Expect, renders: &Renders, events: &[f64], found: &mut Findings) {
    let granted = ROUNDING + expect.tolerance;
    for ((what, exact, image), event) in quantities(expect, renders).into_iter().zip(events) {
        let (brightest, value) = brightest(exact);
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
                let [n, dof] = [moments.n() as f64 * image.pixel_count() * renders.samples, moments.n() as f64 - 1.0];
                let se = moments.standard_error().hypot(unseen(event * exact[c] / value, n));
                let (exact, rounding) = (exact[c], granted * exact[c]);
                found.checks.push(name, Evidence::Z { exact, estimate: moments.mean(), se, dof, rounding });
            }
        }
        if value > 0.0 && image.pixel_count() > 1.0 {
            let tiles = estimates(image, brightest, *event, renders.samples).into_iter();
            let (p, n) = worst(tiles.map(|tile| tile.minus_exact(value).p_of_zero(granted * value)));
            found.checks.p(format!("{what} {way}: worst of {n} tiles"), p);
        }
        if found.checks.checks()[first..].iter().any(|check| check.p() < picture::SUSPECT) {
            found.exhibits.extend(picture::of_expected(&format!("{what} {way}"), image, exact));
        }
    }
}
