//! Roughness over the surface, with the energy tables that it needs resolved ahead of hits.

use super::param::{self, Point};
use crate::bsdf::{DielectricPair, EnergyTable, Ggx, Interface, MIN_ALPHA, Micro, RoughDielectric};
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

/// The least and the greatest α of one roughness over a surface that is not smooth everywhere.
pub(super) fn alpha_bounds(roughness: &Roughness) -> Option<[f32; 2]> {
    match (fixed(roughness), roughness) {
        (Some(Fixed::Smooth), _) => None,
        (Some(Fixed::Rough([a, _])), _) => Some([a.clamp(MIN_ALPHA, 1.0); 2]),
        (None, Roughness::Perceptual(r)) => Some([MIN_ALPHA, (r.factor * r.factor).clamp(MIN_ALPHA, 1.0)]),
        (None, _) => Some([MIN_ALPHA, 1.0]),
    }
}

/// The microsurface of a reflecting material.
#[derive(Clone, Debug)]
pub(super) enum Microsurface {
    /// None anywhere.
    Smooth,
    /// Constant over the surface.
    Fixed(Micro),
    /// Of a texture, with the table of all roughnesses or, where there are two, of all pairs.
    Varying(Roughness, &'static EnergyTable),
}

impl Microsurface {
    pub(super) fn new(roughness: Roughness) -> Self {
        match (fixed(&roughness), &roughness) {
            (Some(Fixed::Smooth), _) => Self::Smooth,
            // One table serves all materials; one for each would take a third of a second.
            (Some(Fixed::Rough([a, b])), Roughness::Stretched { .. }) if a != b => {
                Self::Fixed(Micro::of([a, b], EnergyTable::every_pair()))
            }
            (None, Roughness::Stretched { .. }) => Self::Varying(roughness, EnergyTable::every_pair()),
            (Some(Fixed::Rough(alpha)), _) => Self::Fixed(Micro::new(alpha)),
            (None, _) => Self::Varying(roughness, EnergyTable::isotropic(Interface::Mirror)),
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
            Self::Varying(roughness, table) => alpha(roughness, at).map(|alpha| Micro::of(alpha, table)),
        }
    }
}

/// The microsurface of a dielectric interface.
#[derive(Clone, Debug)]
pub(super) struct RoughInterface {
    eta: f32,
    roughness: Roughness,
    own: Own,
}

/// How rough it is.
#[derive(Clone, Debug)]
enum Own {
    /// Smooth.
    Smooth,
    /// As rough everywhere, and as much along x as along y.
    Fixed(f32),
    /// Rougher along one direction: tables of this microsurface at the material's own index.
    Pair(&'static DielectricPair),
    /// Of a texture. Where two roughnesses vary, their geometric mean: there are no tables for all pairs and indices.
    Varying,
}

impl RoughInterface {
    pub(super) fn new(eta: f32, roughness: Roughness) -> Self {
        let own = match fixed(&roughness) {
            Some(Fixed::Smooth) => Own::Smooth,
            Some(Fixed::Rough([a, b])) if a == b => Own::Fixed(a),
            // In a medium of its own index it is none, and elsewhere one whose tables are near.
            Some(Fixed::Rough(alpha)) => {
                let [ax, ay] = alpha.map(|a| a.clamp(MIN_ALPHA, 1.0));
                Own::Pair(DielectricPair::new(Ggx { ax, ay }, eta))
            }
            None => Own::Varying,
        };
        Self { eta, roughness, own }
    }

    pub(super) fn is_constant(&self) -> bool {
        !matches!(self.own, Own::Varying)
    }

    /// `None` where the surface is smooth.
    #[inline]
    pub(super) fn at(&self, tint: Spectrum, at: Point) -> Option<RoughDielectric> {
        let eta = at.eta.unwrap_or(self.eta);
        if is_no_interface(eta) {
            return None;
        }
        match &self.own {
            Own::Smooth => None,
            Own::Fixed(alpha) => Some(RoughDielectric::isotropic(*alpha, eta, tint)),
            Own::Pair(tables) => Some(RoughDielectric::between(tables, eta, tint)),
            Own::Varying => {
                alpha(&self.roughness, at).map(|[a, b]| RoughDielectric::isotropic((a * b).sqrt(), eta, tint))
            }
        }
    }
}

fn is_no_interface(eta: f32) -> bool {
    (eta - 1.0).abs() < SAME_INDEX
}
