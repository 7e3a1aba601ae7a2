//! Energy of microfacets whose reflectance over the angle is a series.

use super::at::EnergyAt;
use super::axes::abscissa;
use super::grid::{Grid, Stencil};
use super::interface::Interface;
use super::quadrature::Rule;
use super::table::{EnergyTable, Kind, N_AZIMUTH, mean_row, means, n_alpha, nodes, over_cosine};
use crate::bsdf::angular::{Angular, TERMS, polynomials};
use crate::spectrum::Spectrum;
use glam::{Vec3, Vec4};
use std::ops::{Add, Mul};

/// Nodes in μ.
const N_MU: usize = 80;

/// Where μ stands in the grid: half of the nodes as for energies, half for the waves of T_j(2√μ − 1).
#[inline]
fn place(interface: Interface, mu: f32, alpha: f32) -> f32 {
    0.5 * (abscissa(interface, mu, alpha) + mu.sqrt())
}

/// A number for each term.
#[derive(Clone, Copy, Debug, Default)]
struct Terms([Vec4; TERMS / 4]);

impl Terms {
    fn new(x: [f32; TERMS]) -> Self {
        Self(std::array::from_fn(|q| Vec4::from_slice(&x[4 * q..])))
    }

    #[inline]
    fn array(self) -> [f32; TERMS] {
        std::array::from_fn(|j| self.0[j / 4][j % 4])
    }
}

impl Add for Terms {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self(std::array::from_fn(|q| self.0[q] + o.0[q]))
    }
}

impl Mul<f32> for Terms {
    type Output = Self;
    #[inline]
    fn mul(self, k: f32) -> Self {
        Self(self.0.map(|x| x * k))
    }
}

/// M_j of [`Angular`] over μ and α, or over μ and azimuth.
#[derive(Debug)]
pub(super) struct Moments {
    /// Less what the macroscopic surface would do, (1 − loss) T_j(2√μ − 1).
    grid: Grid<Terms>,
    /// Its nodes in α or azimuth.
    rows: usize,
    /// Averages over the hemisphere, as those of the energies.
    means: Vec<Terms>,
}

impl EnergyTable {
    /// Computes what series need, unless it is there: ask before anything is traced.
    pub fn prepare_series(&self) {
        self.moments_of();
    }

    fn moments_of(&self) -> &Moments {
        if matches!(self.kind, Kind::EveryPair(_)) {
            return Self::isotropic(self.interface).moments_of();
        }
        if let Some(moments) = self.moments.get() {
            return moments;
        }
        // Made before the cell is locked: a thread that waits for the others may take up work that asks for it.
        let made = self.tabulate_moments();
        self.moments.get_or_init(|| made)
    }

    fn tabulate_moments(&self) -> Moments {
        let (interface, anisotropic) = (self.interface, self.pair());
        let rows = if anisotropic.is_some() { N_AZIMUTH } else { n_alpha(interface) };
        let rule = Rule::new::<12, 12>();
        let grid = nodes(
            [N_MU, n_alpha(interface)],
            |mu, alpha| place(interface, mu, alpha),
            anisotropic,
            |mu, phi, _, a| {
                let (m, smooth) = (interface.moments(&rule, mu, phi, a), polynomials(mu.into()));
                // T₀ = 1: the first is what is kept.
                Terms::new(std::array::from_fn(|j| (m[j] - m[0] * smooth[j]) as f32))
            },
        );
        let means = means(anisotropic, |row, alpha| {
            over_cosine(interface, alpha, |mu| {
                let kept = 1.0 - self.energy(mu, alpha, row).loss;
                moments_at(grid.at(place(interface, mu, alpha), Stencil::new(row, rows)), mu, kept)
            })
        });
        let means = means.into_iter().map(|m| Terms::new(m.map(|x| x as f32))).collect();
        Moments { grid, rows, means }
    }
}

/// With the part of the macroscopic surface; `kept` = 1 − loss.
#[inline]
fn moments_at(rest: Terms, mu: f32, kept: f32) -> [f32; TERMS] {
    let x = 2.0 * mu.sqrt() - 1.0;
    let mut m = rest.array();
    let (mut t, mut before) = (x, 1.0);
    m[0] += kept;
    for m in &mut m[1..] {
        *m += kept * t;
        (t, before) = (2.0 * x * t - before, t);
    }
    m
}

impl EnergyAt {
    /// Makes the tables of its microsurface for [`Self::reflected`]: ask before anything is traced.
    pub fn prepare_series(&self) {
        self.table.prepare_series();
    }

    /// Single scattering by facets that reflect `f`, towards `w`, where the energy `loss` is lost: ∫ f(c) over the lobe, c the
    /// cosine at the facet.
    #[inline]
    pub fn reflected(&self, f: &Angular, w: Vec3, loss: f32) -> Spectrum {
        f.dot(&self.terms(w, loss))
    }

    /// M_j towards `w`.
    #[inline]
    fn terms(&self, w: Vec3, loss: f32) -> [f32; TERMS] {
        let (mu, (alpha, row)) = (w.z.abs().min(1.0), self.place(w));
        let moments = self.table.moments_of();
        let row = Stencil::new(row, moments.rows);
        let rest = moments.grid.at(place(self.table.interface, mu, alpha), row);
        moments_at(rest, mu, 1.0 - loss)
    }

    /// Its cosine-weighted mean over the hemisphere.
    pub fn reflected_mean(&self, f: &Angular) -> Spectrum {
        let means = &self.table.moments_of().means;
        let mean = if means.len() == 1 { means[0] } else { mean_row((self.ggx.ax * self.ggx.ay).sqrt()).over(means) };
        f.dot(&mean.array())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::Ggx;

    /// The tables against the converged quadrature, between their nodes.
    #[test]
    fn interpolation_costs_little() {
        let rule = Rule::new::<32, 40>();
        let table = EnergyTable::isotropic(Interface::Mirror);
        let start = std::time::Instant::now();
        table.moments_of();
        println!("tabulated in {:.0?}", start.elapsed());
        let mut worst = [0.0f64; TERMS];
        for alpha in [1e-3, 0.02, 0.13, 0.35, 0.7, 0.97] {
            let slice = EnergyAt::new(Interface::Mirror, Ggx { ax: alpha, ay: alpha });
            for mu in (1..=20).map(|i| (i as f32 / 20.3).powi(3)) {
                let exact = Interface::Mirror.moments(&rule, mu, 0.0, [alpha, alpha]);
                let terms = {
                    let w = Vec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
                    slice.terms(w, slice.at(w).loss)
                };
                worst = std::array::from_fn(|j| worst[j].max((f64::from(terms[j]) - exact[j]).abs()));
            }
        }
        println!("worst errors {worst:?}");
        // Of a series as of its terms, which fall off.
        let bound = |j: i32| 2e-4 * 2f64.powi(j);
        assert!(worst.iter().zip(0..).all(|(&off, j)| off < bound(j)), "{worst:?}");
    }
}
