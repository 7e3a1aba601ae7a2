//! What is rendered, and how: the command line before the scene file before the defaults.

use super::Failure;
use super::render::Arguments;
use radianza::desc::{self, Camera, Integrator, Projection};
use radianza::film::{Display, GROUPS, Group, TRANSPORT};
use radianza::render::Settings;

/// Samples per pixel where nobody says anything.
pub(super) const SPP: u32 = 128;

/// Height where the camera gives no resolution; its width follows from the camera's aspect, else it is 16:9.
const HEIGHT: u32 = 720;

/// Most pixels of an image: their sums take 35 GB.
const MAX_PIXELS: u64 = 1 << 28;

/// Side of the tiles that threads work on.
const TILE: u32 = 16;

/// The outcome of all choices.
pub(super) struct Choices {
    /// For the renderer.
    pub(super) settings: Settings,
    /// For the EXR.
    pub(super) layers: Vec<&'static Group>,
    /// For the PNG.
    pub(super) display: Display,
    /// Why the image is no unbiased estimate of the whole equation.
    pub(super) biased: Vec<String>,
    /// What was changed on the way.
    pub(super) notes: Vec<String>,
}

/// Decides everything that a render needs.
pub(super) fn choose(arguments: &Arguments, scene: &desc::Scene) -> Result<Choices, Failure> {
    let file = &scene.render;
    let mut notes = Vec::new();
    let camera = camera(arguments.camera.as_deref(), &scene.cameras)?;
    let size = arguments.size.unwrap_or_else(|| resolution(&scene.cameras[camera]));
    let crop = window(arguments.crop, size)?;

    // With a time limit alone, samples are taken until it is over.
    let timed = arguments.time.is_some() && arguments.spp.is_none();
    let asked = if timed { u32::MAX / 2 } else { arguments.spp.or(file.spp).unwrap_or(SPP).max(1) };
    let replicate = arguments.replicate.unwrap_or(if timed { 4 } else { default_replicate(asked) });
    let spp = if timed { asked / replicate * replicate } else { round_up(asked, replicate)? };
    if !timed && spp != asked {
        notes.push(format!("{asked} samples per pixel become {spp}: whole replicates of {replicate}"));
    }

    let layers = arguments.layers.clone().unwrap_or_else(|| GROUPS.iter().filter(|group| group.always).collect());
    let integrator = arguments.integrator.or(file.integrator).unwrap_or_default();
    let max_depth = arguments.max_depth.or(file.max_depth);
    let settings = Settings {
        size,
        crop,
        camera,
        spp,
        time: arguments.time,
        replicate,
        integrator,
        strategy: arguments.strategy.or(file.strategy).unwrap_or_default(),
        sampler: arguments.sampler.or(file.sampler).unwrap_or_default(),
        seed: arguments.seed.or(file.seed).unwrap_or_default(),
        max_depth,
        filter: arguments.filter.or(file.filter).unwrap_or_default(),
        transport: layers.iter().any(|group| group.name == TRANSPORT),
        threads: arguments.threads,
        tile: TILE,
    };
    let exposure = arguments.exposure.map(|e| e as f32).or(file.exposure).unwrap_or_default();
    let display = Display::new(arguments.tonemap.or(file.tonemap).unwrap_or_default(), exposure);
    Ok(Choices { settings, layers, display, biased: biased(integrator, max_depth), notes })
}

/// By name, else by index; the first without.
pub(super) fn camera(wanted: Option<&str>, cameras: &[Camera]) -> Result<usize, Failure> {
    let wanted = wanted.unwrap_or("0");
    let named = cameras.iter().position(|c| c.name == wanted);
    let index = named.or_else(|| wanted.parse().ok().filter(|&i: &usize| i < cameras.len()));
    index.ok_or_else(|| {
        let list: Vec<String> = cameras.iter().enumerate().map(|(i, c)| format!("{i} `{}`", c.name)).collect();
        Failure::Usage(format!("no camera `{wanted}`; the scene has {}", list.join(", ")))
    })
}

pub(super) fn resolution(camera: &Camera) -> [u32; 2] {
    let panorama = camera.projection == Projection::Equirectangular;
    let aspect = camera.aspect.unwrap_or(if panorama { 2.0 } else { 16.0 / 9.0 });
    camera.resolution.unwrap_or([(HEIGHT as f32 * aspect).round().clamp(1.0, 65_536.0) as u32, HEIGHT])
}

fn window(crop: Option<[u32; 4]>, size: [u32; 2]) -> Result<[u32; 4], Failure> {
    let [w, h] = size;
    let window @ [x0, y0, x1, y1] = crop.unwrap_or([0, 0, w, h]);
    if x0 >= x1 || y0 >= y1 || x1 > w || y1 > h {
        return Err(Failure::Usage(format!("the window {window:?} does not lie in the image of {w}×{h} pixels")));
    }
    if u64::from(x1 - x0) * u64::from(y1 - y0) > MAX_PIXELS {
        let message = format!("{}×{} pixels are more than {MAX_PIXELS}; render parts with --crop", x1 - x0, y1 - y0);
        return Err(Failure::Usage(message));
    }
    Ok(window)
}

/// The largest power of two in spp/4, at most 64: at least four replicates where there are four samples.
fn default_replicate(spp: u32) -> u32 {
    1 << (spp / 4).clamp(1, 64).ilog2()
}

fn round_up(spp: u32, replicate: u32) -> Result<u32, Failure> {
    spp.checked_next_multiple_of(replicate)
        .ok_or_else(|| Failure::Usage(format!("{spp} samples per pixel are more than can be counted")))
}

fn biased(integrator: Integrator, max_depth: Option<u32>) -> Vec<String> {
    let method = match integrator {
        Integrator::Path => None,
        Integrator::Raycast => Some("raycast leaves out all reflected light"),
        Integrator::Local => Some("local leaves out light reflected more than once"),
        Integrator::Whitted => {
            Some("whitted leaves out indirect light of surfaces that are no perfect mirrors or glass")
        }
    };
    let depth = max_depth.map(|n| format!("max-depth {n} leaves out longer paths"));
    method.map(String::from).into_iter().chain(depth).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replicates() {
        for (spp, replicate) in
            [(1, 1), (3, 1), (4, 1), (8, 2), (16, 4), (100, 16), (128, 32), (256, 64), (u32::MAX, 64)]
        {
            assert_eq!(default_replicate(spp), replicate, "{spp}");
        }
        assert_eq!(round_up(100, 16).ok(), Some(112));
        assert!(round_up(u32::MAX, 64).is_err());
    }

    #[test]
    fn windows() {
        assert_eq!(window(None, [4, 3]).ok(), Some([0, 0, 4, 3]));
        for (crop, size) in [([0, 0, 5, 3], [4, 3]), ([2, 0, 2, 3], [4, 3])] {
            assert!(window(Some(crop), size).is_err());
        }
        assert!(window(None, [65_536, 65_536]).is_err() && window(None, [0, 3]).is_err());
    }
}
