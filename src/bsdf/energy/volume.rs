//! Energies of dielectric interfaces over direction, roughness and index, as data.
//!
//! Interfaces of any quotient of indices meet in a scene: nested media have one for each pair, dispersive ones for each
//! wavelength. So the index is an axis of the table, and none is made while anything is traced: the nodes lie in
//! `into_denser.bin` and `into_thinner.bin`, which a test writes and another holds against the quadrature. With n ≥ 1 the
//! larger index over the smaller one, the axis is
//!
//! ```text
//! y = ln(t/t_min) / ln(t_max/t_min),    t = (n − 1)/(n + 1)
//! ```
//!
//! on which the critical angle, cos² θc = 1 − 1/n² ≈ 4t, moves evenly towards the horizon. It ends at n = 1.002, below which
//! there is no interface to speak of, and at n = 4, beyond which energies are those of n = 4.

use super::axes::{Axis, alpha_of, asinh, shape};
use super::grid::Stencil;
use super::interface::{Energy, Interface};
use crate::math::safe_sqrt;
use std::sync::LazyLock;

/// Nodes in μ of the side that sees a denser medium, and of the one that sees a thinner one, where there is a critical angle.
const N_MU: [usize; 2] = [48, 80];
/// Nodes in ln α and in y.
const N_ALPHA: usize = 32;
const N_INDEX: usize = 24;
/// Lines between nodes take the place of cubics where there are this many times as many.
const REFINED: usize = 3;
const ROWS: usize = (N_ALPHA - 1) * REFINED + 1;
const LAYERS: usize = (N_INDEX - 1) * REFINED + 1;
/// t of n = 1.002, and ln(t_max/t_min) for n = 4.
const T_MIN: f32 = 1e-3;
const RANGE: f32 = 6.396_93;

/// Energies as one side of an interface sees them.
#[derive(Debug)]
pub(super) struct Volume {
    n_mu: usize,
    /// (loss, transmitted), as [`pack`] has them, over μ, α and index.
    nodes: Vec<[f32; 2]>,
    /// ln of the mean loss over the hemisphere, at the nodes of the file.
    means: Vec<f32>,
}

/// Place y of an index in \[0, 1\].
#[inline]
pub(super) fn layer(eta: f32) -> f32 {
    let n = eta.max(1.0 / eta);
    (((n - 1.0) / (n + 1.0) * (1.0 / T_MIN)).max(1.0).ln() * (1.0 / RANGE)).min(1.0)
}

/// n ≥ 1 at the place y.
fn index(layer: f32) -> f32 {
    let t = T_MIN * (layer * RANGE).exp();
    (1.0 + t) / (1.0 - t)
}

/// Cosine of the critical angle on the denser side.
#[inline]
pub(super) fn critical(eta: f32) -> f32 {
    let thin = eta.min(1.0 / eta);
    safe_sqrt((1.0 - thin) * (1.0 + thin))
}

/// What is kept at a node: on the side without a critical angle the loss is divided by its rough shape, and what a smooth
/// interface would transmit is taken away, so that values vary slowly.
fn pack(eta: f32, e: Energy, mu: f32, alpha: f32) -> [f32; 2] {
    if eta < 1.0 {
        return [e.loss, e.parts[0]];
    }
    let [smooth, _] = Interface::Dielectric { eta }.smooth_parts(mu);
    [e.loss / shape(mu, alpha), e.parts[0] - (1.0 - e.loss) * smooth]
}

/// Both sides: of index η ≥ 1, and of η < 1.
#[inline]
pub(super) fn volumes() -> &'static [Volume; 2] {
    static VOLUMES: LazyLock<[Volume; 2]> = LazyLock::new(|| [0, 1].map(|side| Volume::read(side, &mut numbers(side))));
    &VOLUMES
}

/// For each side. Of its nodes, index by index, α by α: √loss and √transmitted in units of 1/65535; then, likewise, the means
/// over the hemisphere, √mean.
const DATA: [&[u8]; 2] = [include_bytes!("into_denser.bin"), include_bytes!("into_thinner.bin")];

