//! pbrt-v4's scene format.
//!
//! Conventions there: cameras look along +z with +x to the right, so that their space is left-handed; `fov` spans the shorter
//! side; textures count v upwards, and so do the meshes written for it; an environment is a square of equal areas; all
//! surfaces have two sides; `maxdepth` is the number of reflections; roughness is α where `remaproughness` is false. Colours
//! become spectra: pictures agree with ours as far as RGB is one.

mod camera;
mod light;
mod material;
mod shape;
mod words;

use super::beside::Beside;
use super::{ExportError, View, reflections};
use crate::desc::Integrator;
use words::Words;

/// A number of reflections that no path reaches.
const ENDLESS: u32 = 1_000_000;

/// The scene file's text; meshes and images are written on the way. `output` is the image that pbrt shall write.
pub(super) fn text(view: &View, output: &str, beside: &mut Beside) -> Result<String, ExportError> {
    beside.note("pbrt makes spectra of colours; saturated ones differ a little");
    if view.integrator == Integrator::Whitted {
        beside.note("the integrator `whitted` has no counterpart: all paths are followed");
    }
    let placed = beside.placed()?;
    let mut body = Words::default();
    camera::write(view, output, beside, &mut body)?;
    let depth = reflections(view).unwrap_or(ENDLESS);
    body.line("Integrator \"volpath\"").integer("maxdepth", depth);

    body.line("WorldBegin");
    let materials = material::write(&placed, beside, &mut body)?;
    light::write(beside, &mut body)?;
    shape::write(&placed, &materials, beside, &mut body)?;

    let mut text = format!("# {}, written by radianza {}\n", one_line(&beside.scene.name), env!("CARGO_PKG_VERSION"));
    beside.notes().iter().for_each(|note| text.push_str(&format!("# note: {}\n", one_line(note))));
    text.push_str(&body.text());
    Ok(text)
}

/// A comment ends with its line.
fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
