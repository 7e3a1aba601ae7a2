//! A table at one roughness.

use super::atlas::{Atlas, Pair};
use super::axes::{Axis, azimuth, log_alpha};
use super::grid::Stencil;
use super::interface::{Energy, Interface};
use super::table::{EnergyTable, N_AZIMUTH, N_MEANS, n_alpha, unpack, unpack_mean};
use crate::bsdf::ggx::Ggx;
use crate::math::sqr;
use glam::{Vec3, Vec4};

/// A table at one roughness: what a lobe carries.
#[derive(Clone, Copy, Debug)]
pub struct Slice {
    /// Of this microsurface; of isotropic ones where the atlas has the energies.
    pub(super) table: &'static EnergyTable,
    pub(super) ggx: Ggx,
    row: Stencil,
    /// Of isotropic microsurfaces: where directions stand, and the line of the grid that the row interpolates, if it is
    /// there.
    axis: Axis,
    line: Option<&'static [Vec4]>,
    /// Every pair of roughnesses, where there is no table of this one.
    atlas: Option<&'static Atlas>,
    /// The energy of a direction that is asked for again and again.
    seen: Option<(Vec3, Energy)>,
    /// The larger α, squared, and ln(1 + 1/α²).
    pub(super) alpha2: f32,
    pub(super) log: f32,
    /// Cosine-weighted means over the hemisphere.
    pub mean: Energy,
}

impl Slice {
    /// The energy of this microsurface. Tables are looked up by their parameters, and computed the first time: make
    /// slices when materials are compiled, and where roughness varies over the surface by [`Slice::isotropic`].
    pub fn new(interface: Interface, ggx: Ggx) -> Self {
        if ggx.ax == ggx.ay {
            let slice = Self::isotropic(EnergyTable::isotropic(interface), ggx.ax);
            return Self { line: Some(slice.table.line(ggx.ax, slice.row)), ..slice };
        }
        let table = EnergyTable::memoised(interface, Some(ggx));
        Self::with(table, ggx, Stencil::new(0.0, N_AZIMUTH), unpack_mean(table.means[0]))
    }

    /// An isotropic table at this α.
    #[inline]
    pub fn isotropic(table: &'static EnergyTable, alpha: f32) -> Self {
        let t = log_alpha(alpha);
        let mean = unpack_mean(Stencil::new(t, N_MEANS).over(&table.means));
        Self::with(table, Ggx { ax: alpha, ay: alpha }, Stencil::new(t, n_alpha(table.interface)), mean)
    }

    /// Any pair of roughnesses of a mirroring microsurface, without a table of its own; `table` is that of the isotropic ones.
    #[inline]
    pub fn anisotropic(atlas: &'static Atlas, table: &'static EnergyTable, ggx: Ggx) -> Self {
        let mean = atlas.mean(&Pair::new(ggx));
        let slice = Self::with(table, ggx, Stencil::new(0.0, n_alpha(table.interface)), mean);
        Self { atlas: Some(atlas), ..slice }
    }

    #[inline]
    fn with(table: &'static EnergyTable, ggx: Ggx, row: Stencil, mean: Energy) -> Self {
        let alpha2 = sqr(ggx.ax.max(ggx.ay));
        let axis = Axis::new(table.interface, ggx.ax);
        Self { table, ggx, row, axis, line: None, atlas: None, seen: None, alpha2, log: (1.0 / alpha2).ln_1p(), mean }
    }

    /// Energies depend on the azimuth.
    pub(in crate::bsdf) fn is_anisotropic(&self) -> bool {
        self.ggx.ax != self.ggx.ay
    }

    /// Remembers the energy of the direction `w`, as `other` does where that is the same slice.
    #[inline]
    pub(in crate::bsdf) fn look_from(&mut self, w: Vec3, other: Option<&Self>) {
        let w = w.with_z(w.z.abs());
        self.seen = match other {
            Some(other) if std::ptr::eq(other.table, self.table) && other.ggx == self.ggx => other.seen,
            _ => Some((w, self.find(w))),
        };
    }

    /// Energy of the direction `w`, on either side.
    #[inline]
    pub fn at(&self, w: Vec3) -> Energy {
        match self.seen {
            Some((seen, energy)) if seen == w.with_z(w.z.abs()) => energy,
            _ => self.find(w),
        }
    }

    #[inline(never)]
    fn find(&self, w: Vec3) -> Energy {
        if let Some(atlas) = self.atlas {
            return atlas.at(self.ggx, &Pair::new(self.ggx), w);
        }
        let mu = w.z.abs().min(1.0);
        if self.is_anisotropic() {
            let (alpha, row) = self.place(w);
            return self.table.energy(mu, alpha, row);
        }
        let x = self.axis.at(mu);
        let value = match self.line {
            Some(line) => Stencil::new(x, line.len()).over(line),
            None => self.table.grid.at(x, self.row),
        };
        unpack(self.table.interface, value, mu, self.ggx.ax)
    }

    /// The roughness that the azimuth of `w` meets, and the row of the table.
    #[inline]
    pub(super) fn place(&self, w: Vec3) -> (f32, Stencil) {
        if self.ggx.ax == self.ggx.ay {
            return (self.ggx.ax, self.row);
        }
        let (alpha, t) = azimuth(self.ggx, w);
        match self.atlas {
            None => (alpha, Stencil::new(t, N_AZIMUTH)),
            // As if the roughness that the azimuth meets were all there is.
            Some(_) => (alpha, Stencil::new(log_alpha(alpha), n_alpha(self.table.interface))),
        }
    }
}
