//! Mitsuba 3's XML.
//!
//! Conventions there: cameras look along +z with +x to the left; normals of meshes come from the order of vertices and are
//! smooth unless `face_normals` says not; textures count v downwards, as here; an environment's left edge is its −z, its
//! middle here. Paths count vertices with the light's: `max_depth` is reflections + 1.

mod camera;
mod coated;
mod layered;
mod light;
mod material;
mod shape;
mod xml;

use super::beside::Beside;
use super::{ExportError, View, reflections};
use crate::desc::Integrator;
use crate::film;
use xml::{Element, document};

/// The scene file's text; meshes and images are written on the way.
pub(super) fn text(view: &View, beside: &mut Beside) -> Result<String, ExportError> {
    let placed = beside.placed()?;
    let mut scene = Element::new("scene").with("version", "3.0.0");

    // Materials come first; of each only that what is inside may absorb.
    let mut materials = Vec::new();
    for index in 0..beside.scene.materials.len() {
        if placed.iter().any(|p| p.object.material == index) {
            materials.push(material::element(index, &placed, beside)?);
        }
    }
    let media = material::media(beside);
    if !media.is_empty() {
        beside.note("cameras and lights inside of what absorbs start in vacuum, and nested interiors are not known");
    }
    scene = scene.child(integrator(view, !media.is_empty(), beside));
    scene = scene.child(camera::element(view, beside)?);
    for element in materials.into_iter().chain(media) {
        scene = scene.child(element);
    }
    for element in shape::elements(&placed, beside)?.into_iter().chain(light::elements(beside)?) {
        scene = scene.child(element);
    }

    let mut comments = vec![format!("{}, written by radianza {}", beside.scene.name, env!("CARGO_PKG_VERSION"))];
    comments.extend(beside.notes().iter().map(|note| format!("note: {note}")));
    document(&scene, &comments).map_err(|e| ExportError::Output("scene.xml".into(), e))
}

/// The path tracer, of whole or cut paths.
fn integrator(view: &View, absorbs: bool, beside: &mut Beside) -> Element {
    if view.integrator == Integrator::Whitted {
        beside.note("the integrator `whitted` has no counterpart: all paths are followed");
    }
    let depth = reflections(view).map_or(-1, |n| i64::from(n) + 1);
    Element::plugin("integrator", if absorbs { "volpath" } else { "path" }).integer("max_depth", depth)
}

/// Standard deviation of the Gaussian that is as wide as the Blackman–Harris window of radius 1.5 px: √(∫x²w/∫w) \[px\].
const HARRIS_SIGMA: f32 = 0.415_53;

/// The film's reconstruction filter.
fn filter(view: &View, beside: &mut Beside) -> Element {
    use crate::desc::Filter;
    let sigma = match view.filter {
        Filter::Box => return Element::plugin("rfilter", "box"),
        Filter::Gaussian => 0.5,
        Filter::BlackmanHarris => {
            beside.note("the Blackman-Harris pixel filter is a Gaussian of the same variance; box is the same in both");
            HARRIS_SIGMA
        }
    };
    debug_assert!(film::filter_radius(view.filter) > sigma);
    Element::plugin("rfilter", "gaussian").float("stddev", sigma)
}
