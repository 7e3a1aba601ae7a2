//! Rounds of tiles on all cores → film.

mod order;
mod plan;
mod rounds;
mod schedule;
mod workers;

pub use schedule::{Decide, Next, Pixels, Schedule};

use crate::camera::Camera;
use crate::desc::{Filter, Integrator, SamplerKind, Strategy};
use crate::film::{self, Film, Invalid, Layers, PixelSample, Replicate, filter_offset};
use crate::integrator::replay::Replay;
use crate::integrator::{self, ByClass, Method, Observer, RayCount, Solver};
use crate::sampler::{self, Sampler};
use crate::scene::Scene;
use crate::spectrum::Spectrum;
use glam::Vec2;
use order::Area;
use plan::Plan;
use rounds::{Done, Job, Rounds};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// What is rendered, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Width and height of the whole image in pixels.
    pub size: [u32; 2],
    /// Pixels that are rendered: x0, y0, x1, y1 (upper ends excluded).
    pub crop: [u32; 4],
    /// Index of the camera.
    pub camera: usize,
    /// Samples per pixel, a multiple of `replicate`.
    pub spp: u32,
    /// Stop after the first whole replicate past this time, if earlier than `spp`.
    pub time: Option<Duration>,
    /// Samples per independent replicate, a power of two: the film's error comes from the spread of replicates.
    pub replicate: u32,
    /// Which part of the rendering equation.
    pub integrator: Integrator,
    /// How the hemisphere is sampled.
    pub strategy: Strategy,
    /// Where the numbers come from.
    pub sampler: SamplerKind,
    /// Seed of the sampler.
    pub seed: u64,
    /// Most reflections and refractions of a path.
    pub max_depth: Option<u32>,
    /// Pixel filter.
    pub filter: Filter,
    /// Split radiance by transport class.
    pub transport: bool,
    /// Worker threads; 0: those of the rayon pool that the caller is in, or all cores.
    pub threads: usize,
    /// Side of a tile in pixels; changes nothing in the image.
    pub tile: u32,
}

/// How far a render is.
#[derive(Clone, Copy, Debug, Default)]
pub struct Progress {
    /// Samples of all pixels taken.
    pub samples: u64,
    /// Samples of all pixels asked for.
    pub total: u64,
    /// Rays traced.
    pub rays: u64,
    /// Time since the start.
    pub elapsed: Duration,
    /// Mean over the pixels of stderr/(mean + 0.01), after the last whole round; NaN before there are two replicates.
    pub relative_error: f64,
}

/// A sample of which a value was not finite, or negative where nothing is; that value counts as 0 in the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BadSample {
    /// Column and row.
    pub pixel: [u32; 2],
    /// Sample index, for `--replay`.
    pub index: u64,
    /// The first layer that cannot hold what came, and that.
    pub invalid: Invalid,
}

/// A finished or interrupted render.
#[derive(Debug)]
pub struct Output {
    /// Sums of all pixels.
    pub film: Film,
    /// The first samples of which a value was invalid.
    pub bad: Vec<BadSample>,
    /// How many there were.
    pub bad_count: u64,
    /// Rays traced.
    pub rays: u64,
    /// Samples of every pixel that no round left out.
    pub samples_per_pixel: u32,
    /// Wall-clock time.
    pub elapsed: Duration,
    /// Stopped before all samples were taken.
    pub interrupted: bool,
}

/// A render that cannot start.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// No such camera.
    #[error("camera {index} does not exist; the scene has {count}")]
    Camera {
        /// Asked for.
        index: usize,
        /// Present.
        count: usize,
    },
    /// An empty image.
    #[error("the image has {width}×{height} pixels and the crop {crop:?}; both must hold at least one pixel")]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// x0, y0, x1, y1.
        crop: [u32; 4],
    },
    /// Samples and replicates that do not fit.
    #[error(
        "{spp} samples per pixel in replicates of {replicate}: replicates are powers of two and divide the samples"
    )]
    Samples {
        /// Samples per pixel.
        spp: u32,
        /// Samples per replicate.
        replicate: u32,
    },
    /// The workers could not be started.
    #[error("the worker threads could not be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// Renders. Every pixel's samples are taken in the order of their indices, whatever the threads and tiles, so the