/// The numbers in a side's file.
fn numbers(side: usize) -> impl Iterator<Item = u16> {
    DATA[side].chunks_exact(2).map(|c| u16::from_le_bytes([c[0], c[1]]))
}

fn decode(x: u16) -> f32 {
    let root = f32::from(x) / 65535.0;
    root * root
}

impl Volume {
    fn read(side: usize, data: &mut impl Iterator<Item = u16>) -> Self {
        let n_mu = N_MU[side];
        let mut next = || decode(data.next().unwrap_or(0));
        let mut coarse = Vec::with_capacity(N_INDEX * N_ALPHA * n_mu);
        for (k, j, i) in places(n_mu) {
            let [loss, transmitted] = [next(), next()];
            let e = Energy { loss, parts: [transmitted, 0.0] };
            let alpha = alpha_of(place(j, N_ALPHA));
            // The place of the node in μ matters to one side alone, and there it has a closed form.
            let x = place(i, n_mu);
            let mu = (alpha * (x * x * asinh(1.0 / alpha)).sinh()).min(1.0);
            let n = index(place(k, N_INDEX));
            coarse.push(pack(if side == 0 { n } else { 1.0 / n }, e, mu, alpha));
        }
        let means = (0..N_INDEX * N_ALPHA).map(|_| next().max(1e-12).ln()).collect();
        Self { n_mu, nodes: refined(&coarse, n_mu), means }
    }

    /// Energy at the cosine `mu`, for an interface of roughness `alpha` and index `eta`, whose places and axis are given.
    #[inline]
    pub(super) fn at(&self, mu: f32, alpha: f32, eta: f32, row: f32, layer: f32, axis: &Axis) -> Energy {
        let x = Stencil::new(if eta < 1.0 { axis.at(mu) } else { axis.without_critical(mu) }, self.n_mu);
        let (j, row) = split(row, ROWS);
        let (k, layer) = split(layer, LAYERS);
        let line = |j: usize, k: usize| {
            let nodes = &self.nodes[(k * ROWS + j) * self.n_mu + x.first()..][..4];
            (0..4).fold([0.0; 2], |sum: [f32; 2], i| {
                let w = x.weight(i);
                [sum[0] + nodes[i][0] * w, sum[1] + nodes[i][1] * w]
            })
        };
        let lerp = |a: [f32; 2], b: [f32; 2], t: f32| [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];
        let lower = lerp(line(j, k), line(j + 1, k), row);
        let upper = lerp(line(j, k + 1), line(j + 1, k + 1), row);
        let [loss, transmitted] = lerp(lower, upper, layer);
        if eta < 1.0 {
            let loss = loss.clamp(0.0, 1.0);
            return Energy { loss, parts: [transmitted.clamp(0.0, 1.0 - loss), 0.0] };
        }
        let loss = (loss * shape(mu, alpha)).clamp(0.0, 1.0);
        let [smooth, _] = Interface::Dielectric { eta }.smooth_parts(mu);
        Energy { loss, parts: [((1.0 - loss) * smooth + transmitted).clamp(0.0, 1.0 - loss), 0.0] }
    }

    /// Mean loss over the hemisphere.
    pub(super) fn mean_loss(&self, row: f32, layer: f32) -> f32 {
        let (j, k) = (Stencil::new(row, N_ALPHA), Stencil::new(layer, N_INDEX));
        let of = |l: usize| j.over(&self.means[(k.first() + l) * N_ALPHA..][..N_ALPHA]) * k.weight(l);
        (0..4).map(of).sum::<f32>().exp()
    }
}

/// The interval of a place in \[0, 1\] among `n` nodes, and how far it is in it.
#[inline]
fn split(place: f32, n: usize) -> (usize, f32) {
    let t = place.clamp(0.0, 1.0) * (n - 1) as f32;
    let i = (t as usize).min(n - 2);
    (i, t - i as f32)
}

