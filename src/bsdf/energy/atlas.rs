//! One table for every pair of roughnesses: energies where αx and αy vary over a surface.

use super::axes::{abscissa, alpha_of, azimuth, invert, shape};
use super::grid::{Grid, Stencil};
use super::interface::{Energy, Interface};
use super::mean::over_hemisphere;
use super::quadrature::Rule;
use crate::bsdf::ggx::Ggx;
use glam::{Vec3, Vec4};
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Nodes in μ, azimuth, the larger α (its fourth root) and the root of the quotient of the smaller and the larger.
const NODES: [usize; 4] = [24, 16, 12, 7];

/// Energies of a mirroring microsurface over μ, azimuth and both roughnesses, in four dimensions.
///
/// Coarser than the tables of one pair: the loss is right to 3·10⁻³ of all energy, which a test holds; the parts likewise,
/// but for directions almost in the surface across grooves much finer than they are wide (1.5·10⁻²). It takes about as long
/// as ten of those tables, once, and a look-up costs sixteen of theirs.
#[derive(Debug)]
pub(super) struct Atlas {
    /// μ and azimuth; one for each pair of roughnesses.
    grids: Grid<Vec4>,
    /// (ln loss, parts) averaged over the hemisphere.
    means: Vec<Vec4>,
}

/// A pair of roughnesses among the nodes of the atlas.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    /// In the larger α, and in the quotient.
    stencils: [Stencil; 2],
    /// The larger α lies along y.
    swapped: bool,
}

impl Pair {
    pub(super) fn new(ggx: Ggx) -> Self {
        let (large, small) = (ggx.ax.max(ggx.ay), ggx.ax.min(ggx.ay));
        let stencils = [Stencil::new(large.sqrt().sqrt(), NODES[2]), Stencil::new((small / large).sqrt(), NODES[3])];
        Self { stencils, swapped: ggx.ay > ggx.ax }
    }
}

/// The pair of roughnesses at a node; the larger one along x.
fn roughness(i: usize, j: usize) -> Ggx {
    let large = (i as f32 / (NODES[2] - 1) as f32).powi(4).max(alpha_of(0.0));
    let quotient = (j as f32 / (NODES[3] - 1) as f32).powi(2);
    Ggx { ax: large, ay: (large * quotient).max(alpha_of(0.0)) }
}

impl Atlas {
    pub(super) fn tabulate() -> Self {
        let rule = Rule::new::<8, 8>();
        let [n_mu, n_azimuth, n_large, n_quotient] = NODES;
        let grids = Grid::tabulate(n_mu, n_azimuth * n_large * n_quotient, |i, rest| {
            let (j, pair) = (rest % n_azimuth, rest / n_azimuth);
            let ggx = roughness(pair % n_large, pair / n_large);
            let at = |phi: f64| azimuth(ggx, Vec3::new(phi.cos() as f32, phi.sin() as f32, 0.0));
            let phi = match j {
                0 => 0.0,
                _ if j + 1 == n_azimuth => FRAC_PI_2,
                _ => {
                    let place = j as f32 / (n_azimuth - 1) as f32;
                    f64::from(invert(place, |t| at(f64::from(t) * FRAC_PI_2).1)) * FRAC_PI_2
                }
            };
            let alpha = at(phi).0;
            let mu = invert(i as f32 / (n_mu - 1) as f32, |mu| abscissa(Interface::Mirror, mu, alpha));
            let e = Interface::Mirror.integrate(&rule, mu, phi, [ggx.ax, ggx.ay]);
            let [a, b] = Interface::Mirror.smooth_parts(mu);
            let kept = 1.0 - e.loss;
            Vec4::new(e.loss / shape(mu, ggx.ax), e.parts[0] - kept * a, e.parts[1] - kept * b, 0.0)
        });
        let mut atlas = Self { grids, means: Vec::new() };
        atlas.means = (0..n_large * n_quotient)
            .into_par_iter()
            .map(|pair| {
                let ggx = roughness(pair % n_large, pair / n_large);
                let pair = Pair::new(ggx);
                let [loss, a, b] = over_hemisphere(ggx, |w| atlas.at(ggx, &pair, w));
                Vec4::new(loss.max(1e-30).ln() as f32, a as f32, b as f32, 0.0)
            })
            .collect();
        atlas
    }

