//! Tables of the energy over direction and roughness, computed once for each interface.

use super::atlas::Atlas;
use super::axes::{abscissa, alpha_of, azimuth, invert, log_alpha, shape};
use super::grid::{Grid, Stencil, Value};
use super::interface::{Energy, Interface};
use super::moments::Moments;
use super::quadrature::{Rule, gauss_legendre};
use crate::bsdf::ggx::Ggx;
use glam::{Vec3, Vec4};
use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;
use std::sync::{LazyLock, Mutex, OnceLock, PoisonError};

/// Nodes in μ; twice as many where there is a critical angle.
const N_MU: usize = 48;
/// Nodes in ln α. Gaussian slopes begin to lose energy far more suddenly.
pub(super) fn n_alpha(interface: Interface) -> usize {
    match interface {
        Interface::BeckmannMirror => 100,
        Interface::Mirror | Interface::Dielectric { .. } => 40,
    }
}
/// Nodes in azimuth.
pub(super) const N_AZIMUTH: usize = 33;
/// Nodes of the means in ln α.
pub(super) const N_MEANS: usize = 96;

/// Lines between rows take the place of cubics where there are this many times as many.
const REFINED: usize = 8;

/// Energy over the direction, of one microsurface or of many.
#[derive(Debug)]
pub struct EnergyTable {
    pub(super) interface: Interface,
    pub(super) kind: Kind,
    /// Of series over the angle, where one has been asked for.
    pub(super) moments: OnceLock<Moments>,
    /// Over μ and α, or over μ and azimuth.
    pub(super) grid: Grid<Vec4>,
    /// (ln loss, parts) averaged over the hemisphere, at equidistant ln α; one pair has one.
    pub(super) means: Vec<Vec4>,
}

/// Which microsurfaces a table has.
#[derive(Debug)]
pub(super) enum Kind {
    /// All that are as rough along x as along y.
    Isotropic,
    /// This one.
    Pair(Ggx),
    /// All, less exactly.
    EveryPair(Atlas),
}

impl EnergyTable {
    /// The table of all isotropic roughnesses.
    pub fn isotropic(interface: Interface) -> &'static Self {
        Self::memoised(interface, None)
    }

    /// The table of every pair of roughnesses of a mirroring microsurface.
    pub fn every_pair() -> &'static Self {
        static TABLE: OnceLock<EnergyTable> = OnceLock::new();
        if let Some(table) = TABLE.get() {
            return table;
        }
        // Not under the lock: the thread that waits for the others may take up work that asks for a table.
        let kind = Kind::EveryPair(Atlas::tabulate());
        let grid = Grid::tabulate_here(0, 0, |_, _| Vec4::ZERO);
        let table = Self { interface: Interface::Mirror, kind, moments: OnceLock::new(), grid, means: Vec::new() };
        TABLE.get_or_init(|| table)
    }

    /// The microsurface that the table is for, where it is for one.
    pub(super) fn pair(&self) -> Option<Ggx> {
        match self.kind {
            Kind::Pair(ggx) => Some(ggx),
            Kind::Isotropic | Kind::EveryPair(_) => None,
        }
    }

    /// Means of the one microsurface that the table is for.
    pub(super) fn mean_of_pair(&self) -> Energy {
        self.means.first().map_or_else(Energy::default, |mean| unpack_mean(*mean))
    }

    /// Towards the cosine `mu`, at the place of a roughness.
    #[inline]
    pub(super) fn energy(&self, mu: f32, alpha: f32, row: f32) -> Energy {
        unpack(self.interface, self.grid.between(abscissa(self.interface, mu, alpha), row), mu, alpha)
    }

    pub(super) fn memoised(interface: Interface, anisotropic: Option<Ggx>) -> &'static Self {
        type Tables = Mutex<HashMap<[u32; 3], &'static EnergyTable>>;
        static TABLES: LazyLock<Tables> = LazyLock::new(Default::default);
        let key = [
            match interface {
                Interface::Mirror => 0,
                Interface::BeckmannMirror => 1,
                Interface::Dielectric { eta } => eta.to_bits(),
            },
            anisotropic.map_or(0, |g| g.ax.to_bits()),
            anisotropic.map_or(0, |g| g.ay.to_bits()),
        ];
        let find = || TABLES.lock().unwrap_or_else(PoisonError::into_inner).get(&key).copied();
        if let Some(table) = find() {
            return table;
        }
        // Not under the lock: the thread that waits for the others may take up work that asks for a table.
        let table = Self::tabulate(interface, anisotropic);
        let mut tables = TABLES.lock().unwrap_or_else(PoisonError::into_inner);
        tables.entry(key).or_insert_with(|| Box::leak(Box::new(table)))
    }

    fn tabulate(interface: Interface, anisotropic: Option<Ggx>) -> Self {
        // Total reflection makes many more bends.
        let rule = if interface.critical() > 0.0 { Rule::new::<12, 24>() } else { Rule::new::<12, 16>() };
        let n_mu = if interface.critical() > 0.0 { 2 * N_MU } else { N_MU };
        let place = |mu: f32, alpha: f32| abscissa(interface, mu, alpha);
        let grid = nodes([n_mu, n_alpha(interface)], place, anisotropic, |mu, phi, alpha, a| {
            pack(interface, interface.integrate(&rule, mu, phi, a), mu, alpha)
        });
        let grid = grid.refined(REFINED);
        let means = means(anisotropic, |row, alpha| mean_over_cosine(interface, &grid, row, alpha));
        let means = means.into_iter().map(pack_mean).collect();
        let kind = anisotropic.map_or(Kind::Isotropic, Kind::Pair);
        Self { interface, kind, moments: OnceLock::new(), grid, means }
    }
}

