//! The energy of a rough interface under a thin film, lane by lane.
//!
//! A film changes which share of the light is reflected at a microfacet, R(c) in place of Fresnel's F(c), and with it the
//! energy that single scattering loses,
//!
//! ```text
//! loss(o) = ∫ D_o(m) (R(c) lost_r(m) + (1 − R(c)) lost_t(m)) dm,    c = o·m
//! ```
//!
//! Films are too many for one table, so each material has its own, made when it is compiled: over μ, and over roughness and
//! thickness where they vary over the surface. The loss is linear in R, so that one quadrature serves all thicknesses.

use super::axes::{Axis, alpha_of, invert, log_alpha};
use super::dielectric::DielectricEnergy;
use super::grid::Stencil;
use super::interface::{ByReflectance, COSINES, Interface};
use super::quadrature::Rule;
use super::table::over_cosine;
use super::volume;
use crate::bsdf::ThinFilm;
use crate::spectrum::Spectrum;
use glam::{Vec3, Vec4};
use rayon::prelude::*;

/// Nodes in μ of the side that sees a denser medium, and of the one that sees a thinner one.
const N_MU: [usize; 2] = [40, 64];
/// Nodes in ln α where roughness varies.
const N_ALPHA: usize = 10;
/// Step in thickness \[nm\] where it varies, less than a tenth of a fringe, and most nodes.
const STEP: f32 = 25.0;
const MOST: usize = 64;

/// Energies that single scattering loses under a film that covers everything.
#[derive(Debug)]
pub struct FilmedEnergy {
    eta: f32,
    alphas: Nodes,
    thicknesses: Nodes,
    /// From outside and from inside, over thickness, α and μ.
    sides: [Vec<Vec4>; 2],
    /// Their means over the hemisphere, over thickness and α.
    means: [Vec<Vec4>; 2],
}

/// Equidistant nodes from one number to another; one, where they are the same.
#[derive(Clone, Copy, Debug)]
struct Nodes {
    from: f32,
    to: f32,
    n: usize,
}

impl Nodes {
    fn new([from, to]: [f32; 2], n: usize) -> Self {
        Self { from, to, n: if to > from { n.max(2) } else { 1 } }
    }

    fn at(&self, i: usize) -> f32 {
        if self.n == 1 { self.from } else { self.from + (self.to - self.from) * i as f32 / (self.n - 1) as f32 }
    }

    /// The node before `x`, the one behind it, and how far it is between them.
    #[inline]
    fn place(&self, x: f32) -> (usize, usize, f32) {
        if self.n == 1 {
            return (0, 0, 0.0);
        }
        let t = ((x - self.from) / (self.to - self.from)).clamp(0.0, 1.0) * (self.n - 1) as f32;
        let i = (t as usize).min(self.n - 2);
        (i, i + 1, t - i as f32)
    }
}

/// η as the side sees it.
fn seen(eta: f32, side: usize) -> f32 {
    if side == 0 { eta } else { 1.0 / eta }
}

impl FilmedEnergy {
    /// Of an interface of index `eta` ≥ 1, inside over outside, for roughness and thickness within these bounds under a film
    /// of index `film`.
    pub fn new(eta: f32, alpha: [f32; 2], film: f32, thickness: [f32; 2]) -> Self {
        let alphas = Nodes::new(alpha.map(log_alpha), N_ALPHA);
        let steps = ((thickness[1] - thickness[0]) / STEP).clamp(0.0, (MOST - 1) as f32) as usize;
        let thicknesses = Nodes::new(thickness, steps + 2);
        let rule = if alphas.n == 1 { Rule::new::<12, 16>() } else { Rule::new::<6, 8>() };
        let root = Vec4::splat((eta - 1.0) / (eta + 1.0));
        let reflectance = |k: usize| {
            let film = ThinFilm { eta: film, thickness: thicknesses.at(k) };
            std::array::from_fn(|i| {
                let [x, y, z, _] = film.reflectance(i as f32 / (COSINES - 1) as f32, root).0.to_array();
                Vec4::new(x, y, z, y)
            })
        };
        let reflectances: Vec<[Vec4; COSINES]> = (0..thicknesses.n).map(reflectance).collect();
        let mut new = Self { eta, alphas, thicknesses, sides: [vec![], vec![]], means: [vec![], vec![]] };
        for side in 0..2 {
            // What microfacets let pass knows of no film: it is integrated once for all of them.
            let node = |at: usize| {
                let (i, j) = (at % N_MU[side], at / N_MU[side]);
                let alpha = alpha_of(alphas.at(j));
                let axis = new.axis(alpha);
                let mu = invert(i as f32 / (N_MU[side] - 1) as f32, |mu| new.abscissa(side, &axis, mu));
                Interface::Dielectric { eta: seen(eta, side) }.by_reflectance(&rule, mu, alpha)
            };
            let nodes: Vec<ByReflectance> = (0..N_MU[side] * alphas.n).into_par_iter().map(node).collect();
            new.sides[side] = reflectances.iter().flat_map(|r| nodes.iter().map(|node| node.loss(r))).collect();
            let mean = |at: usize| {
                let alpha = alpha_of(alphas.at(at % alphas.n));
                let axis = new.axis(alpha);
                let of = |mu| new.line(side, &axis, mu, at).truncate().to_array();
                let [r, g, b] = over_cosine(Interface::Dielectric { eta: seen(eta, side) }, alpha, of);
                Vec4::new(r as f32, g as f32, b as f32, g as f32)
            };
            new.means[side] = (0..alphas.n * thicknesses.n).into_par_iter().map(mean).collect::<Vec<Vec4>>();
        }
        new
    }

