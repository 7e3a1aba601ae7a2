//! KHR_materials_iridescence: where the film lies, and how thick it is.

use super::param::{self, Point};
use crate::bsdf::{FilmedDielectric, FilmedEnergy, Fresnel, Ggx, Lobe, Micro, RoughFilmedDielectric, ThinFilm};
use crate::desc::{self, ScalarParam};
use crate::spectrum::Spectrum;
use std::sync::Arc;

/// A film at a point, and the share of the surface that it covers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Covering {
    film: ThinFilm,
    share: f32,
}

impl Covering {
    /// The film over a point; `None` where there is none.
    #[inline]
    pub(super) fn at(iridescence: Option<&desc::Iridescence>, at: Point) -> Option<Self> {
        let film = iridescence?;
        let share = param::scalar(&film.factor, at);
        let [least, most] = film.thickness;
        let place = ScalarParam { factor: 1.0, texture: film.thickness_texture };
        let thickness = least + (most - least) * param::scalar(&place, at);
        (share > 0.0).then_some(Self { film: ThinFilm { eta: film.ior, thickness }, share })
    }

    /// Whether the film is constant over the surface.
    pub(super) fn is_constant(iridescence: &desc::Iridescence) -> bool {
        iridescence.factor.texture.is_none() && iridescence.thickness_texture.is_none()
    }

    /// `weight` times the reflectance of a base that alone reflects `f0` at normal incidence.
    #[inline]
    pub(super) fn over(&self, f0: Spectrum, weight: f32) -> Fresnel {
        Fresnel::under_film(self.film, self.share, f0, weight)
    }

    /// The interface of a volume of index `eta` ≥ 1; `energy` is that of its film where it is rough.
    #[inline]
    pub(super) fn interface(&self, eta: f32, tint: Spectrum, rough: Option<(Micro, &Arc<FilmedEnergy>)>) -> Lobe {
        let facet = FilmedDielectric { eta, tint, film: self.film, share: self.share };
        match rough {
            None => Lobe::FilmedDielectric(facet),
            Some((micro, energy)) => {
                let Ggx { ax, ay } = micro.surface();
                Lobe::RoughFilmedDielectric(Box::new(RoughFilmedDielectric::new([ax, ay], facet, energy)))
            }
        }
    }
}

/// Energies of the interface of a volume of index `eta` under this film, for α within these bounds.
pub(super) fn filmed_energy(iridescence: &desc::Iridescence, eta: f32, alpha: [f32; 2]) -> FilmedEnergy {
    let [a, b] = iridescence.thickness;
    let thickness = if iridescence.thickness_texture.is_some() { [a.min(b), a.max(b)] } else { [b; 2] };
    FilmedEnergy::new(eta, alpha, iridescence.ior, thickness)
}