/// A grid whose nodes are functions of μ, azimuth, the roughness that it meets, and α. `place` says where μ stands.
pub(super) fn nodes<T: Value>(
    [n_mu, n_alpha]: [usize; 2],
    place: impl Fn(f32, f32) -> f32 + Sync,
    anisotropic: Option<Ggx>,
    f: impl Fn(f32, f64, f32, [f32; 2]) -> T + Sync,
) -> Grid<T> {
    let node = |i: usize, phi: f64, alpha: f32, a: [f32; 2]| {
        f(invert(i as f32 / (n_mu - 1) as f32, |mu| place(mu, alpha)), phi, alpha, a)
    };
    match anisotropic {
        None => Grid::tabulate(n_mu, n_alpha, |i, j| {
            let alpha = alpha_of(j as f32 / (n_alpha - 1) as f32);
            node(i, 0.0, alpha, [alpha; 2])
        }),
        Some(ggx) => {
            let at = |phi: f64| azimuth(ggx, Vec3::new(phi.cos() as f32, phi.sin() as f32, 0.0));
            Grid::tabulate(n_mu, N_AZIMUTH, |i, j| {
                // The azimuth of the j-th node.
                let phi = match j {
                    0 => 0.0,
                    _ if j + 1 == N_AZIMUTH => FRAC_PI_2,
                    _ => {
                        let place = j as f32 / (N_AZIMUTH - 1) as f32;
                        f64::from(invert(place, |t| at(f64::from(t) * FRAC_PI_2).1)) * FRAC_PI_2
                    }
                };
                node(i, phi, at(phi).0, [ggx.ax, ggx.ay])
            })
        }
    }
}

/// Means over the hemisphere, of those over μ in a row at a roughness: at equidistant ln α, or one over the azimuth.
pub(super) fn means<const K: usize>(anisotropic: Option<Ggx>, row: impl Fn(f32, f32) -> [f64; K]) -> Vec<[f64; K]> {
    let Some(ggx) = anisotropic else {
        let mean = |k| {
            let alpha = alpha_of(k as f32 / (N_MEANS - 1) as f32);
            row(log_alpha(alpha), alpha)
        };
        return (0..N_MEANS).map(mean).collect();
    };
    // Midpoints in the stretched azimuth t, where the interpolant is smooth: dφ = αφ²/(αx αy) dt.
    const N: usize = 128;
    let mut sum = [0.0; K];
    for j in 0..N {
        let (sin, cos) = ((j as f64 + 0.5) / N as f64 * FRAC_PI_2).sin_cos();
        let phi = (sin / f64::from(ggx.ay)).atan2(cos / f64::from(ggx.ax));
        let (alpha, t) = azimuth(ggx, Vec3::new(phi.cos() as f32, phi.sin() as f32, 0.0));
        let mean = row(t, alpha);
        let weight = f64::from(alpha).powi(2) / (f64::from(ggx.ax) * f64::from(ggx.ay) * N as f64);
        sum = std::array::from_fn(|k| sum[k] + weight * mean[k]);
    }
    vec![sum]
}

