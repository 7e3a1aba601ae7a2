//! Energy of single scattering in one direction, for the two interfaces that microfacets can be.

use super::quadrature::Rule;
use crate::bsdf::angular::{TERMS, polynomials};
use crate::bsdf::fresnel::{dielectric, pow5};
use crate::math::safe_sqrt;
use glam::{DVec3, Vec4};
use statrs::function::erf::erfc;
use std::f64::consts::PI;

/// What a microfacet is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Interface {
    /// Reflects; the Fresnel term comes later, by its powers.
    Mirror,
    /// Reflects as a mirror whose microfacet normals follow Beckmann's distribution.
    BeckmannMirror,
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
            Self::Mirror | Self::BeckmannMirror => {
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
            Self::Mirror | Self::BeckmannMirror => 0.0,
            Self::Dielectric { eta } => safe_sqrt((1.0 - eta) * (1.0 + eta)),
        }
    }

    /// Energy in the direction of cosine `mu` and azimuth `phi`, as a mean over the visible normals m
    /// (Heitz 2014, section 5.3).
    pub(super) fn integrate(self, rule: &Rule, mu: f32, phi: f64, alpha: [f32; 2]) -> Energy {
        let seen = Seen::new(self, mu, phi, alpha);
        let [loss, a, b] = match self {
            Self::Mirror | Self::BeckmannMirror => {
                seen.mirrored(rule, |c, w, lost| [lost, w * (1.0 - c).powi(5), w * c * (1.0 - c).powi(6)])
            }
            Self::Dielectric { eta } => seen.refracted(rule, eta.into(), |_, f, lost_r, w, lost_t| {
                [f * lost_r + (1.0 - f) * lost_t, (1.0 - f) * w, 0.0]
            }),
        };
        Energy { loss: loss as f32, parts: [a as f32, b as f32] }
    }

    /// Energy that single scattering loses at a dielectric whose facets have another reflectance than Fresnel's.
    pub(super) fn by_reflectance(self, rule: &Rule, mu: f32, alpha: f32) -> ByReflectance {
        let Self::Dielectric { eta } = self else { return ByReflectance([0.0; COSINES + 1]) };
        let eta = f64::from(eta);
        // Snell, from the denser side: cos² outside = 1 − (1 − c²)/η².
        let outside = |c: f64| if eta < 1.0 { (1.0 - (1.0 - c * c) / (eta * eta)).max(0.0).sqrt() } else { c };
        let seen = Seen::new(self, mu, 0.0, [alpha; 2]);
        ByReflectance(seen.refracted(rule, eta, |c, f, lost_r, w, lost_t| {
            let mut parts = [0.0; COSINES + 1];
            if f >= 1.0 && w <= 0.0 {
                // Nothing is refracted: all of it is reflected, whatever R.
                parts[COSINES] = lost_r;
                return parts;
            }
            let x = outside(c) * (COSINES - 1) as f64;
            let k = (x as usize).min(COSINES - 2);
            let t = x - k as f64;
            (parts[k], parts[k + 1]) = ((1.0 - t) * (lost_r - lost_t), t * (lost_r - lost_t));
            parts[COSINES] = lost_t;
            parts
        }))
    }

    /// Energy of single scattering whose facets reflect T_j(2√c − 1), for every j ([`crate::bsdf::Angular`]).
    pub(super) fn moments(self, rule: &Rule, mu: f32, phi: f64, alpha: [f32; 2]) -> [f64; TERMS] {
        Seen::new(self, mu, phi, alpha).mirrored(rule, |c, w, _| polynomials(c).map(|t| w * t))
    }
}

/// Values of a reflectance R, at equidistant cosines of the angle outside, between which it is linear.
pub(super) const COSINES: usize = 65;

/// Energy that single scattering loses towards a direction at facets of any reflectance R, which it is linear in:
/// ∫ D_o(m) (R lost_r + (1 − R) lost_t) dm = Σ_k R_k w_k + w_∞.
#[derive(Clone, Copy, Debug)]
pub(super) struct ByReflectance([f64; COSINES + 1]);

impl ByReflectance {
    /// The loss, by lanes, with this reflectance.
    pub(super) fn loss(&self, reflectance: &[Vec4; COSINES]) -> Vec4 {
        let [weights @ .., rest] = &self.0;
        reflectance.iter().zip(weights).fold(Vec4::splat(*rest as f32), |sum, (r, w)| sum + *r * *w as f32)
    }
}

/// A direction that looks at a microsurface.
struct Seen {
    o: DVec3,
    a: [f64; 2],
    /// s(o).
    so: f64,
    /// Λ(o) where normals are Beckmann's.
    beckmann: Option<f64>,
}

impl Seen {
    fn new(interface: Interface, mu: f32, phi: f64, alpha: [f32; 2]) -> Self {
        let mu = f64::from(mu).max(1e-9);
        let r = (1.0 - mu * mu).max(0.0).sqrt();
        let (o, a) = (DVec3::new(r * phi.cos(), r * phi.sin(), mu), alpha.map(f64::from));
        let beckmann = (interface == Interface::BeckmannMirror).then(|| beckmann_lambda(o, a));
        Self { o, a, so: stretch(o, a), beckmann }
    }