/// image is the same bit for bit. `stop` ends it after the running round (one replicate of every pixel).
pub fn render(
    scene: &Scene,
    settings: &Settings,
    stop: &AtomicBool,
    progress: &(dyn Fn(&Progress) + Sync),
) -> Result<Output, Error> {
    render_by(&Schedule::of(settings), scene, settings, stop, progress)
}

/// Renders the rounds that a schedule asks for.
pub fn render_by(
    schedule: &Schedule,
    scene: &Scene,
    settings: &Settings,
    stop: &AtomicBool,
    progress: &(dyn Fn(&Progress) + Sync),
) -> Result<Output, Error> {
    let tracer = Tracer::new(scene, settings)?;
    let pool = match settings.threads {
        0 => None,
        threads => Some(rayon::ThreadPoolBuilder::new().num_threads(threads).build()?),
    };
    let start = Instant::now();
    let tiles = order::tiles(settings.crop, settings.tile);
    let [x0, y0, x1, y1] = settings.crop;
    let pixels = u64::from(x1 - x0) * u64::from(y1 - y0);
    let total = pixels * u64::from(settings.spp);
    let (samples, rays) = (AtomicU64::new(0), AtomicU64::new(0));
    let film = Film::new(settings.size, settings.crop, &tracer.layers);
    let rounds = Rounds::new(film, tiles.len(), schedule, tracer.method.solver.splats());

    // Tile after tile, round after round: whoever is free takes the next, and nobody waits for a round to end.
    let enough = |round| round > 0 && settings.time.is_some_and(|limit| start.elapsed() >= limit);
    let next = || rounds.take(|round| !(stop.load(Ordering::Relaxed) || enough(round)));
    let work = |job: &Job| {
        let done = tracer.tile(tiles[job.tile], &job.plan);
        let rays = rays.fetch_add(done.rays, Ordering::Relaxed) + done.rays;
        let samples = samples.fetch_add(done.samples, Ordering::Relaxed) + done.samples;
        let put = rounds.put(job, done);
        progress(&Progress { samples, total, rays, elapsed: start.elapsed(), relative_error: put.relative_error });
        put.wanted
    };
    match &pool {
        Some(pool) => pool.install(|| workers::run(&next, &work)),
        None => workers::run(&next, &work),
    }
    let Done { film, rounds, bad, bad_count } = rounds.finish();
    let done = rounds * settings.replicate;
    Ok(Output {
        film,
        bad,
        bad_count,
        rays: rays.into_inner(),
        samples_per_pixel: done,
        elapsed: start.elapsed(),
        interrupted: done < settings.spp,
    })
}

/// One sample of one pixel in words: a line for every vertex of its path.
pub fn replay(scene: &Scene, settings: &Settings, pixel: [u32; 2], index: u64) -> Result<String, Error> {
    let tracer = Tracer::new(scene, settings)?;
    let mut watch = Replay::default();
    let sample = tracer.sample(pixel, index, &mut watch);
    let rgb = sample.radiance.to_rgb();
    Ok(format!("pixel {pixel:?}, sample {index}, seed {}\n{}radiance {rgb:?}\n", settings.seed, watch.text))
}

/// One replicate of the pixels of a tile.
struct Tile {
    sums: Replicate,
    samples: u64,
    rays: u64,
    bad: Vec<BadSample>,
}

fn positions([x0, y0, x1, y1]: Area) -> impl Iterator<Item = (u32, u32)> {
    (y0..y1).flat_map(move |y| (x0..x1).map(move |x| (x, y)))
}

