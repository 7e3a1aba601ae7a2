//! What a material's closed surfaces enclose.

use crate::desc::{self, Dispersion, Model};
use crate::medium::{Cauchy, Interior, Medium};
use crate::spectrum::Spectrum;
use glam::Vec4;

/// The inside of a material that refracts; `None` for surfaces that enclose nothing: opaque, metal, thin sheets. Of a
/// mixture that of its first part that has one.
pub fn interior(material: &desc::Material) -> Option<Interior> {
    let index = index(&material.model)?;
    let desc::Interior { absorption, priority, dispersion } = material.interior;
    let index = match dispersion {
        Dispersion::None => Vec4::splat(index),
        Dispersion::InverseAbbe(inverse) => Cauchy::of_abbe(index.into(), inverse.into()).lanes(),
        Dispersion::Cauchy([a, b]) => Cauchy { a: a.into(), b: f64::from(b) * 1e6 }.lanes(),
    };
    Some(Interior { index, medium: Medium { absorption: Spectrum::from_rgb(absorption) }, priority })
}

/// Index of refraction behind the surface.
fn index(model: &Model) -> Option<f32> {
    let valid = |n: f32| (n > 0.0 && n.is_finite()).then_some(n);
    match model {
        Model::Dielectric { ior, .. } => valid(*ior),
        Model::MetallicRoughness(m) => valid(m.ior).filter(|_| m.encloses()),
        Model::Mix(parts) => parts.iter().filter(|(weight, _)| *weight > 0.0).find_map(|(_, part)| index(part)),
        Model::Diffuse { .. }
        | Model::RoughDiffuse { .. }
        | Model::Phong { .. }
        | Model::Mirror { .. }
        | Model::Conductor { .. }
        | Model::CookTorrance { .. }
        | Model::SpecularGlossiness(_)
        | Model::Absorb => None,
    }
}