fn place(i: usize, n: usize) -> f32 {
    i as f32 / (n - 1) as f32
}

/// Nodes in the order of the file: index, α, μ.
fn places(n_mu: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..N_INDEX * N_ALPHA * n_mu).map(move |at| (at / n_mu / N_ALPHA, at / n_mu % N_ALPHA, at % n_mu))
}

/// The cubics through the nodes in α and index at more nodes.
fn refined(coarse: &[[f32; 2]], n_mu: usize) -> Vec<[f32; 2]> {
    let blend = |stencil: &Stencil, of: &dyn Fn(usize) -> [f32; 2]| {
        (0..4).fold([0.0; 2], |sum: [f32; 2], l| {
            let (v, w) = (of(stencil.first() + l), stencil.weight(l));
            [sum[0] + v[0] * w, sum[1] + v[1] * w]
        })
    };
    let rows: Vec<Stencil> = (0..ROWS).map(|j| Stencil::new(place(j, ROWS), N_ALPHA)).collect();
    let mut finer = Vec::with_capacity(N_INDEX * ROWS * n_mu);
    for k in 0..N_INDEX {
        for row in &rows {
            finer.extend((0..n_mu).map(|i| blend(row, &|j| coarse[(k * N_ALPHA + j) * n_mu + i])));
        }
    }
    let mut nodes = Vec::with_capacity(LAYERS * ROWS * n_mu);
    for k in 0..LAYERS {
        let layer = Stencil::new(place(k, LAYERS), N_INDEX);
        nodes.extend((0..ROWS * n_mu).map(|i| blend(&layer, &|k| finer[k * ROWS * n_mu + i])));
    }
    nodes
}

#[cfg(test)]
mod tests {
    use super::super::axes::invert;
    use super::super::quadrature::Rule;
    use super::super::table::over_cosine;
    use super::*;
    use rayon::prelude::*;

    /// μ, α and η of a node.
    fn node(side: usize, (k, j, i): (usize, usize, usize)) -> (f32, f32, f32) {
        let (alpha, n) = (alpha_of(place(j, N_ALPHA)), index(place(k, N_INDEX)));
        let axis = Axis::critical(critical(n), alpha);
        let at = |mu| if side == 0 { axis.without_critical(mu) } else { axis.at(mu) };
        (invert(place(i, N_MU[side]), at), alpha, if side == 0 { n } else { 1.0 / n })
    }

    fn exact(rule: &Rule, (mu, alpha, eta): (f32, f32, f32)) -> Energy {
        Interface::Dielectric { eta }.integrate(rule, mu, 0.0, [alpha; 2])
    }

    fn encode(x: f32) -> u16 {
        (x.clamp(0.0, 1.0).sqrt() * 65535.0).round() as u16
    }

    /// Writes the files: `cargo test --profile faults --lib volume -- --ignored`.
    #[test]
    #[ignore = "writes src/bsdf/energy/into_*.bin anew: half a minute"]
    fn write() {
        for (side, name) in ["into_denser.bin", "into_thinner.bin"].into_iter().enumerate() {
            let mut file: Vec<u16> = Vec::new();
            let rule = if side == 0 { Rule::new::<12, 16>() } else { Rule::new::<12, 24>() };
            let all: Vec<_> = places(N_MU[side]).collect();
            let energies: Vec<Energy> = all.par_iter().map(|&at| exact(&rule, node(side, at))).collect();
            file.extend(energies.iter().flat_map(|e| [encode(e.loss), encode(e.parts[0])]));
            // The means belong to the interpolant.
            let mut data = energies.iter().flat_map(|e| [encode(e.loss), encode(e.parts[0])]);
            let volume = Volume::read(side, &mut data);
            let mean = |at: usize| {
                let (j, k) = (at % N_ALPHA, at / N_ALPHA);
                let (alpha, n) = (alpha_of(place(j, N_ALPHA)), index(place(k, N_INDEX)));
                let eta = if side == 0 { n } else { 1.0 / n };
                let axis = Axis::critical(critical(eta), alpha);
                let loss = |mu| [volume.at(mu, alpha, eta, place(j, N_ALPHA), place(k, N_INDEX), &axis).loss];
                over_cosine(Interface::Dielectric { eta }, alpha, loss)[0] as f32
            };
            file.extend((0..N_INDEX * N_ALPHA).map(|at| encode(mean(at))));
            let bytes: Vec<u8> = file.iter().flat_map(|x| x.to_le_bytes()).collect();
            let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/bsdf/energy");
            std::fs::write(folder.join(name), bytes).unwrap();
        }
    }

