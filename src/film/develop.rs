//! Film → image: sums become means and errors, layer by layer.

use super::{CLASSES, Film, Image};

/// What an image can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, clap::ValueEnum)]
pub enum LayerKind {
    /// Radiance `R G B` [W·sr⁻¹·m⁻²] and coverage `A`.
    Beauty,
    /// Standard error of the radiance's mean: `stderr.R …`, and `stderr.SD.R …` of transport classes.
    Stderr,
    /// Mean reflectance of the first surface: `albedo.R …`.
    Albedo,
    /// Mean shading normal of the first surface in world space: `normal.X …`.
    Normal,
    /// Mean distance to the first surface in metres, 0 where there is none: `depth.Z`.
    Depth,
    /// Samples taken: `samples.N`.
    Samples,
    /// Radiance by the last two reflections before the eye: `emission.R`, `D.R`, `S.R`, `DD.R`, `SD.R`, `DS.R`, `SS.R` …
    Transport,
}

impl LayerKind {
    /// What is written unless asked otherwise: all but the transport classes.
    pub const DEFAULT: [Self; 6] = [Self::Beauty, Self::Stderr, Self::Albedo, Self::Normal, Self::Depth, Self::Samples];
}

/// The layers `kinds` of a film. Where a pixel has fewer than two replicates no error is known, and the error layers are
/// left out rather than filled with something; transport classes are there if the film has them.
pub fn develop(film: &Film, kinds: &[LayerKind]) -> Image {
    let mut image = Image { size: film.size(), window: film.crop(), ..Image::default() };
    let errors = kinds.contains(&LayerKind::Stderr) && film.pixels().all(|[x, y]| film.replicates(x, y) >= 2);
    let f32s = |rgb: [f64; 3]| rgb.map(|x| x as f32);
    for kind in kinds {
        match kind {
            LayerKind::Beauty => {
                image.insert_rgb(Image::BEAUTY, film.pixels().map(|[x, y]| f32s(film.mean(x, y))));
                image.insert(Image::BEAUTY, ["A"], film.pixels().map(|[x, y]| [film.alpha(x, y) as f32]));
            }
            LayerKind::Stderr if errors => {
                let stderr = |[x, y]: [u32; 2]| f32s(film.stderr(x, y).unwrap_or_default());
                image.insert_rgb("stderr", film.pixels().map(stderr));
            }
            LayerKind::Stderr => {}
            LayerKind::Albedo => image.insert_rgb("albedo", film.pixels().map(|[x, y]| f32s(film.albedo(x, y)))),
            LayerKind::Normal => {
                image.insert("normal", ["X", "Y", "Z"], film.pixels().map(|[x, y]| f32s(film.normal(x, y))));
            }
            LayerKind::Depth => image.insert("depth", ["Z"], film.pixels().map(|[x, y]| [film.depth(x, y) as f32])),
            LayerKind::Samples => {
                image.insert("samples", ["N"], film.pixels().map(|[x, y]| [film.samples(x, y) as f32]));
            }
            LayerKind::Transport if film.has_transport() => {
                for (class, name) in CLASSES.iter().enumerate() {
                    let mean = |[x, y]: [u32; 2]| f32s(film.class_mean(class, x, y).unwrap_or_default());
                    image.insert_rgb(name, film.pixels().map(mean));
                    let stderr = |[x, y]: [u32; 2]| f32s(film.class_stderr(class, x, y).unwrap_or_default());
                    if errors {
                        image.insert_rgb(&format!("stderr.{name}"), film.pixels().map(stderr));
                    }
                }
            }
            LayerKind::Transport => {}
        }
    }
    image
}
