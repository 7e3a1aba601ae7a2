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

/// Both samplers.
pub const SAMPLERS: [SamplerKind; 2] = [SamplerKind::Independent, SamplerKind::Sobol];

/// How much is spent on a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Relative bias to detect.
    pub aim: f64,
    /// Most rays for the renderer's own way: path, MIS, Sobol. It shows what the scene can detect.
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
            match estimate(scene, settings, expect, effort.aim, rays) {
                Ok(renders) => {
                    judge(&label, expect, &renders, found);
                    census.add(&label, &renders);
                }
                Err(e) => found.checks.holds(format!("{label}: {e}"), false),
            }
        }
    }
    census.report(found);
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

/// Renders with as many samples as the file says, or else as it takes.
fn estimate(scene: &Scene, settings: Settings, expect: &Expect, aim: f64, rays: f64) -> Result<Renders, Error> {
    let spp = match expect.spp {
        Some(spp) => spp.div_ceil(REPLICATES as u32).next_power_of_two(),
        None => samples(scene, &settings, expect, aim, rays)?,
    };
    renders(scene, &Settings { spp, ..settings })
}

/// Samples of a pixel in a replicate, a power of two: as many as an independent pilot says that it takes to detect the
/// aim, and for Student's law to hold. A mean of rare events is skew: with a skewness γ of the mean, p-values near 1e-8
/// are off by the factor exp(60 γ) (Edgeworth), so the γ of a replicate must fall below 0.25, that of the mean of
/// all below 0.03.
fn samples(scene: &Scene, settings: &Settings, expect: &Expect, aim: f64, rays: f64) -> Result<u32, Error> {
    const SKEWNESS: f64 = 0.25;
    const FIRST: u32 = 64;
    const PILOT: u64 = 1 << 32;
    let [x0, y0, x1, y1] = settings.crop;
    let pixels = x1.saturating_sub(x0).saturating_mul(y1.saturating_sub(y0)).max(1);
    let spp = FIRST.div_ceil(pixels).next_power_of_two();
    let pilot = renders(scene, &Settings { spp, seed: hash(&[settings.seed, PILOT]), ..settings.clone() })?;
    let spp = f64::from(spp);

    // Layers are parts: what the whole needs decides for the aim, any of them for the skewness.
    let quantities = quantities(expect, &pilot).into_iter().map(|(_, exact, image)| (brightest(exact), image));
    let bright: Vec<_> = quantities.filter(|((_, exact), _)| *exact > 0.0).collect();
    let mut wanted = SE_PER_DETECTED * unseen(1.0, f64::from(pixels) * REPLICATES as f64) / aim;
    for (i, ((channel, exact), image)) in bright.into_iter().enumerate() {
        let means = image.means(image.whole(), channel);
        let moments: Moments = means.iter().copied().collect();
        if i == 0 {
            let ratio = SE_PER_DETECTED * moments.standard_error() / (aim * exact);
            wanted = wanted.max(1.2 * spp * ratio * ratio);
        }
        wanted = wanted.max(spp * (skewness(&means) / SKEWNESS).powi(2));
    }
    let most = rays * spp / pilot.rays as f64;
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

/// Compares with what is expected.
fn judge(way: &str, expect: &Expect, renders: &Renders, found: &mut Findings) {
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
                let [n, dof] = [moments.n() as f64 * image.pixel_count() * renders.samples, moments.n() as f64 - 1.0];
                let se = moments.standard_error().hypot(unseen(exact[c], n));
                let (exact, rounding) = (exact[c], granted * exact[c]);
                found.checks.push(name, Evidence::Z { exact, estimate: moments.mean(), se, dof, rounding });
            }
        }
        let (c, value) = brightest(exact);
        if value > 0.0 && image.pixel_count() > 1.0 {
            let tiles = estimates(image, c, value, renders.samples).into_iter();
            let (p, n) = worst(tiles.map(|tile| tile.minus_exact(value).p_of_zero(granted * value)));
            found.checks.p(format!("{what} {way}: worst of {n} tiles"), p);
        }
        if found.checks.checks()[first..].iter().any(|check| check.p() < picture::SUSPECT) {
            found.exhibits.extend(picture::of_expected(&format!("{what} {way}"), image, exact));
        }
    }
}