    /// The files are what the quadrature says, at nodes of every kind.
    #[test]
    fn the_files_are_the_quadrature() {
        assert_eq!(DATA.map(<[u8]>::len), N_MU.map(|n| 4 * N_INDEX * N_ALPHA * n + 2 * N_INDEX * N_ALPHA));
        for (side, n_mu) in N_MU.into_iter().enumerate() {
            let (rule, mut data) = (Rule::new::<12, 24>(), numbers(side));
            for (number, at) in places(n_mu).enumerate() {
                let [loss, transmitted] = [(); 2].map(|()| decode(data.next().unwrap()));
                if number % 397 == 0 {
                    let e = exact(&rule, node(side, at));
                    let off = (loss - e.loss).abs().max((transmitted - e.parts[0]).abs());
                    assert!(off < 1e-4, "{side} {at:?}: {loss} {transmitted}, {e:?}");
                }
            }
        }
    }

    /// Between the nodes as well, for indices and roughnesses of any kind.
    #[test]
    fn interpolation_costs_little() {
        let rule = Rule::new::<12, 24>();
        let cases: Vec<(f32, f32)> = [1.004f32, 1.02, 1.1, 1.33, 1.5, 1.77, 2.42, 3.3]
            .into_iter()
            .flat_map(|n| [n, 1.0 / n])
            .flat_map(|eta| [3e-4f32, 4e-3, 0.03, 0.11, 0.27, 0.52, 0.9].map(|alpha| (eta, alpha)))
            .collect();
        let worst: Vec<[f32; 2]> = cases
            .par_iter()
            .map(|&(eta, alpha)| {
                let energy = super::super::DielectricEnergy::isotropic(alpha, eta);
                let c = if eta < 1.0 { critical(eta) } else { 0.0 };
                let near = (-4..=4).map(|i| c + alpha * 1.3 * i as f32);
                let mus =
                    (1..=12).map(|i| (i as f32 / 12.2).powi(3)).chain(near).filter(|mu| (1e-6..=1.0).contains(mu));
                mus.fold([0f32; 2], |worst, mu| {
                    let exact = exact(&rule, (mu, alpha, eta));
                    let e = energy.at(glam::Vec3::new((1.0 - mu * mu).sqrt(), 0.0, mu));
                    [worst[0].max((e.loss - exact.loss).abs()), worst[1].max((e.parts[0] - exact.parts[0]).abs())]
                })
            })
            .collect();
        for ((eta, alpha), worst) in cases.iter().zip(&worst) {
            println!("η {eta:.4} α {alpha}: {worst:?}");
        }
        let [loss, transmitted] = [0, 1].map(|k| worst.iter().map(|w| w[k]).fold(0f32, f32::max));
        // What is transmitted serves estimates alone: energy is kept by what is lost.
        assert!(loss < 2.5e-3 && transmitted < 6e-2, "{loss:e} {transmitted:e}");
        let usual =
            cases.iter().zip(&worst).filter(|((eta, _), _)| (0.4..=2.5).contains(eta) && (eta - 1.0).abs() > 0.01);
        let usual = usual.map(|(_, worst)| worst[0]).fold(0f32, f32::max);
        assert!(usual < 1.1e-3, "{usual:e}");
    }
}
