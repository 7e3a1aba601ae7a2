//! Mirror, dielectric, conductor.

use super::param::{self, Point};
use super::roughness::{Microsurface, RoughInterface};
use crate::bsdf::{Fresnel, Lobe, Mirror, RoughReflection, SmoothDielectric};
use crate::desc::{self, ColorParam};
use crate::spectrum::Spectrum;

/// A mirror of this reflectance at every angle.
pub(super) fn mirror(reflectance: Spectrum) -> Lobe {
    Lobe::Mirror(Mirror { fresnel: Fresnel::schlick(reflectance, reflectance) })
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
        let eta = at.eta.unwrap_or(self.eta);
        match self.rough.at(eta, tint, at) {
            None => Lobe::SmoothDielectric(SmoothDielectric { eta, tint }),
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

#[derive(Clone, Debug)]
enum Reflectance {
    Fixed(Fresnel),
    Schlick(ColorParam),
}

impl Conductor {
    pub(super) fn new(fresnel: &desc::Fresnel, roughness: desc::Roughness) -> Self {
        let lanes = |rgb: &[f32; 3]| Spectrum::from_rgb(*rgb).0;
        let reflectance = match fresnel {
            desc::Fresnel::Complex { eta, k } => Reflectance::Fixed(Fresnel::complex(lanes(eta), lanes(k))),
            desc::Fresnel::Schlick { f0 } => Reflectance::Schlick(*f0),
        };
        Self { reflectance, micro: Microsurface::new(roughness) }
    }

    pub(super) fn is_constant(&self) -> bool {
        let colour = match &self.reflectance {
            Reflectance::Fixed(_) => true,
            Reflectance::Schlick(f0) => param::is_constant(f0),
        };
        colour && self.micro.is_constant()
    }

    #[inline]
    pub(super) fn lobe(&self, at: Point) -> Lobe {
        let fresnel = match &self.reflectance {
            Reflectance::Fixed(fresnel) => *fresnel,
            Reflectance::Schlick(f0) => Fresnel::schlick(param::share(f0, at), Spectrum::ONE),
        };
        match self.micro.at(at) {
            None => Lobe::Mirror(Mirror { fresnel }),
            Some(micro) => Lobe::RoughReflection(RoughReflection::new(micro, fresnel)),
        }
    }
}
