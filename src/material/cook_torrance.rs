//! Cook and Torrance's model: Beckmann's microfacets with a Fresnel term.

use super::classic::Reflectance;
use super::param::Point;
use super::roughness::{Fixed, alpha, fixed};
use crate::bsdf::{Beckmann, EnergyTable, Interface, Lobe, Micro, Mirror, RoughReflection};
use crate::desc::{self, Roughness};

/// The model, with its energy tables resolved ahead of hits.
#[derive(Clone, Debug)]
pub(super) struct CookTorrance {
    reflectance: Reflectance,
    micro: Microsurface,
}

#[derive(Clone, Debug)]
enum Microsurface {
    Smooth,
    Fixed(Micro<Beckmann>),
    Varying(Roughness, &'static EnergyTable),
}

impl CookTorrance {
    pub(super) fn new(fresnel: &desc::Fresnel, roughness: Roughness) -> Self {
        let reflectance = Reflectance::new(fresnel);
        let micro = match fixed(&roughness) {
            Some(Fixed::Smooth) => Microsurface::Smooth,
            Some(Fixed::Rough(alpha)) => Microsurface::Fixed(Micro::beckmann(alpha)),
            None => Microsurface::Varying(roughness, EnergyTable::isotropic(Interface::BeckmannMirror)),
        };
        match &micro {
            Microsurface::Fixed(micro) if reflectance.is_series() => micro.energy().prepare_series(),
            Microsurface::Varying(_, table) if reflectance.is_series() => table.prepare_series(),
            _ => {}
        }
        Self { reflectance, micro }
    }

    pub(super) fn is_constant(&self) -> bool {
        self.reflectance.is_constant() && !matches!(self.micro, Microsurface::Varying(..))
    }

    #[inline]
    pub(super) fn lobe(&self, at: Point) -> Lobe {
        let fresnel = self.reflectance.at(at);
        let micro = match &self.micro {
            Microsurface::Smooth => None,
            Microsurface::Fixed(micro) => Some(*micro),
            Microsurface::Varying(roughness, table) => {
                alpha(roughness, at).map(|[a, _]| Micro::isotropic_beckmann(a, table))
            }
        };
        match micro {
            None => Lobe::Mirror(Mirror { fresnel }),
            Some(micro) => Lobe::CookTorrance(RoughReflection::new(micro, fresnel)),
        }
    }
}
