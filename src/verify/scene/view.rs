//! Small images of a scene, as many samples as a budget of rays allows.

use crate::desc::{self, Filter, Integrator, SamplerKind, Strategy};
use crate::render::{self, Output, Settings};
use crate::scene::Scene;
use crate::verify::Trial;
use crate::verify::measure::REPLICATES;
use std::sync::atomic::AtomicBool;

/// Pixels of a scene's image, about.
const PIXELS: f64 = 3072.0;

/// Side of the tiles that pixels are pooled in.
pub(super) const TILE: u32 = 8;

/// What an image may cost.
#[derive(Clone, Copy, Debug)]
pub(in crate::verify) struct Budget {
    /// Most rays, about.
    pub rays: u64,
    /// Most pixels, about.
    pub pixels: f64,
    /// Seed of the sampler.
    pub seed: u64,
}

impl Budget {
    /// That of a scene file's image.
    pub(super) fn of(trial: &Trial, rays: [u64; 2]) -> Self {
        Self { rays: trial.work(rays[0], rays[1]), pixels: PIXELS, seed: trial.seed }
    }
}

/// What is looked at, and for how many rays.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    /// Number of the camera.
    pub camera: usize,
    /// What it may cost.
    pub budget: Budget,
    /// How directions are drawn.
    pub strategy: Strategy,
}

impl View {
    /// Settings that spend about the budget in [`REPLICATES`] replicates: a pilot of one sample a pixel counts the rays
    /// of a path; where even one sample a replicate is too much, the image is smaller. Not time but rays, so that the same
    /// seed gives the same numbers on every machine.
    pub(super) fn settings(&self, scene: &Scene) -> Result<Settings, render::Error> {
        let aspect = scene.cameras.get(self.camera).map_or(1.0, aspect);
        let most = self.budget.pixels;
        let pilot = self.with(size(aspect, most / 16.0), 1, 1);
        let output = render::render(scene, &pilot, &AtomicBool::new(false), &|_| {})?;
        let pixels = f64::from(pilot.size[0] * pilot.size[1]);
        let rays_per_replicate = REPLICATES as f64 * output.rays.max(1) as f64 / pixels;
        let affordable = self.budget.rays as f64 / rays_per_replicate;
        let size = size(aspect, affordable.clamp(most / 16.0, most));
        let samples = (affordable / f64::from(size[0] * size[1])).clamp(1.0, 64.0);
        let replicate = 1 << samples.log2() as u32;
        Ok(self.with(size, replicate, REPLICATES as u32 * replicate))
    }

    fn with(&self, size: [u32; 2], replicate: u32, spp: u32) -> Settings {
        Settings {
            size,
            crop: [0, 0, size[0], size[1]],
            camera: self.camera,
            spp,
            time: None,
            replicate,
            integrator: Integrator::Path,
            strategy: self.strategy,
            sampler: SamplerKind::Lattice,
            // JSON headers and command lines carry 53 bits.
            seed: self.budget.seed >> 11,
            max_depth: None,
            filter: Filter::Box,
            transport: false,
            threads: 0,
            tile: TILE,
        }
    }

    /// The image of these settings.
    pub(super) fn render(scene: &Scene, settings: &Settings) -> Result<Output, render::Error> {
        render::render(scene, settings, &AtomicBool::new(false), &|_| {})
    }
}

/// Width over height that a camera asks for.
fn aspect(camera: &desc::Camera) -> f64 {
    let asked = camera.resolution.map(|[w, h]| f64::from(w) / f64::from(h)).or(camera.aspect.map(f64::from));
    let natural = match camera.projection {
        desc::Projection::Equirectangular => 2.0,
        _ => 4.0 / 3.0,
    };
    asked.filter(|a| a.is_finite() && *a > 0.0).unwrap_or(natural).clamp(0.125, 8.0)
}

/// Whole tiles of about so many pixels.
fn size(aspect: f64, pixels: f64) -> [u32; 2] {
    let tiles = |length: f64| ((length / f64::from(TILE)).round() as u32).max(1) * TILE;
    [tiles((pixels * aspect).sqrt()), tiles((pixels / aspect).sqrt())]
}

/// Number and name of a camera for messages.
pub(super) fn camera_name(scene: &Scene, camera: usize) -> String {
    match scene.cameras.get(camera).map(|c| &*c.name) {
        Some(name) if !name.is_empty() => format!("camera {camera} `{name}`"),
        _ => format!("camera {camera}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_are_whole_tiles() {
        assert_eq!(size(4.0 / 3.0, PIXELS), [64, 48]);
        assert_eq!(size(8.0, 1.0), [8, 8]);
    }
}
