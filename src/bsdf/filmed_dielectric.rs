//! Interface between dielectrics under a thin film, smooth or rough: what the film does not reflect is refracted.

use super::Transport;
use super::fresnel::{dielectric, refract};
use super::ggx::{Ggx, half_vector, reflect};
use super::smooth::{Delta, refraction_scale, relative_eta};
use super::thin_film::ThinFilm;
use crate::spectrum::Spectrum;
use glam::{Vec3, Vec4};

/// What both have. A lossless film reflects alike from either side, at angles that Snell's law joins (Stokes 1849); light
/// that is totally reflected inside does not see it.
#[derive(Clone, Copy, Debug)]
pub struct FilmedDielectric {
    /// Index of the inside (behind the normal) over the outside, at least 1.
    pub eta: f32,
    /// Factor on transmitted light.
    pub tint: Spectrum,
    /// The film.
    pub film: ThinFilm,
    /// Share of the surface that is under it; the rest is bare.
    pub share: f32,
}

/// GGX reflection and refraction (Walter et al. 2007, eqs. 20 and 21), single scattering alone: what bounces twice between
/// facets is lost, for it would have to be known for every film.
#[derive(Clone, Copy, Debug)]
pub struct RoughFilmedDielectric {
    /// The microsurface.
    pub ggx: Ggx,
    /// Its facets.
    pub facet: FilmedDielectric,
}

impl FilmedDielectric {
    /// Reflectance by lanes and the cosine of the refracted angle, for light of cosine `cos` ≥ 0 that crosses `eta`.
    #[inline]
    fn reflectance(&self, cos: f32, eta: f32) -> (Spectrum, f32) {
        let (bare, cos_t) = dielectric(cos, eta);
        if cos_t == 0.0 {
            return (Spectrum::splat(bare), cos_t);
        }
        let outside = if eta == self.eta { cos } else { cos_t };
        let root = ((self.eta - 1.0) / (self.eta + 1.0)).max(0.0);
        let filmed = self.film.reflectance(outside, Vec4::splat(root));
        (Spectrum::lerp(Spectrum::splat(bare), filmed, self.share), cos_t)
    }

    /// The mirrored and, below the critical angle, the refracted direction.
    #[inline]
    pub(super) fn deltas(&self, wo: Vec3, mode: Transport) -> [Option<Delta>; 2] {
        let (eta, cos) = (relative_eta(self.eta, wo), wo.z.abs().min(1.0));
        let (f, cos_t) = self.reflectance(cos, eta);
        let p = mean(f);
        let reflected = Delta { wi: Vec3::new(-wo.x, -wo.y, wo.z), weight: f, probability: p, eta: 1.0 };
        let wi = refract(wo, Vec3::new(0.0, 0.0, 1f32.copysign(wo.z)), cos, cos_t, eta);
        let weight = self.tint * (Spectrum::ONE - f) * refraction_scale(eta, mode);
        let refracted = Delta { wi, weight, probability: 1.0 - p, eta };
        [Some(reflected).filter(|_| p > 0.0), Some(refracted).filter(|d| p < 1.0 && d.wi.z * wo.z < 0.0)]
    }

    /// Directional albedo R + (1 − R) tint.
    #[inline]
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        let (f, _) = self.reflectance(wo.z.abs().min(1.0), relative_eta(self.eta, wo));
        f + self.tint * (Spectrum::ONE - f)
    }
}

/// Probability of a reflection: where a lane reflects, and where one transmits, it is neither 0 nor 1.
#[inline]
fn mean(f: Spectrum) -> f32 {
    (f.0.x + f.0.y + f.0.z) / 3.0
}

impl RoughFilmedDielectric {
    /// f \[1/sr\] and density \[1/sr\] of `wi`.
    #[inline]
    pub(super) fn eval(&self, wo: Vec3, wi: Vec3, mode: Transport) -> (Spectrum, f32) {
        let (facet, ggx) = (&self.facet, &self.ggx);
        let eta = relative_eta(facet.eta, wo);
        // Seen from the side of wo.
        let flip = Vec3::new(1.0, 1.0, 1f32.copysign(wo.z));
        let (o, i) = (wo * flip, wi * flip);
        if i.z > 0.0 {
            let (h, cos) = half_vector(o, i);
            let (f, _) = facet.reflectance(cos, eta);
            let pdf = mean(f) * 0.25 * ggx.visible_over_cosine(o, h);
            return (f * (0.25 * ggx.d(h) * ggx.g2_over_cosines(o, i)), pdf);
        }
        // The normal that refracts o to i; there is none unless they are on opposite sides of it.
        let h = o + i * eta;
        let length = h.length().max(f32::MIN_POSITIVE);
        let h = h * (1f32.copysign(h.z) / length);
        let (oh, ih) = (o.dot(h), i.dot(h));
        if oh <= 0.0 || ih >= 0.0 {
            return (Spectrum::ZERO, 0.0);
        }
        let (f, _) = facet.reflectance(oh.min(1.0), eta);
        // |dh/di| = η² |i·h| / (o·h + η i·h)², whose denominator is |o + η i|².
        let jacobian = oh * eta * eta * -ih / (length * length);
        let through = facet.tint * (Spectrum::ONE - f) * refraction_scale(eta, mode);
        let pdf = (1.0 - mean(f)) * ggx.visible_over_cosine(o, h) * jacobian;
        (through * (jacobian * ggx.d(h) * ggx.g2_over_cosines(o, i)), pdf)
    }

    /// Draws `wi`, reflected or refracted at a visible normal, and says which η it crossed.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2]) -> Option<(Vec3, f32)> {
        let eta = relative_eta(self.facet.eta, wo);
        let flip = Vec3::new(1.0, 1.0, 1f32.copysign(wo.z));
        let o = wo * flip;
        let m = self.ggx.sample_visible(o, u);
        let cos = o.dot(m).clamp(0.0, 1.0);
        let (f, cos_t) = self.facet.reflectance(cos, eta);
        if uc < mean(f) {
            let i = reflect(o, m).normalize();
            return (i.z > 0.0).then_some((i * flip, 1.0));
        }
        let i = refract(o, m, cos, cos_t, eta);
        (i.z < 0.0).then_some((i * flip, eta))
    }

    /// Directional albedo, as if smooth.
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        self.facet.albedo(wo)
    }
}