    fn axis(&self, alpha: f32) -> Axis {
        Axis::critical(volume::critical(self.eta), alpha)
    }

    fn abscissa(&self, side: usize, axis: &Axis, mu: f32) -> f32 {
        if side == 0 { axis.without_critical(mu) } else { axis.at(mu) }
    }

    /// Value at the cosine `mu` in the line `at` of nodes.
    fn line(&self, side: usize, axis: &Axis, mu: f32, at: usize) -> Vec4 {
        let n = N_MU[side];
        Stencil::new(self.abscissa(side, axis, mu), n).over(&self.sides[side][at * n..][..n])
    }

    /// Of the four lines about a roughness and a thickness.
    fn between(&self, alpha: f32, thickness: f32, line: impl Fn(usize) -> Vec4) -> Spectrum {
        let (j0, j1, row) = self.alphas.place(log_alpha(alpha));
        let (k0, k1, layer) = self.thicknesses.place(thickness);
        let at = |k: usize| line(k * self.alphas.n + j0).lerp(line(k * self.alphas.n + j1), row);
        Spectrum(at(k0).lerp(at(k1), layer).clamp(Vec4::ZERO, Vec4::ONE))
    }

    /// Loss towards `w`, where the share `share` of the interface is under a film of this thickness. What the bare interface
    /// loses is in `bare`; at another index than the table's, the film changes it as it does at that.
    pub fn loss(&self, bare: &DielectricEnergy, w: Vec3, thickness: f32, share: f32) -> Spectrum {
        let (side, alpha) = (usize::from(w.z <= 0.0), bare.ggx().ax);
        let own = self.own(bare);
        let filmed = self.between(alpha, thickness, |at| self.line(side, &self.axis(alpha), w.z.abs().min(1.0), at));
        let (here, there) = (bare.at(w).loss, own.at(w).loss);
        Spectrum((Vec4::splat(here) + (filmed.0 - Vec4::splat(there)) * share).clamp(Vec4::ZERO, Vec4::ONE))
    }

    /// Its means over the hemisphere, outside and inside.
    pub fn mean_loss(&self, bare: &DielectricEnergy, thickness: f32, share: f32) -> [Spectrum; 2] {
        let own = self.own(bare).mean_loss();
        [0, 1].map(|side| {
            let filmed = self.between(bare.ggx().ax, thickness, |at| self.means[side][at]);
            let mean = Vec4::splat(bare.mean_loss()[side]) + (filmed.0 - Vec4::splat(own[side])) * share;
            Spectrum(mean.clamp(Vec4::splat(1e-9), Vec4::ONE))
        })
    }

    /// The bare interface of the table's index.
    fn own(&self, bare: &DielectricEnergy) -> DielectricEnergy {
        if bare.eta() == self.eta { *bare } else { DielectricEnergy::isotropic(bare.ggx().ax, self.eta) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table over roughness and thickness against those made for one film each, on the nodes and between them.
    #[test]
    fn one_quadrature_serves_all_films() {
        let (eta, film) = (1.5, 1.8);
        let many = FilmedEnergy::new(eta, [0.2, 0.8], film, [100.0, 700.0]);
        for (alpha, thickness, tolerance) in [(0.2, 100.0, 1e-3), (0.8, 700.0, 1e-3), (0.47, 333.0, 3e-3)] {
            let one = FilmedEnergy::new(eta, [alpha; 2], film, [thickness; 2]);
            let bare = DielectricEnergy::isotropic(alpha, eta);
            for z in [0.05f32, 0.3, 0.7, 1.0, -0.05, -0.5, -0.7, -0.76, -1.0] {
                let w = Vec3::new((1.0 - z * z).sqrt(), 0.0, z);
                let [a, b] = [&many, &one].map(|table| table.loss(&bare, w, thickness, 1.0).0.truncate());
                assert!(a.abs_diff_eq(b, tolerance), "α {alpha}, {thickness} nm, μ {z}: {a} {b}");
            }
            let [a, b] = [&many, &one].map(|table| table.mean_loss(&bare, thickness, 1.0).map(|m| m.0.truncate()));
            assert!(a[0].abs_diff_eq(b[0], tolerance) && a[1].abs_diff_eq(b[1], tolerance), "{a:?} {b:?}");
        }
    }
}
