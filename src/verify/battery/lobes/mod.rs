//! BSDFs and microsurfaces: rows A1 to A5, T5, T6, and the law of densities.

mod bent;
mod density;
mod energy;
mod film;
mod fresnel;
mod lambert;
mod microsurface;
mod radiance;
mod reciprocity;

use crate::bsdf::{Specimen, specimens};
use crate::verify::Task;

/// Every check of lobes.
pub(super) fn tasks() -> Vec<Task> {
    let rows: [fn() -> Vec<Task>; 9] = [
        lambert::tasks,
        microsurface::tasks,
        reciprocity::tasks,
        energy::tasks,
        density::tasks,
        fresnel::tasks,
        film::tasks,
        radiance::tasks,
        bent::tasks,
    ];
    rows.iter().flat_map(|row| row()).collect()
}

/// A task for each of these specimens.
fn each(of: fn(&Specimen) -> bool, make: impl Fn(Specimen) -> Task) -> Vec<Task> {
    specimens().into_iter().filter(of).map(make).collect()
}

/// Not a filter.
fn any(_: &Specimen) -> bool {
    true
}

/// Not all of it is deltas. By name: to look at the lobe would be to make its tables, for whoever asks for a list.
fn smooth(specimen: &Specimen) -> bool {
    let deltas = ["mirror", "smooth gold", "smooth dielectric", "thin sheet, smooth"];
    !deltas.iter().any(|name| specimen.name.starts_with(name))
}

/// The two sides of it differ.
fn refracts(specimen: &Specimen) -> bool {
    specimen.name.contains("dielectric")
}

/// Relative error in energy that is granted: its tables interpolate; and where indices nearly match, the refracted lobe
/// is so much narrower than the reflected one that quadrature loses a little of it. The atlas of both roughnesses, and the
/// tables of sheen, are coarser.
fn tables(specimen: &Specimen) -> f64 {
    match specimen.name.as_str() {
        name if name.contains("1.02") => 6e-4,
        name if name.contains("rough dielectric") => 3e-4,
        name if name.starts_with("turned") => 3e-3,
        name if name.contains("sheen") => 1e-3,
        // Series of twelve terms for two fringes.
        name if name.contains("film") => 1e-3,
        _ => 2e-4,
    }
}
