//! `--at`, `--frame`, `--variant`: one of the pictures that a scene holds.

use super::args;
use radianza::desc::Options;

/// Arguments of all commands that read a scene.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct Pick {
    /// Seconds into the animations of glTF files, all of which play together [the pose that the nodes state]
    #[arg(long, value_name = "SECONDS", value_parser = args::finite, allow_negative_numbers = true)]
    at: Option<f64>,
    /// Frame of the animations of glTF files: N/FPS seconds into them
    #[arg(long, value_name = "N", conflicts_with = "at", value_parser = args::finite, allow_negative_numbers = true)]
    frame: Option<f64>,
    /// Frames in a second
    #[arg(long, value_name = "FPS", default_value_t = 24.0, value_parser = rate)]
    fps: f64,
    /// Variant of glTF files (KHR_materials_variants) by its name; info lists them [the materials that meshes state]
    #[arg(long, value_name = "NAME")]
    variant: Option<String>,
}

impl Pick {
    /// For the loader.
    pub(crate) fn options(&self) -> Options {
        Options { at: self.at.or(self.frame.map(|n| n / self.fps)), variant: self.variant.clone() }
    }

    /// What was picked, as it is written on the command line; `quoted` makes one word of a name.
    pub(crate) fn command(&self, quoted: impl Fn(&str) -> String) -> String {
        let Options { at, variant } = self.options();
        let at = at.map(|t| format!(" --at {t}"));
        let variant = variant.map(|name| format!(" --variant {}", quoted(&name)));
        [at, variant].into_iter().flatten().collect()
    }
}

/// Frames in a second.
fn rate(text: &str) -> Result<f64, String> {
    args::finite(text).ok().filter(|x| *x > 0.0).ok_or_else(|| format!("`{text}` is no positive number of frames"))
}
