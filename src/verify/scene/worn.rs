//! A compiled material at one place, as a scattering function under test.

use super::places::Place;
use crate::bsdf::{Bsdf, MIN_ALPHA};
use crate::desc::{self, Model, Roughness};
use crate::material::Material;
use crate::material::param::{self, Point};
use crate::shape::Surface;
use crate::texture::Textures;
use crate::verify::scattering::{Draw, Rgb, Scattering};
use glam::{DVec3, Vec3A};

/// A material where it is looked at. Which lobe is drawn how often depends on `wo`, so that every question makes the
/// lobes anew; [`towards`](Self::towards) keeps them for one `wo`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Worn<'a> {
    pub material: &'a Material,
    pub textures: &'a Textures,
    pub place: &'a Place,
}

impl Worn<'_> {
    /// Its lobes for light along `wo`.
    pub(super) fn towards(&self, wo: DVec3) -> Bsdf {
        let surface = Surface {
            p: Vec3A::ZERO,
            p_error: Vec3A::ZERO,
            ng: Vec3A::Z,
            ns: Vec3A::Z,
            tangent: Vec3A::X,
            handedness: 1.0,
            uv: self.place.uv,
            color: self.place.color,
        };
        let mut scratch = Bsdf::new();
        self.material.bsdf(&surface, wo.as_vec3(), self.textures, &mut scratch).clone()
    }
}

impl Scattering for Worn<'_> {
    fn sample(&self, wo: DVec3, u: [f32; 3]) -> Option<Draw> {
        Scattering::sample(&self.towards(wo), wo, u)
    }

    fn eval(&self, wo: DVec3, wi: DVec3) -> Rgb {
        Scattering::eval(&self.towards(wo), wo, wi)
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        Scattering::pdf(&self.towards(wo), wo, wi)
    }
}

/// Parameters at a place in words: `roughness 0.80, metal 1.00`; empty for models without.
pub(super) fn parameters(material: &desc::Material, textures: &Textures, place: &Place) -> String {
    let at = Point { uv: &place.uv, color: place.color, textures, eta: None };
    let rough = |r: &Roughness| match r {
        Roughness::Perceptual(p) => format!("roughness {:.2}", param::scalar(p, at)),
        Roughness::Glossiness(p) => format!("glossiness {:.2}", param::scalar(p, at)),
        Roughness::Alpha([a, b]) if a == b => format!("α {a}"),
        Roughness::Alpha([a, b]) => format!("α {a} × {b}"),
        Roughness::Stretched { roughness, strength } => {
            format!("roughness {:.2}, anisotropy {:.2}", param::scalar(roughness, at), param::scalar(strength, at))
        }
    };
    fn of(model: &Model, rough: &dyn Fn(&Roughness) -> String, at: Point) -> String {
        match model {
            Model::Conductor { roughness, .. }
            | Model::CookTorrance { roughness, .. }
            | Model::Dielectric { roughness, .. } => rough(roughness),
            Model::RoughDiffuse { roughness, .. } => rough(&Roughness::Perceptual(*roughness)),
            Model::SpecularGlossiness(m) => rough(&Roughness::Glossiness(m.glossiness)),
            Model::Phong { exponent, .. } => format!("exponent {exponent}"),
            Model::MetallicRoughness(m) => {
                let r = rough(&Roughness::Perceptual(m.roughness));
                format!("{r}, metal {:.2}", param::scalar(&m.metallic, at))
            }
            Model::Mix(parts) => {
                let all = parts.iter().map(|(_, part)| of(part, rough, at)).filter(|text| !text.is_empty());
                all.collect::<Vec<_>>().join(" and ")
            }
            Model::Absorb | Model::Diffuse { .. } | Model::Mirror { .. } => String::new(),
        }
    }
    of(&material.model, &rough, at)
}

/// The least α of a model's rough lobes at a place; smooth ones do not count: they are drawn for themselves.
pub(super) fn least_alpha(model: &Model, textures: &Textures, place: &Place) -> Option<f64> {
    let at = Point { uv: &place.uv, color: place.color, textures, eta: None };
    let rough = |r: &Roughness| {
        let alpha = match r {
            Roughness::Perceptual(p) => param::scalar(p, at).powi(2),
            Roughness::Glossiness(p) => (1.0 - param::scalar(p, at)).powi(2),
            Roughness::Alpha([a, b]) => a.min(*b),
            Roughness::Stretched { roughness, .. } => param::scalar(roughness, at).powi(2),
        };
        (alpha >= MIN_ALPHA).then_some(f64::from(alpha))
    };
    match model {
        Model::Conductor { roughness, .. }
        | Model::CookTorrance { roughness, .. }
        | Model::Dielectric { roughness, .. } => rough(roughness),
        Model::SpecularGlossiness(m) => rough(&Roughness::Glossiness(m.glossiness)),
        // As wide as a microsurface of α² = 2/(n + 2).
        Model::Phong { exponent, .. } => Some((2.0 / (f64::from(*exponent) + 2.0)).sqrt()),
        Model::MetallicRoughness(m) => {
            let coat = m.layers.clearcoat.and_then(|coat| rough(&Roughness::Perceptual(coat.roughness)));
            rough(&Roughness::Perceptual(m.roughness)).into_iter().chain(coat).min_by(f64::total_cmp)
        }
        Model::Mix(parts) => {
            parts.iter().filter_map(|(_, part)| least_alpha(part, textures, place)).min_by(f64::total_cmp)
        }
        Model::Absorb | Model::Diffuse { .. } | Model::RoughDiffuse { .. } | Model::Mirror { .. } => None,
    }
}

/// Light that enters is bent, so that the two sides differ and there must be a way out.
pub(super) fn refracts(model: &Model) -> bool {
    match model {
        Model::Dielectric { .. } => true,
        Model::MetallicRoughness(m) => m.transmission.as_ref().is_some_and(|t| !t.thin && t.factor.factor > 0.0),
        Model::Mix(parts) => parts.iter().any(|(weight, part)| *weight > 0.0 && refracts(part)),
        _ => false,
    }
}
