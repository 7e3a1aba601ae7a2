//! The closed family of lobes: one arm each, to the files that know them.

use super::beckmann::Beckmann;
use super::diffuse_transmission;
use super::energy::{Energy, EnergyAt};
use super::eon::Eon;
use super::filmed_dielectric::{FilmedDielectric, RoughFilmedDielectric};
use super::lambert::{CoupledDiffuse, Lambert, sample_cosine};
use super::layer::Layer;
use super::phong::Phong;
use super::rough_dielectric::RoughDielectric;
use super::rough_reflection::{RoughReflection, RoughThin};
use super::sheen::Sheen;
use super::smooth::{Delta, Mirror, SmoothDielectric, ThinTransmission};
use super::{Class, Transport};
use crate::spectrum::Spectrum;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// One way of scattering, bound to no direction. What is large (a film, a metal's index) lies on the heap.
#[derive(Clone, Debug)]
pub enum Lobe {
    /// Lambert's.
    Lambert(Lambert),
    /// Rough diffuse.
    Eon(Eon),
    /// Diffuse base under a specular coat.
    CoupledDiffuse(CoupledDiffuse),
    /// What such a base lets through to the other side.
    DiffuseTransmission {
        /// The base, with the share that it transmits for its reflectance.
        base: CoupledDiffuse,
        /// Index of the inside (behind the normal) over the outside.
        eta: f32,
    },
    /// Perfectly smooth reflection.
    Mirror(Mirror),
    /// Perfectly smooth dielectric interface.
    SmoothDielectric(SmoothDielectric),
    /// Straight through a thin sheet.
    ThinTransmission(ThinTransmission),
    /// GGX reflection.
    RoughReflection(RoughReflection),
    /// Reflection of Beckmann's microfacets.
    CookTorrance(RoughReflection<Beckmann>),
    /// Phong's.
    Phong(Phong),
    /// GGX transmission through a thin sheet.
    RoughThin(RoughThin),
    /// GGX dielectric interface.
    RoughDielectric(RoughDielectric),
    /// Sheen of fibres.
    Sheen(Sheen),
    /// Perfectly smooth dielectric interface under a film.
    FilmedDielectric(FilmedDielectric),
    /// GGX dielectric interface under a film.
    RoughFilmedDielectric(Box<RoughFilmedDielectric>),
}

/// A lobe is copied at every hit whose material varies over the surface.
const _: () = assert!(size_of::<Lobe>() <= 96);

/// What a lobe looks up of one direction, once for all questions about it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aspect {
    /// Of a diffuse base, what the coat over it transmits.
    pub(super) through: Spectrum,
    /// Energy that single scattering loses; of sheen, the area σ of the facets that are seen.
    pub(super) loss: f32,
    /// Probability with which a draw takes the multiply scattered part.
    pub(super) multiple: f32,
    /// About the directional albedo: how often the lobe is chosen.
    pub(super) weight: f32,
}

impl Aspect {
    pub(super) const NONE: Self = Self { through: Spectrum::ZERO, loss: 0.0, multiple: 0.0, weight: 0.0 };

    #[inline]
    pub(super) fn of(albedo: Spectrum) -> Self {
        Self { weight: importance(albedo), ..Self::NONE }
    }
}

/// How often light of this colour is worth following.
#[inline]
pub(super) fn importance(albedo: Spectrum) -> f32 {
    albedo.luminance().max(0.25 * albedo.max_element())
}

impl Lobe {
    /// A Lambertian lobe of this albedo.
    #[inline]
    pub fn lambert(reflectance: Spectrum) -> Self {
        Self::Lambert(Lambert { reflectance })
    }

    /// Which letter of light path expressions it is.
    #[inline]
    pub fn class(&self) -> Class {
        match self {
            Self::Lambert(_) | Self::Eon(_) | Self::CoupledDiffuse(_) | Self::DiffuseTransmission { .. } => {
                Class::Diffuse
            }
            _ => Class::Specular,
        }
    }

