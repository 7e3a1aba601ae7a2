//! Roughness over the surface, with the energy tables that it needs resolved ahead of hits.

use super::param::{self, Point};
use crate::bsdf::{Atlas, DielectricTables, EnergyTable, Interface, MIN_ALPHA, Micro, RoughDielectric};
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
        Roughness::Stretched { roughness, strength } => {
            let (r, s) = (param::scalar(roughness, at), param::scalar(strength, at));
            [r * r + (1.0 - r * r) * s * s, r * r]
        }
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
        Roughness::Stretched { roughness, strength } if roughness.texture.is_some() || strength.texture.is_some() => {
            None
        }
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
    /// The same with two roughnesses.
    Stretched(Roughness, &'static Atlas, &'static EnergyTable),
}

impl Microsurface {
    pub(super) fn new(roughness: Roughness) -> Self {
        let isotropic = || EnergyTable::isotropic(Interface::Mirror);
        match (fixed(&roughness), &roughness) {
            (Some(Fixed::Smooth), _) => Self::Smooth,
            // One atlas serves all materials; a table each would take a third of a second each.
            (Some(Fixed::Rough([a, b])), Roughness::Stretched { .. }) if a != b => {
                Self::Fixed(Micro::varying([a, b], Atlas::get(), isotropic()))
            }
            (None, Roughness::Stretched { .. }) => Self::Stretched(roughness, Atlas::get(), isotropic()),
            (Some(Fixed::Rough(alpha)), _) => Self::Fixed(Micro::new(alpha)),
            (None, _) => Self::Varying(roughness, isotropic()),
        }
    }

    pub(super) fn is_constant(&self) -> bool {
        !matches!(self, Self::Varying(..) | Self::Stretched(..))
    }

    /// Makes the tables for reflectances that are not Schlick's.
    pub(super) fn prepare_series(&self) {
        match self {
            Self::Smooth => {}
            Self::Fixed(micro) => micro.energy().prepare_series(),
            Self::Varying(_, table) | Self::Stretched(_, _, table) => table.prepare_series(),
        }
    }

    /// `None` where the surface is smooth.
    #[inline]
    pub(super) fn at(&self, at: Point) -> Option<Micro> {
        match self {
            Self::Smooth => None,
            Self::Fixed(micro) => Some(*micro),
            Self::Varying(roughness, table) => alpha(roughness, at).map(|[a, _]| Micro::isotropic(a, table)),
            Self::Stretched(roughness, atlas, table) => {
                alpha(roughness, at).map(|alpha| Micro::varying(alpha, atlas, table))
            }
        }
    }
}

/// The microsurface of a dielectric interface.
#[derive(Clone, Debug)]
pub(super) struct RoughInterface {
    roughness: Roughness,
    own: Own,
}

/// The lobe of the material's own index.
#[derive(Clone, Debug)]
enum Own {
    /// None anywhere.
    Smooth,
    /// The same everywhere.
    Fixed(Box<RoughDielectric>),
    /// Of a texture.
    Varying(DielectricTables),
}

impl RoughInterface {
    pub(super) fn new(eta: f32, roughness: Roughness) -> Self {
        let own = match fixed(&roughness) {
            _ if is_no_interface(eta) => Own::Smooth,
            Some(Fixed::Smooth) => Own::Smooth,
            Some(Fixed::Rough(alpha)) => Own::Fixed(Box::new(RoughDielectric::new(alpha, eta, Spectrum::ONE))),
            None => Own::Varying(DielectricTables::new(eta)),
        };
        Self { roughness, own }
    }

    pub(super) fn is_constant(&self) -> bool {
        !matches!(self.own, Own::Varying(..))
    }

    /// `None` where the surface is smooth.
    #[inline]
    pub(super) fn at(&self, eta: f32, tint: Spectrum, at: Point) -> Option<RoughDielectric> {
        if at.eta.is_some() {
            return self.between(eta, tint, at);
        }
        match &self.own {
            Own::Smooth => None,
            Own::Fixed(lobe) => Some(lobe.with_tint(tint)),
            Own::Varying(tables) => {
                // Where two roughnesses vary, their geometric mean: there are no tables for pairs and indices.
                alpha(&self.roughness, at).map(|[a, b]| RoughDielectric::isotropic((a * b).sqrt(), eta, tint, tables))
            }
        }
    }

    /// The lobe of another index: its tables are looked up, and computed the first time.
    #[inline(never)]
    fn between(&self, eta: f32, tint: Spectrum, at: Point) -> Option<RoughDielectric> {
        if is_no_interface(eta) {
            return None;
        }
        let [a, b] = alpha(&self.roughness, at)?;
        Some(match fixed(&self.roughness) {
            Some(_) => RoughDielectric::new([a, b], eta, tint),
            // What is kept for every roughness that is asked for would pile up.
            None => RoughDielectric::isotropic((a * b).sqrt(), eta, tint, &DielectricTables::new(eta)),
        })
    }
}

fn is_no_interface(eta: f32) -> bool {
    (eta - 1.0).abs() < SAME_INDEX
}
