//! Mirror, dielectric, conductor, rough diffuse, Phong.

use super::param::{self, Point};
use super::roughness::{Microsurface, RoughInterface};
use crate::bsdf::{Eon, Fresnel, Lobe, Mirror, Phong, RoughReflection, SmoothDielectric};
use crate::desc::{self, ColorParam};
use crate::spectrum::Spectrum;

/// A mirror of this reflectance at every angle.
pub(super) fn mirror(reflectance: Spectrum) -> Lobe {
    Lobe::Mirror(Mirror { fresnel: Fresnel::Constant(reflectance) })
}

/// Diffuse, rough or not.
pub(super) fn diffuse(reflectance: Spectrum, roughness: f32) -> Lobe {
    if roughness > 0.0 { Lobe::Eon(Eon::new(reflectance, roughness)) } else { Lobe::lambert(reflectance) }
}

/// Phong's lobe.
pub(super) fn phong(reflectance: Spectrum, exponent: f32) -> Lobe {
    let exponent = if exponent > 0.0 { exponent.min(f32::MAX) } else { 0.0 };
    Lobe::Phong(Phong { reflectance, exponent })
}

/// Interface between dielectrics.
#[derive(Clone, Debug)]
pub(super) struct Dielectric {
    eta: f32,
    tint: ColorParam,
    rough: RoughInterface,
}

impl Dielectric {
    pub(super) fn new(eta: f32, roughness: desc::Roughness, tint: ColorParam) -> Self {
        let eta = if eta > 0.0 && eta.is_finite() { eta } else { 1.0 };
        Self { eta, tint, rough: RoughInterface::new(eta, roughness) }
    }

    pub(super) fn is_constant(&self) -> bool {
        self.rough.is_constant() && param::is_constant(&self.tint)
    }

    #[inline]
    pub(super) fn lobe(&self, at: Point) -> Lobe {
        let tint = param::share(&self.tint, at);
        match self.rough.at(tint, at) {
            None => Lobe::SmoothDielectric(SmoothDielectric { eta: at.eta.unwrap_or(self.eta), tint }),
            Some(lobe) => Lobe::RoughDielectric(lobe),
        }
    }
}

/// Metal.
#[derive(Clone, Debug)]
pub(super) struct Conductor {
    reflectance: Reflectance,
    micro: Microsurface,
}

/// Reflectance over the angle.
#[derive(Clone, Debug)]
pub(super) enum Reflectance {
    /// Constant over the surface, and exact.
    Fixed(Fresnel),
    /// Reflectance at normal incidence.
    Schlick(ColorParam),
}

impl Reflectance {
    pub(super) fn new(fresnel: &desc::Fresnel) -> Self {
        let lanes = |rgb: &[f32; 3]| Spectrum::from_rgb(*rgb).0;
        match fresnel {
            desc::Fresnel::Complex { eta, k } => Self::Fixed(Fresnel::complex(lanes(eta), lanes(k))),
            desc::Fresnel::Schlick { f0 } => Self::Schlick(*f0),
        }
    }

    pub(super) fn is_constant(&self) -> bool {
        match self {
            Self::Fixed(_) => true,
            Self::Schlick(f0) => param::is_constant(f0),
        }
    }

    /// Its energy is summed by a series.
    pub(super) fn is_series(&self) -> bool {
        matches!(self, Self::Fixed(_))
    }

    #[inline]
    pub(super) fn at(&self, at: Point) -> Fresnel {
        match self {
            Self::Fixed(fresnel) => fresnel.clone(),
            Self::Schlick(f0) => Fresnel::schlick(param::share(f0, at), 1.0),
        }
    }
}

impl Conductor {
    pub(super) fn new(fresnel: &desc::Fresnel, roughness: desc::Roughness) -> Self {
        let (reflectance, micro) = (Reflectance::new(fresnel), Microsurface::new(roughness));
        if reflectance.is_series() {
            micro.prepare_series();
        }
        Self { reflectance, micro }
    }

    pub(super) fn is_constant(&self) -> bool {
        self.reflectance.is_constant() && self.micro.is_constant()
    }

    #[inline]
    pub(super) fn lobe(&self, at: Point) -> Lobe {
        let fresnel = self.reflectance.at(at);
        match self.micro.at(at) {
            None => Lobe::Mirror(Mirror { fresnel }),
            Some(micro) => Lobe::RoughReflection(RoughReflection::new(micro, fresnel)),
        }
    }
}