/// Place of an α among the means.
pub(super) fn mean_row(alpha: f32) -> Stencil {
    Stencil::new(log_alpha(alpha), N_MEANS)
}

/// Grid values vary slowly where energies do not: the loss is divided by its rough shape, and what the macroscopic
/// surface would do is taken away from the parts.
fn pack(interface: Interface, e: Energy, mu: f32, alpha: f32) -> Vec4 {
    let [a, b] = interface.smooth_parts(mu);
    let kept = 1.0 - e.loss;
    Vec4::new(e.loss / shape(mu, alpha), e.parts[0] - kept * a, e.parts[1] - kept * b, 0.0)
}

#[inline]
pub(super) fn unpack(interface: Interface, v: Vec4, mu: f32, alpha: f32) -> Energy {
    let loss = (v.x * shape(mu, alpha)).clamp(0.0, 1.0);
    let kept = 1.0 - loss;
    let [a, b] = interface.smooth_parts(mu);
    Energy { loss, parts: [(kept * a + v.y).clamp(0.0, kept), (kept * b + v.z).max(0.0)] }
}

fn pack_mean([loss, a, b]: [f64; 3]) -> Vec4 {
    Vec4::new(loss.max(1e-30).ln() as f32, a as f32, b as f32, 0.0)
}

#[inline]
pub(super) fn unpack_mean(v: Vec4) -> Energy {
    Energy { loss: v.x.exp(), parts: [v.y, v.z] }
}

/// 2 ∫ e(μ) μ dμ of the interpolant.
fn mean_over_cosine(interface: Interface, grid: &Grid<Vec4>, row: f32, alpha: f32) -> [f64; 3] {
    over_cosine(interface, alpha, |mu| {
        let e = unpack(interface, grid.between(abscissa(interface, mu, alpha), row), mu, alpha);
        [e.loss, e.parts[0], e.parts[1]]
    })
}

/// 2 ∫ f(μ) μ dμ of what varies as energies do.
pub(super) fn over_cosine<const K: usize>(interface: Interface, alpha: f32, f: impl Fn(f32) -> [f32; K]) -> [f64; K] {
    // In the scale of the abscissa, on either side of the critical angle: graded panels of four nodes.
    let rule = gauss_legendre::<4>();
    let alpha = f64::from(alpha);
    let critical = f64::from(interface.critical());
    const PANELS: usize = 128;
    let mut sum = [0.0; K];
    let mut integrate = |from: f64, to: f64| {
        // μ = from ± α sinh t.
        let end = ((to - from).abs() / alpha).asinh();
        for panel in 0..PANELS {
            for (x, w) in rule {
                let t = (panel as f64 + x) / PANELS as f64 * end;
                let mu = from + (alpha * t.sinh()).copysign(to - from);
                let weight = 2.0 * mu * alpha * t.cosh() * w * end / PANELS as f64;
                for (sum, e) in sum.iter_mut().zip(f(mu as f32)) {
                    *sum += weight * f64::from(e);
                }
            }
        }
    };
    if critical > 0.0 {
        integrate(0.0, 0.5 * critical);
        integrate(critical, 0.5 * critical);
    }
    integrate(critical, 1.0);
    sum
}

#[cfg(test)]
mod tests {
    use super::super::at::EnergyAt;
    use super::*;

