//! What lies over lobes and dims them: a clear coat, sheen.
//!
//! A layer of directional albedo c E(w) lets 1 − c E(w) =: T(w) through towards w. Of several layers one upon another, the
//! product of theirs is what counts, T = ∏ Tₗ. What lies beneath is scaled by a function of both directions, in one of two
//! ways; both are reciprocal, and neither makes light.
//!
//! **The minimum**, for any lobe:
//!
//! ```text
//! f = f_base(o, i) min(T(o), T(i))
//! ```
//!
//! Its albedo is at most T(o) times that of the base, and with the layer's own c E(o) the whole stays below
//! c E(o) + 1 − c E(o) = 1. (The rule of KHR_materials_sheen; Kulla & Conty 2017 scale by T(o) alone, which is not
//! reciprocal.) Where the base mirrors, T(o) = T(i) and nothing is lost; where it scatters widely, the mean of T over the
//! hemisphere is less than T(o), and some is lost. Of a white base that scatters evenly it is ∫ (T(o) − T(i))⁺ cos θi dωi/π,
//! at most T(n) − ⟨T⟩ along the normal n: 4.6 % of what arrives under a coat of index 1.5, 14.5 % under white sheen.
//!
//! **The product**, for a diffuse base, itself perhaps beneath the specular coat of its material that transmits t(w)
//! ([`CoupledDiffuse`](super::CoupledDiffuse)):
//!
//! ```text
//! f = ρ/π T(o) t(o) T(i) t(i) / ⟨T t⟩,    ⟨T t⟩ = (1/π) ∫ T(i) t(i) cos θi dωi
//! ```
//!
//! Its albedo is ρ T(o) t(o): a white base under any number of layers loses nothing. A layer may have a normal of its own.
//! Then T is turned and ⟨T t⟩ is kept: as T and t cos θ both grow with the height over their horizons, no turn makes the
//! true mean larger (Hardy, Littlewood & Pólya 1934, theorem 378), so the albedo is at most ρ T(o) t(o).

use super::energy::EnergyAt;
use super::fresnel::pow5;
use super::multiple_scattering;
use super::sheen::SheenAlbedo;
use crate::spectrum::Spectrum;
use glam::Vec3;

/// Something thin over the lobes of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Layer {
    /// Its normal, local, unit; where there is none it is the shading normal.
    normal: Option<Vec3>,
    /// Share of the surface that it covers, or for sheen its brightest colour.
    factor: f32,
    albedo: Albedo,
}

/// E(w) of a layer that covers all.
#[derive(Clone, Copy, Debug)]
enum Albedo {
    Smooth { f0: f32 },
    Rough { f0: f32, f_ms: f32, energy: EnergyAt },
    Sheen(SheenAlbedo),
}

impl Layer {
    /// A colourless specular coat that reflects `f0` at normal incidence and covers the share `factor`: of this
    /// microsurface, or smooth; with the normal `normal` where it is not that of the surface.
    pub fn coat(factor: f32, f0: f32, energy: Option<EnergyAt>, normal: Option<Vec3>) -> Self {
        let albedo = match energy {
            None => Albedo::Smooth { f0 },
            Some(energy) => {
                let average = Spectrum::splat(f0 + (1.0 - f0) / 21.0);
                Albedo::Rough { f0, f_ms: multiple_scattering(average, energy.mean_loss()).0.x, energy }
            }
        };
        Self { normal, factor, albedo }
    }

    /// Sheen whose brightest colour is `factor`.
    pub fn sheen(factor: f32, albedo: SheenAlbedo) -> Self {
        Self { normal: None, factor, albedo: Albedo::Sheen(albedo) }
    }

    /// T(w), in [0, 1].
    #[inline]
    pub fn transmitted(&self, w: Vec3) -> f32 {
        self.transmitted_at(self.normal.map_or(w.z, |n| n.dot(w)).abs().min(1.0))
    }

