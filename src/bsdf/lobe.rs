//! The closed family of lobes: one arm each, to the files that know them.

use super::beckmann::Beckmann;
use super::diffuse_transmission::DiffuseTransmission;
use super::energy::Slice;
use super::eon::Eon;
use super::filmed_dielectric::{FilmedDielectric, RoughFilmedDielectric};
use super::lambert::{CoupledDiffuse, Lambert, sample_cosine};
use super::phong::Phong;
use super::rough_dielectric::RoughDielectric;
use super::rough_reflection::{RoughReflection, RoughThin};
use super::sheen::Sheen;
use super::smooth::{Delta, Mirror, SmoothDielectric, ThinTransmission};
use super::{Class, Transport};
use crate::spectrum::Spectrum;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// One way of scattering.
#[derive(Clone, Copy, Debug)]
pub enum Lobe {
    /// Lambert's.
    Lambert(Lambert),
    /// Rough diffuse.
    Eon(Eon),
    /// Diffuse base under a specular coat.
    CoupledDiffuse(CoupledDiffuse),
    /// Diffuse to the other side.
    DiffuseTransmission(DiffuseTransmission),
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
    RoughFilmedDielectric(RoughFilmedDielectric),
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
            Self::Lambert(_) | Self::Eon(_) | Self::CoupledDiffuse(_) | Self::DiffuseTransmission(_) => Class::Diffuse,
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
            Self::DiffuseTransmission(_)
                | Self::RoughThin(_)
                | Self::RoughDielectric(_)
                | Self::RoughFilmedDielectric(_)
        )
    }

    /// Looks up once what is asked for about `wo` again and again: at a hit. `known` is such a lobe, and becomes this one.
    #[inline]
    pub(super) fn look_from(&mut self, wo: Vec3, known: &mut Option<Slice>) {
        let slice = match self {
            Self::RoughReflection(l) => Some(l.energy_mut()),
            Self::CoupledDiffuse(l) => l.energy_mut(),
            _ => None,
        };
        if let Some(slice) = slice {
            slice.look_from(wo, known.as_ref());
            *known = Some(*slice);
        }
    }

    /// It scatters otherwise where it is turned about the normal.
    pub fn is_anisotropic(&self) -> bool {
        match self {
            Self::RoughReflection(l) => l.micro().energy().is_anisotropic(),
            Self::CookTorrance(l) => l.micro().energy().is_anisotropic(),
            Self::RoughThin(l) => l.is_anisotropic(),
            Self::CoupledDiffuse(l) => l.is_anisotropic(),
            Self::DiffuseTransmission(l) => l.base.is_anisotropic(),
            Self::RoughDielectric(l) => l.is_anisotropic(),
            Self::RoughFilmedDielectric(l) => l.ggx.ax != l.ggx.ay,
            Self::Lambert(_)
            | Self::Eon(_)
            | Self::Mirror(_)
            | Self::SmoothDielectric(_)
            | Self::ThinTransmission(_)
            | Self::Phong(_)
            | Self::Sheen(_)
            | Self::FilmedDielectric(_) => false,
        }
    }

    /// f \[1/sr\] and density \[1/sr\] of `wi` among the draws of this lobe; 0 for deltas.
    #[inline]
    pub(super) fn eval(&self, wo: Vec3, wi: Vec3, mode: Transport) -> (Spectrum, f32) {
        match self {
            Self::Lambert(l) if wo.z * wi.z > 0.0 => (l.reflectance * FRAC_1_PI, wi.z.abs() * FRAC_1_PI),
            Self::Eon(l) if wo.z * wi.z > 0.0 => (l.f(wo, wi), wi.z.abs() * FRAC_1_PI),
            Self::CoupledDiffuse(l) if wo.z * wi.z > 0.0 => (l.f(wo, wi), wi.z.abs() * FRAC_1_PI),
            Self::RoughReflection(l) => l.eval(wo, wi),
            Self::CookTorrance(l) => l.eval(wo, wi),
            Self::Phong(l) => l.eval(wo, wi),
            Self::RoughThin(l) => l.eval(wo, wi),
            Self::RoughDielectric(l) => l.eval(wo, wi, mode),
            Self::Sheen(l) => l.eval(wo, wi),
            Self::DiffuseTransmission(l) => l.eval(wo, wi, mode),
            Self::RoughFilmedDielectric(l) => l.eval(wo, wi, mode),
            _ => (Spectrum::ZERO, 0.0),
        }
    }

    /// Draws `wi` and says which η it crossed; not for deltas.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2]) -> Option<(Vec3, f32)> {
        match self {
            Self::Lambert(_) | Self::CoupledDiffuse(_) => Some((sample_cosine(wo, u), 1.0)),
            Self::DiffuseTransmission(l) => Some(l.sample(wo, u)),
            Self::Eon(l) => Some((l.sample(wo, u), 1.0)),
            Self::RoughReflection(l) => Some((l.sample(wo, uc, u)?, 1.0)),
            Self::CookTorrance(l) => Some((l.sample(wo, uc, u)?, 1.0)),
            Self::Phong(l) => Some((l.sample(wo, u)?, 1.0)),
            Self::RoughThin(l) => Some((l.sample(wo, uc, u)?, 1.0)),
            Self::RoughDielectric(l) => {
                let wi = l.sample(wo, uc, u)?;
                Some((wi, l.crossed(wo, wi)))
            }
            Self::Sheen(l) => Some((l.sample(wo, uc, u)?, 1.0)),
            Self::RoughFilmedDielectric(l) => l.sample(wo, uc, u),
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
    /// leaves again.
    pub fn albedo(&self, wo: Vec3) -> Spectrum {
        match self {
            Self::Lambert(l) => l.reflectance,
            Self::Eon(l) => l.albedo(wo),
            Self::CoupledDiffuse(l) => l.albedo(wo),
            Self::DiffuseTransmission(l) => l.albedo(wo),
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

    /// About the albedo, without what costs much: how often to choose it.
    pub(super) fn importance(&self, wo: Vec3) -> Spectrum {
        match self {
            Self::RoughReflection(l) => l.fitted_albedo(wo),
            Self::CookTorrance(l) => l.fitted_albedo(wo),
            Self::RoughThin(l) => l.fitted_albedo(wo),
            _ => self.albedo(wo),
        }
    }
}
