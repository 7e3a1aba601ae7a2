//! Energy of single scattering in one direction, for the two interfaces that microfacets can be.

use super::quadrature::Rule;
use crate::bsdf::fresnel::{dielectric, pow5};
use crate::math::safe_sqrt;
use glam::DVec3;

/// What a microfacet is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Interface {
    /// Reflects; the Fresnel term comes later, by its powers.
    Mirror,
    /// Reflects or refracts, exactly.
    Dielectric {
        /// Relative index η_t/η_i, seen from the side that the direction is on.
        eta: f32,
    },
}

/// Energy in one direction, or its cosine-weighted mean over the hemisphere.
#[derive(Clone, Copy, Debug, Default)]
pub struct Energy {
    /// 1 − E: the share of the energy that single scattering loses.
    pub loss: f32,
    /// Mirror: ∫ (1 − c)⁵ over the lobe, c the cosine at the microfacet, and ∫ c(1 − c)⁶. With the terms of
    /// [`crate::bsdf::Fresnel::fit`], the albedo is F₀ (1 − loss − parts₀) + F₉₀ parts₀ − k parts₁.
    /// Dielectric: the share that single scattering transmits, and 0.
    pub parts: [f32; 2],
}

impl Interface {
    /// The two parts on a smooth surface, where they are smooth functions of μ.
    #[inline]
    pub(super) fn smooth_parts(self, mu: f32) -> [f32; 2] {
        match self {
            Self::Mirror => {
                let schlick = pow5(1.0 - mu);
                [schlick, schlick * mu * (1.0 - mu)]
            }
            Self::Dielectric { eta } if eta > 1.0 => [1.0 - dielectric(mu, eta).0, 0.0],
            Self::Dielectric { .. } => [0.0, 0.0],
        }
    }

    /// Cosine of the critical angle where there is one, else 0.
    #[inline]
    pub(super) fn critical(self) -> f32 {
        match self {
            Self::Mirror => 0.0,
            Self::Dielectric { eta } => safe_sqrt((1.0 - eta) * (1.0 + eta)),
        }
    }

    /// Energy in the direction of cosine `mu` and azimuth `phi`, as a mean over the visible normals m
    /// (Heitz 2014, section 5.3).
    ///
    /// A direction i of reflection or refraction at m leaves with probability
    /// w = G₂/G₁(o) = |i.z|(o.z + s(o)) / (s(o)|i.z| + s(i) o.z) on its own side of the surface, and never on the other.
    pub(super) fn integrate(self, rule: &Rule, mu: f32, phi: f64, alpha: [f32; 2]) -> Energy {
        let mu = f64::from(mu).max(1e-9);
        let r = (1.0 - mu * mu).max(0.0).sqrt();
        let o = DVec3::new(r * phi.cos(), r * phi.sin(), mu);
        let a = alpha.map(f64::from);
        let stretch = |w: DVec3| DVec3::new(a[0] * w.x, a[1] * w.y, w.z).length();
        let so = stretch(o);
        let kept_and_lost = |i: DVec3, z: f64| {
            if z <= 0.0 {
                return (0.0, 1.0);
            }
            let si = stretch(i);
            let d = so * z + si * o.z;
            (z * (o.z + so) / d, o.z * (si - z) / d)
        };
        let reflected = |m: DVec3, c: f64| m * (2.0 * c) - o;

        let [loss, a, b] = match self {
            Self::Mirror => rule.visible_mean(
                o,
                a,
                |m| [reflected(m, o.dot(m)).z],
                |m| {
                    let c = o.dot(m).clamp(0.0, 1.0);
                    let i = reflected(m, c);
                    let (w, lost) = kept_and_lost(i, i.z);
                    [lost, w * (1.0 - c).powi(5), w * c * (1.0 - c).powi(6)]
                },
            ),
            Self::Dielectric { eta } => {
                let eta = f64::from(eta);
                // η cos θt, squared; and the height of the refracted direction.
                let inside = |c: f64| (eta - 1.0) * (eta + 1.0) + c * c;
                let refracted = |m: DVec3, c: f64, g: f64| (m * (c - g) - o) / eta;
                rule.visible_mean(
                    o,
                    a,
                    |m| {
                        let c = o.dot(m);
                        let g2 = inside(c);
                        [reflected(m, c).z, g2, -refracted(m, c, g2.max(0.0).sqrt()).z]
                    },
                    |m| {
                        let c = o.dot(m).clamp(0.0, 1.0);
                        let i = reflected(m, c);
                        let (_, lost_r) = kept_and_lost(i, i.z);
                        let g2 = inside(c);
                        if g2 <= 0.0 {
                            return [lost_r, 0.0, 0.0];
                        }
                        let g = g2.sqrt();
                        let (rs, rp) = ((c - g) / (c + g), (eta * eta * c - g) / (eta * eta * c + g));
                        let f = 0.5 * (rs * rs + rp * rp);
                        let t = refracted(m, c, g);
                        let (w, lost_t) = kept_and_lost(t, -t.z);
                        [f * lost_r + (1.0 - f) * lost_t, (1.0 - f) * w, 0.0]
                    },
                )
            }
        };
        Energy { loss: loss as f32, parts: [a as f32, b as f32] }
    }
}