    /// T at the cosine `mu` ≥ 0 to the normal of the layer.
    #[inline]
    pub(super) fn transmitted_at(&self, mu: f32) -> f32 {
        let albedo = match &self.albedo {
            Albedo::Smooth { f0 } => f0 + (1.0 - f0) * pow5(1.0 - mu),
            Albedo::Rough { f0, f_ms, energy } => {
                let e = energy.at(Vec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu));
                f0 * (1.0 - e.loss - e.parts[0]) + e.parts[0] + f_ms * e.loss
            }
            Albedo::Sheen(sheen) => sheen.at(mu),
        };
        (1.0 - self.factor * albedo).clamp(0.0, 1.0)
    }
}

/// Nodes and weights of (1/π) ∫ g(w) cos θ dω for g of the height μ alone: Gauss–Legendre on s = √μ, where albedos are
/// polynomials or nearly so (Abramowitz & Stegun 25.4.29, eight nodes).
const NODES: [(f32, f32); 8] = [
    (0.019_855_072, 0.050_614_268),
    (0.101_666_76, 0.111_190_52),
    (0.237_233_8, 0.156_853_32),
    (0.408_282_68, 0.181_341_9),
    (0.591_717_3, 0.181_341_9),
    (0.762_766_2, 0.156_853_32),
    (0.898_333_24, 0.111_190_52),
    (0.980_144_9, 0.050_614_268),
];

/// (1/π) ∫ g(w) cos θ dω over the hemisphere, of g that depends on the azimuth where `anisotropic`.
pub(super) fn mean<T>(anisotropic: bool, g: impl Fn(Vec3) -> T) -> T
where
    T: std::ops::Mul<f32, Output = T> + std::iter::Sum,
{
    // By symmetry a quarter of the circle is enough.
    let azimuths: &[f32] = if anisotropic {
        &[0.098_174_77, 0.294_524_3, 0.490_873_85, 0.687_223_4, 0.883_572_93, 1.079_922_5, 1.276_272, 1.472_621_6]
    } else {
        &[0.0]
    };
    let term = |(&phi, (s, weight)): (&f32, (f32, f32))| {
        let mu = s * s;
        let (sin, cos) = phi.sin_cos();
        let r = (1.0 - mu * mu).sqrt();
        // dμ = 2 s ds.
        g(Vec3::new(r * cos, r * sin, mu)) * (weight * 4.0 * s * mu / azimuths.len() as f32)
    };
    azimuths.iter().flat_map(|phi| NODES.map(|node| (phi, node))).map(term).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::{Ggx, Interface};

    /// T(n) − ⟨T⟩.
    #[test]
    fn what_the_minimum_loses_at_most() {
        let lost = |layer: Layer| layer.transmitted_at(1.0) - mean(false, |w| layer.transmitted_at(w.z));
        let coat = lost(Layer::coat(1.0, 0.04, None, None));
        assert!((coat - 0.96 / 21.0).abs() < 1e-5, "{coat}");
        let sheen: Vec<f32> = (1..=10).map(|i| lost(Layer::sheen(1.0, SheenAlbedo::new(i as f32 / 10.0)))).collect();
        println!("{sheen:?}");
        assert!(sheen.iter().all(|lost| (0.0..0.145).contains(lost)), "{sheen:?}");
    }

    #[test]
    fn the_mean_is_the_mean() {
        assert!((mean(false, |_| 1.0) - 1.0).abs() < 1e-6);
        assert!((mean(false, |w| (1.0 - w.z).powi(5)) - 1.0 / 21.0).abs() < 1e-6);
        let slice = EnergyAt::new(Interface::Mirror, Ggx { ax: 0.3, ay: 0.3 });
        assert!((mean(false, |w| slice.at(w).loss) - slice.mean_loss()).abs() < 1e-4);
        let slice = EnergyAt::new(Interface::Mirror, Ggx { ax: 0.6, ay: 0.1 });
        assert!((mean(true, |w| slice.at(w).loss) - slice.mean_loss()).abs() < 2e-4);
    }
}