/// All that a sample is a function of, beside its pixel and index.
struct Tracer<'a> {
    method: Method<'a>,
    camera: Camera,
    settings: &'a Settings,
    sampler: sampler::Kind,
    layers: Layers,
}

impl<'a> Tracer<'a> {
    fn new(scene: &'a Scene, settings: &'a Settings) -> Result<Self, Error> {
        let [width, height] = settings.size;
        let crop @ [x0, y0, x1, y1] = settings.crop;
        if x0 >= x1 || y0 >= y1 || x1 > width || y1 > height {
            return Err(Error::Size { width, height, crop });
        }
        let (spp, replicate) = (settings.spp, settings.replicate);
        if spp == 0 || !replicate.is_power_of_two() || !spp.is_multiple_of(replicate) {
            return Err(Error::Samples { spp, replicate });
        }
        let (index, count) = (settings.camera, scene.cameras.len());
        let camera = scene.cameras.get(index).ok_or(Error::Camera { index, count })?;
        let camera = Camera::new(camera, settings.size);
        Ok(Self {
            method: Method {
                scene,
                integrator: settings.integrator,
                strategy: settings.strategy,
                max_depth: settings.max_depth.unwrap_or(u32::MAX),
                media: scene.media_near(camera.middle()),
                solver: Solver::prepare(scene, settings.integrator),
            },
            camera,
            settings,
            layers: Layers::held(settings.transport),
            sampler: match settings.sampler {
                SamplerKind::Independent => sampler::Kind::Independent,
                SamplerKind::Sobol => sampler::Kind::Sobol,
                SamplerKind::Lattice => sampler::Kind::Lattice,
            },
        })
    }

    /// The replicates that a round takes of the pixels of an area.
    fn tile(&self, area: Area, plan: &Plan) -> Tile {
        if self.settings.transport {
            self.watched_tile(area, plan, |(classes, rays): &(ByClass, RayCount)| (rays.0, &classes.0))
        } else {
            self.watched_tile(area, plan, |rays: &RayCount| (rays.0, &[Spectrum::ZERO; 7]))
        }
    }

    /// [`Self::tile`] with an observer of every path, which tells how many rays there were, and the radiance by class.
    fn watched_tile<O: Observer + Default>(
        &self,
        area: Area,
        plan: &Plan,
        seen: impl Fn(&O) -> (u64, &film::ByClass),
    ) -> Tile {
        let mut tile = Tile { sums: Replicate::new(&self.layers, area), samples: 0, rays: 0, bad: Vec::new() };
        let ([x0, y0, x1, _], length) = (self.settings.crop, u64::from(self.settings.replicate));
        for (x, y) in positions(area) {
            let i = (y - y0) as usize * (x1 - x0) as usize + (x - x0) as usize;
            let Some(replicate) = plan.replicate(i).map(u64::from) else { continue };
            let mut pixel = tile.sums.pixel([x, y]);
            for index in replicate * length..(replicate + 1) * length {
                let mut watch = O::default();
                let sample = self.sample([x, y], index, &mut watch);
                let (rays, classes) = seen(&watch);
                tile.rays += rays;
                if let Some(invalid) = pixel.add(&sample, classes) {
                    tile.bad.push(BadSample { pixel: [x, y], index, invalid });
                }
            }
            tile.samples += length;
        }
        tile
    }

    /// A sample is a pure function of (seed, pixel, index).
    fn sample<O: Observer>(&self, pixel: [u32; 2], index: u64, watch: &mut O) -> PixelSample {
        let mut u = Sampler::new(self.sampler, self.settings.seed, pixel, index, self.settings.replicate);
        let centre = Vec2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
        let film = centre + filter_offset(self.settings.filter, u.next_2d());
        let lens = if self.camera.has_lens() { u.next_2d() } else { [0.5; 2] };
        let ray = self.camera.ray(film, lens);
        integrator::radiance(&self.method, &ray, &mut u, watch)
    }
}
