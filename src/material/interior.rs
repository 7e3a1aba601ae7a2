//! What a material's closed surfaces enclose.

use crate::desc::{self, Dispersion};
use crate::medium::{Cauchy, Interior, Medium};
use crate::spectrum::Spectrum;
use glam::Vec4;

/// The inside of a material that refracts; `None` for surfaces that enclose nothing: opaque, metal, thin sheets. Of a
/// mixture that of its first part that has one.
pub fn interior(material: &desc::Material) -> Option<Interior> {
    let index = material.model.interior_index()?;
    let desc::Interior { absorption, priority, dispersion } = material.interior;
    let index = match dispersion {
        Dispersion::None => Vec4::splat(index),
        Dispersion::InverseAbbe(inverse) => Cauchy::of_abbe(index.into(), inverse.into()).lanes(),
        Dispersion::Cauchy([a, b]) => Cauchy { a: a.into(), b: f64::from(b) * 1e6 }.lanes(),
    };
    Some(Interior { index, medium: Medium { absorption: Spectrum::from_rgb(absorption) }, priority })
}
