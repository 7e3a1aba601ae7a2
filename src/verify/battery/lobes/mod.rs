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

/// Not all of it is deltas.
fn smooth(specimen: &Specimen) -> bool {
    !specimen.deltas
}
