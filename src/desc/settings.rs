//! Render settings that a file may suggest and the command line may override.

use serde::{Deserialize, Serialize};

/// Which part of the rendering equation is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Integrator {
    /// No scattering (ρ = 0): L = Le at the first surface.
    Raycast,
    /// Emitted and direct light, no recursion.
    Local,
    /// Recursion through perfect reflection and refraction, the rest local (Whitted 1980).
    Whitted,
    /// Everything.
    #[default]
    Path,
}

/// How the hemisphere of the rendering equation is sampled. All are unbiased; they differ in error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Strategy {
    /// Directions uniform over the (hemi)sphere.
    Uniform,
    /// Directions with density |cos θ|/π.
    Cosine,
    /// Directions from the BSDF.
    Bsdf,
    /// Direct light by sampling lights only; directions for the recursion from the BSDF.
    Light,
    /// Lights and BSDF combined by multiple importance sampling (power heuristic).
    #[default]
    Mis,
}

/// Where the numbers come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum SamplerKind {
    /// Independent pseudo-random numbers (PCG).
    Independent,
    /// Owen-scrambled Sobol points in independent replicates (Burley 2020).
    Sobol,
    /// Rank-1 lattices, shifted and jittered, in independent replicates (Cranley & Patterson 1976).
    #[default]
    Lattice,
}

/// Pixel reconstruction filter, applied by importance sampling: a sample touches one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Filter {
    /// The pixel's own square.
    Box,
    /// Gaussian, σ = 0.5 px, cut at 1.5 px.
    Gaussian,
    /// Blackman–Harris window, radius 1.5 px.
    #[default]
    BlackmanHarris,
}

/// Radiance → display value in the PNG.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Tonemap {
    /// Clipped at 1.
    Linear,
    /// The pixel value follows the logarithm of radiance.
    Log,
    /// x (1 + x/w²)/(1 + x) on luminance (Reinhard et al. 2002).
    Reinhard,
    /// AgX (Sobotka).
    #[default]
    Agx,
}

/// Suggestions of a scene file; `None` where it says nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RenderSettings {
    /// Samples per pixel.
    pub spp: Option<u32>,
    /// Which part of the rendering equation is solved.
    pub integrator: Option<Integrator>,
    /// How the hemisphere is sampled.
    pub strategy: Option<Strategy>,
    /// Where the numbers come from.
    pub sampler: Option<SamplerKind>,
    /// Seed of the sampler.
    pub seed: Option<u64>,
    /// Most reflections and refractions of a path; none by default. A limit makes the image darker: it is biased.
    pub max_depth: Option<u32>,
    /// Pixel filter.
    pub filter: Option<Filter>,
    /// Tone curve of the PNG.
    pub tonemap: Option<Tonemap>,
    /// Exposure of the PNG in stops.
    pub exposure: Option<f32>,
}