    fn reflected(o: DVec3, m: DVec3) -> DVec3 {
        m * (2.0 * o.dot(m)) - o
    }

    /// A direction i of reflection or refraction, of height `z` on its own side, leaves with probability
    /// w = G₂/G₁(o) = |i.z|(o.z + s(o)) / (s(o)|i.z| + s(i) o.z), and never on the other side. Returns w and 1 − w.
    fn kept_and_lost(&self, i: DVec3, z: f64) -> (f64, f64) {
        if z <= 0.0 {
            return (0.0, 1.0);
        }
        let si = stretch(i, self.a);
        let d = self.so * z + si * self.o.z;
        (z * (self.o.z + self.so) / d, self.o.z * (si - z) / d)
    }

    /// Mean over visible normals of g(c, F, 1 − w_r, w_t, 1 − w_t), c the cosine at the normal, F its reflectance, and w_r and
    /// w_t the probabilities that what it reflects and what it refracts leaves; (c, 1, 1 − w_r, 0, 0) where nothing is
    /// refracted.
    fn refracted<const C: usize>(
        &self,
        rule: &Rule,
        eta: f64,
        g: impl Fn(f64, f64, f64, f64, f64) -> [f64; C],
    ) -> [f64; C] {
        let o = self.o;
        // η cos θt, squared; and the refracted direction.
        let inside = |c: f64| (eta - 1.0) * (eta + 1.0) + c * c;
        let refracted = |m: DVec3, c: f64, root: f64| (m * (c - root) - o) / eta;
        rule.visible_mean(
            o,
            self.a,
            |m| {
                let c = o.dot(m);
                let g2 = inside(c);
                [Self::reflected(o, m).z, g2, -refracted(m, c, g2.max(0.0).sqrt()).z]
            },
            |m| {
                let c = o.dot(m).clamp(0.0, 1.0);
                let i = Self::reflected(o, m);
                let (_, lost_r) = self.kept_and_lost(i, i.z);
                let g2 = inside(c);
                if g2 <= 0.0 {
                    return g(c, 1.0, lost_r, 0.0, 0.0);
                }
                let root = g2.sqrt();
                let (rs, rp) = ((c - root) / (c + root), (eta * eta * c - root) / (eta * eta * c + root));
                let t = refracted(m, c, root);
                let (w, lost_t) = self.kept_and_lost(t, -t.z);
                g(c, 0.5 * (rs * rs + rp * rp), lost_r, w, lost_t)
            },
        )
    }

    /// Mean over visible normals of g(c, w, 1 − w), c the cosine at the normal and w the probability that what it reflects
    /// leaves.
    fn mirrored<const C: usize>(&self, rule: &Rule, g: impl Fn(f64, f64, f64) -> [f64; C]) -> [f64; C] {
        let height = |m: DVec3| [Self::reflected(self.o, m).z];
        rule.visible_mean(self.o, self.a, height, |m| {
            let (i, c) = (Self::reflected(self.o, m), self.o.dot(m).clamp(0.0, 1.0));
            match self.beckmann {
                None => {
                    let (w, lost) = self.kept_and_lost(i, i.z);
                    g(c, w, lost)
                }
                Some(lambda_o) => {
                    let lambda_i = if i.z > 0.0 { beckmann_lambda(i, self.a) } else { f64::INFINITY };
                    let w = (1.0 + lambda_o) / (1.0 + lambda_o + lambda_i);
                    g(c, w, 1.0 - w).map(|x| x * self.beckmann_over_ggx(lambda_o, m))
                }
            }
        })
    }

    /// Density of Beckmann's visible normals over that of GGX of the same α.
    fn beckmann_over_ggx(&self, lambda_o: f64, m: DVec3) -> f64 {
        let t2 = ((m.x / self.a[0]).powi(2) + (m.y / self.a[1]).powi(2)) / (m.z * m.z).max(1e-300);
        let masking = (self.o.z + self.so) / (2.0 * self.o.z * (1.0 + lambda_o));
        // With t the tangent of the stretched normal, D is e^(−t²) in place of 1/(1 + t²)².
        if t2 < 700.0 { masking * (-t2).exp() * (1.0 + t2).powi(2) } else { 0.0 }
    }
}

/// Λ of Beckmann's microsurface (Heitz 2014, eq. 72).
fn beckmann_lambda(w: DVec3, a: [f64; 2]) -> f64 {
    let slope = (a[0] * w.x).hypot(a[1] * w.y);
    let x = w.z / slope;
    if slope == 0.0 || x > 5.0 {
        return 0.0;
    }
    0.5 * ((-x * x).exp() / (x * PI.sqrt()) - erfc(x))
}

fn stretch(w: DVec3, a: [f64; 2]) -> f64 {
    DVec3::new(a[0] * w.x, a[1] * w.y, w.z).length()
}
