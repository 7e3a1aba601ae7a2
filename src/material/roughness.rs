//! Roughness over the surface, with the energy tables that it needs resolved ahead of hits.

use super::param::{self, Point};
use crate::bsdf::{DielectricTables, EnergyTable, Interface, MIN_ALPHA, Micro, RoughDielectric};
use crate::desc::Roughness;
use crate::spectrum::Spectrum;

/// |η − 1| below which an interface counts as smooth: it bends light by less than roughness could show.
const SAME_INDEX: f32 = 2e-3;

/// α along x and y at a point; `None` where the surface is smooth.
#[inline]
pub(super) fn alpha(roughness: &Roughness, at: Point) -> Option<[f32; 2]> {
    let alpha = match roughness {
        Roughness::Perceptual(r) => {
            let r = param::scalar(r, at);
            [r * r; 2]
        }
        Roughness::Glossiness(g) => {
            let r = 1.0 - param::scalar(g, at);
            [r * r; 2]
        }
        Roughness::Alpha(a) => *a,
    };
    (alpha[0].max(alpha[1]) >= MIN_ALPHA).then_some(alpha)
}

/// α where it is the same everywhere.
pub(super) enum Fixed {
    Smooth,
    Rough([f32; 2]),
}

/// α ahead of hits; `None` where it varies.
pub(super) fn fixed(roughness: &Roughness) -> Option<Fixed> {
    match roughness {
        Roughness::Perceptual(r) | Roughness::Glossiness(r) if r.texture.is_some() => None,
        _ => Some(param::nowhere(|at| alpha(roughness, at)).map_or(Fixed::Smooth, Fixed::Rough)),
    }
}

/// The microsurface of a reflecting material.
#[derive(Clone, Debug)]
pub(super) enum Microsurface {
    /// None anywhere.
    Smooth,
    /// The same everywhere.
    Fixed(Micro),
    /// Of a texture.
    Varying(Roughness, &'static EnergyTable),
}

impl Microsurface {
    pub(super) fn new(roughness: Roughness) -> Self {
        match fixed(&roughness) {
            Some(Fixed::Smooth) => Self::Smooth,
            Some(Fixed::Rough(alpha)) => Self::Fixed(Micro::new(alpha)),
            None => Self::Varying(roughness, EnergyTable::isotropic(Interface::Mirror)),
        }
    }

    pub(super) fn is_constant(&self) -> bool {
        !matches!(self, Self::Varying(..))
    }

    /// Makes the tables for reflectances that are not Schlick's.
    pub(super) fn prepare_series(&self) {
        match self {
            Self::Smooth => {}
            Self::Fixed(micro) => micro.energy().prepare_series(),
            Self::Varying(_, table) => table.prepare_series(),
        }
    }

    /// `None` where the surface is smooth.
    #[inline]
    pub(super) fn at(&self, at: Point) -> Option<Micro> {
        match self {
            Self::Smooth => None,
            Self::Fixed(micro) => Some(*micro),
            Self::Varying(roughness, table) => alpha(roughness, at).map(|[a, _]| Micro::isotropic(a, table)),
        }
    }
}

/// The microsurface of a dielectric interface.
#[derive(Clone, Debug)]
pub(super) enum RoughInterface {
    /// None anywhere.
    Smooth,
    /// The same everywhere.
    Fixed(Box<RoughDielectric>),
    /// Of a texture.
    Varying(Roughness, DielectricTables),
}

impl RoughInterface {
    pub(super) fn new(eta: f32, roughness: Roughness) -> Self {
        match fixed(&roughness) {
            _ if (eta - 1.0).abs() < SAME_INDEX => Self::Smooth,
            Some(Fixed::Smooth) => Self::Smooth,
            Some(Fixed::Rough(alpha)) => Self::Fixed(Box::new(RoughDielectric::new(alpha, eta, Spectrum::ONE))),
            None => Self::Varying(roughness, DielectricTables::new(eta)),
        }
    }

    pub(super) fn is_constant(&self) -> bool {
        !matches!(self, Self::Varying(..))
    }

    /// `None` where the surface is smooth.
    #[inline]
    pub(super) fn at(&self, eta: f32, tint: Spectrum, at: Point) -> Option<RoughDielectric> {
        match self {
            Self::Smooth => None,
            Self::Fixed(lobe) => Some(lobe.with_tint(tint)),
            Self::Varying(roughness, tables) => {
                alpha(roughness, at).map(|[a, _]| RoughDielectric::isotropic(a, eta, tint, tables))
            }
        }
    }
}
