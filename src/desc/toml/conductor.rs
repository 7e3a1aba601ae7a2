//! `type = "conductor"` and `"cook-torrance"`: metals, and what reflects like them.

use super::build::Builder;
use super::color::Reflectance;
use super::keys::keys;
use super::metals;
use super::number::{NonNegative, Positive};
use super::read::{At, Fault, suggest};
use super::roughness::RoughnessTable;
use super::writer::Names;
use crate::desc::{Fresnel, Model, Roughness};
use std::ops::Range;

keys! {
    /// Metal: give one of `metal`, `eta` with `k`, and `reflectance`.
    struct Conductor {
        /// A metal by its chemical symbol: Ag, Al, Au, Cr, Cu, Fe, Ni, Ti.
        metal: Option<At<String>>,
        /// Real part of the index of refraction for R, G and B.
        eta: Option<[Positive; 3]>,
        /// Extinction coefficient for R, G and B.
        k: Option<[NonNegative; 3]>,
        /// Reflectance at normal incidence (Schlick's approximation), each channel in [0, 1].
        reflectance: Option<Reflectance>,
        ..surface: RoughnessTable,
    }
}

keys! {
    /// Microfacets of Cook and Torrance: Beckmann's distribution of normals. Give one of `metal`, `eta` with `k`,
    /// `reflectance` and `ior`.
    struct CookTorrance {
        /// A metal by its chemical symbol: Ag, Al, Au, Cr, Cu, Fe, Ni, Ti.
        metal: Option<At<String>>,
        /// Real part of the index of refraction for R, G and B.
        eta: Option<[Positive; 3]>,
        /// Extinction coefficient for R, G and B.
        k: Option<[NonNegative; 3]>,
        /// Reflectance at normal incidence (Schlick's approximation), each channel in [0, 1].
        reflectance: Option<Reflectance>,
        /// Index of refraction of a dielectric, of which only the reflection is shown.
        ior: Option<Positive>,
        ..surface: RoughnessTable,
    }
}

impl Conductor {
    /// The scattering model. `at` is the place of the material's name.
    pub(super) fn build(&self, at: &Range<usize>, b: &mut Builder<'_>) -> Result<Model, Fault> {
        let roughness = self.surface.build(b)?;
        Ok(Model::Conductor { fresnel: self.fresnel(at, b)?, roughness })
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(fresnel: &Fresnel, roughness: &Roughness, names: &Names) -> Self {
        let (eta, k, reflectance) = match fresnel {
            Fresnel::Complex { eta, k } => (Some(eta.map(Positive)), Some(k.map(NonNegative)), None),
            Fresnel::Schlick { f0 } => (None, None, Some(Reflectance::of(f0, names))),
        };
        Self { metal: None, eta, k, reflectance, surface: RoughnessTable::of(roughness, names) }
    }

    fn fresnel(&self, at: &Range<usize>, b: &mut Builder<'_>) -> Result<Fresnel, Fault> {
        match (&self.metal, self.eta, self.k, &self.reflectance) {
            (Some(metal), None, None, None) => metals::fresnel(&metal.value).ok_or_else(|| {
                let hint = suggest(&metal.value, metals::names());
                Fault::new(&metal.at, format!("unknown metal `{}`; {hint}", metal.value))
            }),
            (None, Some(eta), Some(k), None) => Ok(Fresnel::Complex { eta: eta.map(|x| x.0), k: k.map(|x| x.0) }),
            (None, None, None, Some(f0)) => Ok(Fresnel::Schlick { f0: f0.build(b)? }),
            _ => Err(Fault::new(at, "a conductor needs one of `metal`, `eta` with `k`, and `reflectance`")),
        }
    }
}

impl CookTorrance {
    /// The scattering model. `at` is the place of the material's name.
    pub(super) fn build(&self, at: &Range<usize>, b: &mut Builder<'_>) -> Result<Model, Fault> {
        let roughness = self.surface.build(b)?;
        Ok(Model::CookTorrance { fresnel: self.fresnel(at, b)?, roughness })
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(fresnel: &Fresnel, roughness: &Roughness, names: &Names) -> Self {
        let Conductor { metal, eta, k, reflectance, surface } = Conductor::of(fresnel, roughness, names);
        Self { metal, eta, k, reflectance, ior: None, surface }
    }

    fn fresnel(&self, at: &Range<usize>, b: &mut Builder<'_>) -> Result<Fresnel, Fault> {
        let Self { metal, eta, k, reflectance, surface, .. } = self.clone();
        match self.ior {
            // A dielectric is a conductor that does not absorb.
            Some(ior) if metal.is_none() && eta.is_none() && k.is_none() && reflectance.is_none() => {
                Ok(Fresnel::Complex { eta: [ior.0; 3], k: [0.0; 3] })
            }
            Some(_) => Err(Fault::new(at, "`ior` is given beside `metal`, `eta`, `k` or `reflectance`; expected one")),
            None => Conductor { metal, eta, k, reflectance, surface }.fresnel(at, b),
        }
    }
}