    /// A delta distribution.
    #[inline]
    pub fn is_delta(&self) -> bool {
        matches!(
            self,
            Self::Mirror(_) | Self::SmoothDielectric(_) | Self::FilmedDielectric(_) | Self::ThinTransmission(_)
        )
    }

    /// Light crosses the surface, other than as a delta.
    #[inline]
    pub fn transmits(&self) -> bool {
        matches!(
            self,
            Self::DiffuseTransmission { .. }
                | Self::RoughThin(_)
                | Self::RoughDielectric(_)
                | Self::RoughFilmedDielectric(_)
        )
    }

    /// The energy of the mirroring microsurface that it shares with lobes beside it.
    #[inline]
    pub(super) fn energy(&self) -> Option<&EnergyAt> {
        match self {
            Self::RoughReflection(l) => Some(l.micro().energy()),
            Self::CookTorrance(l) => Some(l.micro().energy()),
            Self::RoughThin(l) => Some(l.micro().energy()),
            Self::CoupledDiffuse(base) | Self::DiffuseTransmission { base, .. } => base.energy(),
            _ => None,
        }
    }

    /// It scatters otherwise where it is turned about the normal.
    pub fn is_anisotropic(&self) -> bool {
        match self {
            Self::RoughDielectric(l) => l.is_anisotropic(),
            Self::RoughFilmedDielectric(l) => l.is_anisotropic(),
            _ => self.energy().is_some_and(EnergyAt::is_anisotropic),
        }
    }

    /// What is asked of the direction `w` again and again; `e` is [`Self::energy`] there.
    #[inline]
    pub(super) fn aspect(&self, w: Vec3, e: Energy) -> Aspect {
        match self {
            Self::Lambert(l) => Aspect::of(l.reflectance),
            Self::Eon(l) => Aspect::of(l.albedo(w)),
            Self::CoupledDiffuse(base) | Self::DiffuseTransmission { base, .. } => {
                let through = base.transmitted(w, e);
                Aspect { through, ..Aspect::of(base.estimate(through)) }
            }
            Self::Mirror(l) => Aspect::of(l.fresnel.estimate(w.z.abs().min(1.0))),
            Self::SmoothDielectric(l) => Aspect::of(l.albedo(w)),
            Self::ThinTransmission(l) => {
                Aspect::of(l.tint * (Spectrum::ONE - l.fresnel.estimate(w.z.abs().min(1.0))).max(Spectrum::ZERO))
            }
            Self::RoughReflection(l) => l.aspect(e),
            Self::CookTorrance(l) => l.aspect(e),
            Self::Phong(l) => Aspect::of(l.reflectance),
            Self::RoughThin(l) => l.aspect(e),
            Self::RoughDielectric(l) => l.aspect(w),
            Self::Sheen(l) => l.aspect(w),
            Self::FilmedDielectric(l) => Aspect::of(l.estimate(w)),
            Self::RoughFilmedDielectric(l) => l.aspect(w),
        }
    }

    /// f \[1/sr\], and the densities \[1/sr\] among the draws of this lobe of `wi`, and seen from there of `wo`; 0 for deltas.
    #[inline]
    pub(super) fn eval(&self, [wo, wi]: [Vec3; 2], [o, i]: [&Aspect; 2], mode: Transport) -> (Spectrum, f32, f32) {
        let same = wo.z * wi.z > 0.0;
        let cosines = (wi.z.abs() * FRAC_1_PI, wo.z.abs() * FRAC_1_PI);
        match self {
            Self::Lambert(l) if same => (l.reflectance * FRAC_1_PI, cosines.0, cosines.1),
            Self::Eon(l) if same => (l.f(wo, wi), cosines.0, cosines.1),
            Self::CoupledDiffuse(base) if same => (base.f(o.through, i.through), cosines.0, cosines.1),
            Self::DiffuseTransmission { base, eta } if wo.z * wi.z < 0.0 => {
                let f = base.f(o.through, i.through) * diffuse_transmission::passed(*eta, wo, mode);
                (f, cosines.0, cosines.1)
            }
            Self::RoughReflection(l) => l.eval([wo, wi], [o, i]),
            Self::CookTorrance(l) => l.eval([wo, wi], [o, i]),
            Self::Phong(l) => l.eval(wo, wi),
            Self::RoughThin(l) => l.eval([wo, wi], [o, i]),
            Self::RoughDielectric(l) => l.eval([wo, wi], [o, i], mode),
            Self::Sheen(l) => l.eval([wo, wi], [o, i]),
            Self::RoughFilmedDielectric(l) => l.eval([wo, wi], [o, i], mode),
            _ => (Spectrum::ZERO, 0.0, 0.0),
        }
    }