    /// Σ over the sixteen neighbouring pairs of roughnesses.
    #[inline]
    fn over_pairs(pair: &Pair, value: impl Fn(usize) -> Vec4) -> Vec4 {
        let [large, quotient] = &pair.stencils;
        let mut sum = Vec4::ZERO;
        for j in 0..4 {
            let mut row = Vec4::ZERO;
            for i in 0..4 {
                row += value((quotient.first() + j) * NODES[2] + large.first() + i) * large.weight(i);
            }
            sum += row * quotient.weight(j);
        }
        sum
    }

    /// Mean energy over the hemisphere.
    pub(super) fn mean(&self, pair: &Pair) -> Energy {
        let v = Self::over_pairs(pair, |index| self.means[index]);
        Energy { loss: v.x.exp(), parts: [v.y, v.z] }
    }

    /// Energy of the direction `w`, on either side.
    pub(super) fn at(&self, ggx: Ggx, pair: &Pair, w: Vec3) -> Energy {
        let mu = w.z.abs().min(1.0);
        let (ggx, w) = if pair.swapped { (Ggx { ax: ggx.ay, ay: ggx.ax }, Vec3::new(w.y, w.x, w.z)) } else { (ggx, w) };
        let (alpha, place) = azimuth(ggx, w);
        let (x, y) = (Stencil::new(abscissa(Interface::Mirror, mu, alpha), NODES[0]), Stencil::new(place, NODES[1]));
        let v = Self::over_pairs(pair, |index| self.grids.with(x, y.shifted(index * NODES[1])));
        let loss = (v.x * shape(mu, ggx.ax)).clamp(0.0, 1.0);
        let kept = 1.0 - loss;
        let [a, b] = Interface::Mirror.smooth_parts(mu);
        Energy { loss, parts: [(kept * a + v.y).clamp(0.0, kept), (kept * b + v.z).max(0.0)] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The atlas against the quadrature, between its nodes.
    #[test]
    fn interpolation_costs_little() {
        let start = std::time::Instant::now();
        let (atlas, rule) = (&Atlas::tabulate(), Rule::new::<12, 24>());
        println!("tabulated in {:.0?}", start.elapsed());
        let (mut worst, mut parts) = (0f32, 0f32);
        for (i, alpha) in [0.003f32, 0.02, 0.1, 0.3, 0.7].into_iter().enumerate() {
            for strength in [0.2f32, 0.5, 0.77, 1.0] {
                let ggx = Ggx { ax: alpha + (1.0 - alpha) * strength * strength, ay: alpha };
                let pair = Pair::new(ggx);
                for mu in [0.01f32, 0.1, 0.35, 0.6, 0.95] {
                    for k in 0..6 {
                        let phi = FRAC_PI_2 * (f64::from(k) + 0.15 * i as f64) / 5.6;
                        let r = (1.0 - mu * mu).sqrt();
                        let w = Vec3::new(r * phi.cos() as f32, r * phi.sin() as f32, mu);
                        let (e, exact) =
                            (atlas.at(ggx, &pair, w), Interface::Mirror.integrate(&rule, mu, phi, [ggx.ax, ggx.ay]));
                        worst = worst.max((e.loss - exact.loss).abs());
                        parts = parts.max((e.parts[0] - exact.parts[0]).abs());
                        // Turned by 90°.
                        let turned = Ggx { ax: ggx.ay, ay: ggx.ax };
                        let same = atlas.at(turned, &Pair::new(turned), Vec3::new(w.y, w.x, w.z));
                        assert!((same.loss - e.loss).abs() < 1e-6);
                    }
                }
            }
        }
        let pair = Ggx { ax: 0.4, ay: 0.05 };
        let own = crate::bsdf::EnergyAt::new(Interface::Mirror, pair).mean();
        let mean = atlas.mean(&Pair::new(pair));
        assert!((own.loss - mean.loss).abs() < 1e-3 * own.loss, "{own:?} {mean:?}");
        println!("worst {worst:e}, parts {parts:e}");
        assert!(worst < 3e-3 && parts < 1.5e-2, "{worst:e} {parts:e}");
    }
}
