//! The energy of both sides of a rough interface between dielectrics.

use super::axes::{Axis, azimuth, log_alpha};
use super::interface::{Energy, Interface};
use super::sampling;
use super::table::EnergyTable;
use super::volume::{self, Volume, volumes};
use crate::bsdf::ggx::Ggx;
use glam::Vec3;

/// The energy of an interface at one roughness and index, from outside and from inside.
///
/// Of one roughness it comes from the table over all roughnesses and indices. Two roughnesses have tables of their own, made
/// when the material is compiled, at the material's own index η₀; at another index the change is that of the roughness which
/// the azimuth meets,
///
/// ```text
/// loss(w; η) = loss(w; η₀) + loss_iso(μ, α(φ); η) − loss_iso(μ, α(φ); η₀)
/// ```
#[derive(Clone, Copy, Debug)]
pub struct DielectricEnergy {
    pair: Option<&'static Pair>,
    ggx: Ggx,
    /// Index of the inside over the outside.
    eta: f32,
    /// Places of roughness and index in the table.
    row: f32,
    layer: f32,
    /// Where directions of the denser side stand.
    axis: Axis,
    /// Energy lost on the mean over the hemisphere, outside and inside.
    mean_loss: [f32; 2],
}

/// The tables of one microsurface of two roughnesses at one index.
#[derive(Debug)]
pub struct Pair {
    eta: f32,
    ggx: Ggx,
    /// Outside, inside.
    sides: [&'static EnergyTable; 2],
}

impl Pair {
    /// The tables of this microsurface and this index, inside over outside: computed the first time.
    pub fn new(ggx: Ggx, eta: f32) -> &'static Self {
        let side = |eta| EnergyTable::memoised(Interface::Dielectric { eta }, Some(ggx));
        Box::leak(Box::new(Self { eta, ggx, sides: [side(eta), side(1.0 / eta)] }))
    }
}

/// The volume of the side of index `eta` as seen from it.
#[inline]
fn volume(eta: f32) -> &'static Volume {
    &volumes()[usize::from(eta < 1.0)]
}

impl DielectricEnergy {
    /// An interface of roughness `alpha` whose inside has the index `eta` over the outside.
    #[inline]
    pub fn isotropic(alpha: f32, eta: f32) -> Self {
        let mut new = Self {
            pair: None,
            ggx: Ggx { ax: alpha, ay: alpha },
            eta,
            row: log_alpha(alpha),
            layer: volume::layer(eta),
            axis: Axis::critical(volume::critical(eta), alpha),
            mean_loss: [0.0; 2],
        };
        new.mean_loss = [eta, 1.0 / eta].map(|eta| volume(eta).mean_loss(new.row, new.layer));
        new
    }

    /// An interface of two roughnesses, at any index.
    pub fn of(pair: &'static Pair, eta: f32) -> Self {
        let Ggx { ax, ay } = pair.ggx;
        let [here, there] = [eta, pair.eta].map(|eta| Self::isotropic((ax * ay).sqrt(), eta).mean_loss);
        let own = pair.sides.map(|table| table.mean_of_pair().loss);
        let mean_loss = std::array::from_fn(|k| (own[k] + here[k] - there[k]).clamp(1e-6, 1.0));
        Self { pair: Some(pair), ggx: pair.ggx, mean_loss, ..Self::isotropic(ax, eta) }
    }

    /// The microsurface.
    #[inline]
    pub fn ggx(&self) -> Ggx {
        self.ggx
    }

    /// Index of the inside over the outside.
    #[inline]
    pub fn eta(&self) -> f32 {
        self.eta
    }

    /// Energy lost on the mean over the hemisphere, outside and inside.
    #[inline]
    pub fn mean_loss(&self) -> [f32; 2] {
        self.mean_loss
    }

    /// Energy of the direction `w`, seen from its own side: what is lost, and what single scattering transmits.
    #[inline]
    pub fn at(&self, w: Vec3) -> Energy {
        let eta = if w.z > 0.0 { self.eta } else { 1.0 / self.eta };
        let mu = w.z.abs().min(1.0);
        match self.pair {
            None => volume(eta).at(mu, self.ggx.ax, eta, self.row, self.layer, &self.axis),
            Some(pair) => self.at_azimuth(pair, w, mu, eta),
        }
    }

    #[inline(never)]
    fn at_azimuth(&self, pair: &Pair, w: Vec3, mu: f32, eta: f32) -> Energy {
        let (alpha, place) = azimuth(self.ggx, w);
        let own = pair.sides[usize::from(w.z <= 0.0)].energy(mu, alpha, place);
        if self.eta == pair.eta {
            return own;
        }
        let isotropic = |eta: f32| {
            let axis = Axis::critical(volume::critical(eta), alpha);
            volume(eta).at(mu, alpha, eta, log_alpha(alpha), volume::layer(eta), &axis)
        };
        let (here, there) = (isotropic(eta), isotropic(if w.z > 0.0 { pair.eta } else { 1.0 / pair.eta }));
        let loss = (own.loss + here.loss - there.loss).clamp(0.0, 1.0);
        let transmitted = own.parts[0] + here.parts[0] - there.parts[0];
        Energy { loss, parts: [transmitted.clamp(0.0, 1.0 - loss), 0.0] }
    }

    /// Draws a direction of the multiply scattered part above the horizon.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> Vec3 {
        let alpha = self.ggx.ax.max(self.ggx.ay);
        sampling::sample(alpha, sampling::log(alpha), u)
    }

    /// Its density \[1/sr\] at the cosine `mu` ≥ 0.
    #[inline]
    pub fn pdf(&self, mu: f32) -> f32 {
        let alpha = self.ggx.ax.max(self.ggx.ay);
        sampling::pdf(alpha, sampling::log(alpha), mu)
    }
}
