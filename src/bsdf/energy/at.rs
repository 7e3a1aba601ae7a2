//! The energy of one microsurface, over the direction.

use super::atlas::Pair;
use super::axes::{Axis, asinh, azimuth, log_alpha};
use super::grid::Stencil;
use super::interface::{Energy, Interface};
use super::sampling;
use super::table::{EnergyTable, Kind, N_MEANS, unpack, unpack_mean};
use crate::bsdf::ggx::Ggx;
use glam::Vec3;

/// The energy table of a mirroring interface at one roughness: what a lobe carries of it.
#[derive(Clone, Copy, Debug)]
pub struct EnergyAt {
    pub(super) table: &'static EnergyTable,
    pub(super) ggx: Ggx,
    /// Place of α in the table, 1/asinh(1/α): where directions stand; of isotropic microsurfaces.
    row: f32,
    scale: f32,
    /// ln(1 + 1/α²) of the larger α.
    pub(super) log: f32,
    mean_loss: f32,
}

impl EnergyAt {
    /// The energy of this microsurface. Its table is looked up, and computed the first time: for materials that are
    /// compiled. Where roughness varies over the surface there is [`Self::of`].
    pub fn new(interface: Interface, ggx: Ggx) -> Self {
        Self::of(EnergyTable::memoised(interface, (ggx.ax != ggx.ay).then_some(ggx)), ggx)
    }

    /// An isotropic microsurface, by the table of all of them.
    #[inline]
    pub fn isotropic(table: &'static EnergyTable, alpha: f32) -> Self {
        Self::of(table, Ggx { ax: alpha, ay: alpha })
    }

    /// A microsurface that the table has.
    #[inline]
    pub fn of(table: &'static EnergyTable, ggx: Ggx) -> Self {
        let (row, scale) = (log_alpha(ggx.ax), 1.0 / asinh(1.0 / ggx.ax));
        let mut new = Self { table, ggx, row, scale, log: sampling::log(ggx.ax.max(ggx.ay)), mean_loss: 0.0 };
        new.mean_loss = new.mean().loss;
        new
    }

    /// Energies depend on the azimuth.
    pub(in crate::bsdf) fn is_anisotropic(&self) -> bool {
        self.ggx.ax != self.ggx.ay
    }

    /// The microsurface.
    #[inline]
    pub(in crate::bsdf) fn ggx(&self) -> Ggx {
        self.ggx
    }

    /// Both are of the same microsurface.
    #[inline]
    pub(in crate::bsdf) fn is(&self, other: &Self) -> bool {
        std::ptr::eq(self.table, other.table) && self.ggx == other.ggx
    }

    /// Cosine-weighted mean of the lost energy over the hemisphere.
    #[inline]
    pub fn mean_loss(&self) -> f32 {
        self.mean_loss
    }

    /// Cosine-weighted means over the hemisphere.
    pub fn mean(&self) -> Energy {
        match &self.table.kind {
            Kind::Isotropic => unpack_mean(Stencil::new(self.row, N_MEANS).over(&self.table.means)),
            Kind::Pair(_) => unpack_mean(self.table.means[0]),
            Kind::EveryPair(atlas) => atlas.mean(&Pair::new(self.ggx)),
        }
    }

    /// Energy of the direction `w`, on either side.
    #[inline]
    pub fn at(&self, w: Vec3) -> Energy {
        if self.ggx.ax != self.ggx.ay {
            return self.at_azimuth(w);
        }
        let (mu, alpha) = (w.z.abs().min(1.0), self.ggx.ax);
        let x = (asinh(mu / alpha) * self.scale).sqrt();
        unpack(self.table.interface, self.table.grid.between(x, self.row), mu, alpha)
    }

    #[inline(never)]
    fn at_azimuth(&self, w: Vec3) -> Energy {
        let mu = w.z.abs().min(1.0);
        match &self.table.kind {
            Kind::EveryPair(atlas) => atlas.at(self.ggx, &Pair::new(self.ggx), w),
            Kind::Isotropic | Kind::Pair(_) => {
                let (alpha, row) = self.place(w);
                let x = Axis::new(self.table.interface, alpha).at(mu);
                unpack(self.table.interface, self.table.grid.between(x, row), mu, alpha)
            }
        }
    }

    /// The roughness that the azimuth of `w` meets, and its place in the table.
    #[inline]
    pub(super) fn place(&self, w: Vec3) -> (f32, f32) {
        if self.ggx.ax == self.ggx.ay {
            return (self.ggx.ax, self.row);
        }
        let (alpha, place) = azimuth(self.ggx, w);
        match self.table.kind {
            Kind::Pair(_) => (alpha, place),
            // As if the roughness that the azimuth meets were all there is.
            Kind::Isotropic | Kind::EveryPair(_) => (alpha, log_alpha(alpha)),
        }
    }
}