    /// Draws `wi` and says which η it crossed; not for deltas.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, aspect: &Aspect, uc: f32, u: [f32; 2]) -> Option<(Vec3, f32)> {
        match self {
            // What grooves scatter differs from a cosine by less than a factor of three.
            Self::Lambert(_) | Self::CoupledDiffuse(_) | Self::Eon(_) => Some((sample_cosine(wo, u), 1.0)),
            Self::DiffuseTransmission { eta, .. } => Some(diffuse_transmission::sample(*eta, wo, u)),
            Self::RoughReflection(l) => Some((l.sample(wo, aspect, uc, u)?, 1.0)),
            Self::CookTorrance(l) => Some((l.sample(wo, aspect, uc, u)?, 1.0)),
            Self::Phong(l) => Some((l.sample(wo, u)?, 1.0)),
            Self::RoughThin(l) => Some((l.sample(wo, aspect, uc, u)?, 1.0)),
            Self::RoughDielectric(l) => l.sample(wo, aspect, uc, u),
            Self::Sheen(l) => Some((l.sample(wo, uc, u)?, 1.0)),
            Self::RoughFilmedDielectric(l) => l.sample(wo, aspect, uc, u),
            Self::Mirror(_) | Self::SmoothDielectric(_) | Self::FilmedDielectric(_) | Self::ThinTransmission(_) => None,
        }
    }

    /// The directions of a delta lobe.
    #[inline]
    pub(super) fn deltas(&self, wo: Vec3, mode: Transport) -> [Option<Delta>; 2] {
        match self {
            Self::Mirror(l) => l.deltas(wo),
            Self::SmoothDielectric(l) => l.deltas(wo, mode),
            Self::FilmedDielectric(l) => l.deltas(wo, mode),
            Self::ThinTransmission(l) => l.deltas(wo),
            _ => [None, None],
        }
    }

    /// Directional albedo, reflection and transmission together: the share of the energy arriving along −`wo` that
    /// leaves again, before the layers `above` dim it.
    pub(super) fn albedo(&self, wo: Vec3, above: &[Layer]) -> Spectrum {
        match self {
            Self::Lambert(l) => l.reflectance,
            Self::Eon(l) => l.albedo(wo),
            Self::CoupledDiffuse(base) => base.albedo(wo, above),
            Self::DiffuseTransmission { base, eta } => {
                base.albedo(wo, above) * diffuse_transmission::passed(*eta, wo, Transport::Importance)
            }
            Self::Mirror(l) => l.fresnel.eval(wo.z.abs().min(1.0)),
            Self::SmoothDielectric(l) => l.albedo(wo),
            Self::ThinTransmission(l) => l.albedo(wo),
            Self::RoughReflection(l) => l.albedo(wo),
            Self::CookTorrance(l) => l.albedo(wo),
            Self::Phong(l) => l.albedo(wo),
            Self::RoughThin(l) => l.albedo(wo),
            Self::RoughDielectric(l) => l.albedo(wo),
            Self::Sheen(l) => l.albedo(wo),
            Self::FilmedDielectric(l) => l.albedo(wo),
            Self::RoughFilmedDielectric(l) => l.albedo(wo),
        }
    }
}
