//! Tiles × sample indices on all cores → film.

use crate::desc::{Filter, Integrator, SamplerKind, Strategy};
use std::time::Duration;

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
    /// Worker threads; 0: all cores.
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
    /// Mean over the pixels of stderr/(mean + 0.01), after the last whole pass; NaN before there are two replicates.
    pub relative_error: f64,
}

/// A sample that was not a finite, non-negative number; it counts as 0 in the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BadSample {
    /// Column and row.
    pub pixel: [u32; 2],
    /// Sample index, for `--replay`.
    pub index: u64,
    /// What came.
    pub rgb: [f32; 3],
}