    #[test]
    fn normal_incidence_on_unit_roughness_is_known() {
        let loss = EnergyAt::new(Interface::Mirror, Ggx { ax: 1.0, ay: 1.0 }).at(Vec3::Z).loss;
        assert!((loss - (1.0 - (1.0 - 2f32.ln()))).abs() < 1e-6, "{loss}");
    }

    /// The tables against the converged quadrature, between their nodes.
    #[test]
    fn interpolation_costs_little() {
        let rule = Rule::new::<20, 32>();
        let eta = |eta| Interface::Dielectric { eta };
        for (interface, bound) in
            [(Interface::Mirror, 1.5e-4), (Interface::BeckmannMirror, 1.5e-4), (eta(1.5), 3e-4), (eta(1.0 / 1.5), 2e-4)]
        {
            let start = std::time::Instant::now();
            EnergyTable::isotropic(interface);
            let elapsed = start.elapsed();
            let mut worst = [0.0f32; 3];
            for j in 0..=31 {
                let alpha = 10f32.powf(-4.0 + j as f32 * (4.0 / 31.0));

                let critical = (-10..=10).map(|i| interface.critical() + alpha * i as f32);
                let mus = (1..=30).map(|i| (i as f32 / 30.0).powi(4)).chain(critical);
                for mu in mus.filter(|mu| (1e-7..=1.0).contains(mu)) {
                    let exact = interface.integrate(&rule, mu, 0.0, [alpha, alpha]);
                    let e = EnergyTable::isotropic(interface).energy(mu, alpha, log_alpha(alpha));
                    let pairs = [(e.loss, exact.loss), (e.parts[0], exact.parts[0]), (e.parts[1], exact.parts[1])];
                    worst = std::array::from_fn(|k| worst[k].max((pairs[k].0 - pairs[k].1).abs()));
                }
            }
            println!("{interface:?}: tabulated in {elapsed:.0?}, worst errors {worst:?}");
            assert!(worst[0] < bound, "{interface:?}: {worst:?}");
        }
    }

    #[test]
    fn anisotropic_tables_contain_the_isotropic_ones() {
        // Nearly equal roughnesses take the other road.
        let near = EnergyAt::new(Interface::Mirror, Ggx { ax: 0.3, ay: 0.3001 });
        let same = EnergyAt::new(Interface::Mirror, Ggx { ax: 0.3, ay: 0.3 });
        for i in 1..20 {
            let mu = i as f32 / 20.0;
            let r = (1.0 - mu * mu).sqrt();
            let (a, b) = (near.at(Vec3::new(r * 0.8, r * 0.6, mu)), same.at(Vec3::new(r, 0.0, mu)));
            assert!((a.loss - b.loss).abs() < 2e-4, "{mu}: {a:?} {b:?}");
        }
        assert!((near.mean().loss - same.mean().loss).abs() < 2e-4);
    }

    /// Likewise over the azimuth, between whose nodes roughness changes.
    #[test]
    fn anisotropic_interpolation_costs_little() {
        let rule = Rule::new::<12, 24>();
        let glass = Interface::Dielectric { eta: 1.0 / 1.5 };
        for (interface, alpha, bound) in [(Interface::Mirror, [0.05, 0.4], 2e-4), (glass, [0.1, 0.5], 3e-4)] {
            let slice = EnergyAt::new(interface, Ggx { ax: alpha[0], ay: alpha[1] });
            let mut worst = 0f32;
            for (i, mu) in [0.02f32, 0.1, 0.3, 0.5, 0.8].into_iter().enumerate() {
                for j in 0..16 {
                    let phi = FRAC_PI_2 * (f64::from(j) + 0.1 * (1.0 + i as f64)) / 16.0;
                    let r = (1.0 - mu * mu).sqrt();
                    let loss = slice.at(Vec3::new(r * phi.cos() as f32, r * phi.sin() as f32, mu)).loss;
                    let exact = interface.integrate(&rule, mu, phi, alpha).loss;
                    worst = worst.max((loss - exact).abs());
                }
            }
            assert!(worst < bound, "{interface:?} {alpha:?}: {worst:e}");
        }
    }
}
