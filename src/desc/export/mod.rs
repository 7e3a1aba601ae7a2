//! Scenes written for other renderers, so that the same scene can be rendered by them: Mitsuba 3 (XML) and pbrt-v4; and in
//! our own format.
//!
//! Plain data goes in, files come out: the scene file, and beside it a folder of meshes (PLY) and images (PNG where that
//! loses nothing, else OpenEXR). What the target cannot say is approximated or left out, and a note names it; the notes
//! also stand as comments at the top of the file. Equal scenes give equal files.
//!
//! | file | what |
//! | --- | --- |
//! | `beside.rs` | the folder beside the scene file, each file written once |
//! | `mesh.rs`, `tessellate.rs` | meshes as PLY; quadrics as meshes where the target's own will not do |
//! | `form.rs` | an object as the shape that both targets know |
//! | `picture.rs` | images with factors and channels worked in |
//! | `octahedral.rs` | environments on a square of equal areas |
//! | `value.rs` | parameters: constants, images, checkers |
//! | `emission.rs` | radiance of what has holes |
//! | `micro.rs` | roughness as α |
//! | `sun.rs` | the sun as a far disk |
//! | `fit.rs` | indices of refraction with a given reflectance |
//! | `own.rs` | our own format, by [`toml::write`](super::toml::write) |
//! | `mitsuba/` | the elements of Mitsuba's XML |
//! | `pbrt/` | the directives of pbrt |

mod beside;
mod emission;
mod fit;
mod form;
mod mesh;
mod micro;
mod mitsuba;
mod octahedral;
mod own;
mod pbrt;
mod picture;
mod sun;
mod tessellate;
mod value;

pub use own::write_toml;

use super::{Camera, Error, Filter, Integrator, Scene};
use crate::film::file::{check_writable, write_atomic};
use beside::Beside;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The renderer that a scene is written for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Mitsuba 3, XML of version 3.0.0.
    Mitsuba,
    /// pbrt-v4.
    Pbrt,
}

impl Target {
    /// The target of a file name: `.xml` is Mitsuba's, `.pbrt` pbrt's; `None` for other endings.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "xml" => Some(Self::Mitsuba),
            "pbrt" => Some(Self::Pbrt),
            _ => None,
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mitsuba => "Mitsuba",
            Self::Pbrt => "pbrt",
        }
    }
}

/// What is rendered of the scene, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Index of the camera.
    pub camera: usize,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel.
    pub spp: u32,
    /// Most reflections and refractions of a path.
    pub max_depth: Option<u32>,
    /// Which part of the rendering equation.
    pub integrator: Integrator,
    /// Pixel filter.
    pub filter: Filter,
}

/// Why a scene could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The scene cannot be said in the target's words.
    #[error("{0}")]
    Scene(#[from] Error),
    /// A file cannot be written.
    #[error("{} cannot be written: {}", .0.display(), .1)]
    Output(PathBuf, io::Error),
}

/// What was written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Written {
    /// Files beside the scene file.
    pub files: usize,
    /// What the target has otherwise, a sentence each.
    pub notes: Vec<String>,
}

/// Writes `scene` as `view` has it to the file `path` and the folder `NAME-mitsuba` or `NAME-pbrt` beside it. The scene file
/// comes last, so that it never names what is not there.
pub fn export(scene: &Scene, view: &View, target: Target, path: &Path) -> Result<Written, ExportError> {
    let failed = |e: io::Error| ExportError::Output(path.into(), e);
    check_writable(path).map_err(failed)?;
    let mut beside = Beside::new(scene, path, target);
    let text = match target {
        Target::Mitsuba => mitsuba::text(view, &mut beside)?,
        Target::Pbrt => {
            let image = path.with_extension("exr");
            pbrt::text(view, &image.file_name().unwrap_or_default().to_string_lossy(), &mut beside)?
        }
    };
    write_atomic(path, |file| file.write_all(text.as_bytes())).map_err(failed)?;
    Ok(beside.written())
}

/// Most reflections that an integrator follows.
fn reflections(view: &View) -> Option<u32> {
    let own = match view.integrator {
        Integrator::Raycast => Some(0),
        Integrator::Local => Some(1),
        Integrator::Whitted | Integrator::Path => None,
    };
    own.into_iter().chain(view.max_depth).min()
}

/// The camera of a view.
fn camera<'a>(scene: &'a Scene, view: &View) -> &'a Camera {
    &scene.cameras[view.camera]
}
