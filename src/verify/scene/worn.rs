//! A compiled material at one place, as a scattering function under test.

use super::places::Place;
use crate::bsdf::{Bsdf, MIN_ALPHA};
use crate::desc::parameter::{Parameter, Role, Value};
use crate::desc::{self, Model};
use crate::material::Material;
use crate::material::param::{self, Point};
use crate::shape::Surface;
use crate::texture::Textures;
use glam::Vec3A;

/// A material where it is looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Worn<'a> {
    pub material: &'a Material,
    pub textures: &'a Textures,
    pub place: &'a Place,
}

impl Worn<'_> {
    /// Its lobes.
    pub(super) fn lobes(&self) -> Bsdf {
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
        self.material.lobes(&surface, self.textures, None, &mut Bsdf::new()).clone()
    }
}

/// Numbers of a material at a place in words: widths, and what is not as by default: `metalness 1.00, roughness 0.80`;
/// empty for models without.
pub(super) fn parameters(material: &desc::Material, textures: &Textures, place: &Place) -> String {
    let mut words = Vec::new();
    numbers(&material.model, textures, place, &mut |parameter, x| {
        if matches!(parameter.role, Role::Width(_)) || x != parameter.default {
            words.push(format!("{} {x:.2}", parameter.name));
        }
    });
    words.join(", ")
}

/// The least α of a model's rough lobes at a place; smooth ones do not count: they are drawn for themselves.
pub(super) fn least_alpha(model: &Model, textures: &Textures, place: &Place) -> Option<f64> {
    let mut least: Option<f32> = None;
    numbers(model, textures, place, &mut |parameter, x| {
        if let Role::Width(width) = parameter.role {
            let alpha = Some(width.alpha(x)).filter(|alpha| *alpha >= MIN_ALPHA);
            least = least.into_iter().chain(alpha).min_by(f32::total_cmp);
        }
    });
    least.map(f64::from)
}

/// Visits the parameters of a model that are one number, with their values at a place.
fn numbers(model: &Model, textures: &Textures, place: &Place, visitor: &mut dyn FnMut(&Parameter, f32)) {
    let at = Point { uv: &place.uv, color: place.color, textures, eta: None };
    model.clone().visit(&mut |parameter| {
        let x = match &parameter.value {
            Value::Scalar(scalar) => param::scalar(scalar, at),
            Value::Number(x) => **x,
            _ => return,
        };
        visitor(&parameter, x);
    });
}
