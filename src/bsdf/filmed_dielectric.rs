//! Interface between dielectrics under a thin film, smooth or rough: what the film does not reflect is refracted.

use super::Transport;
use super::angular::Angular;
use super::energy::{DielectricEnergy, FilmedEnergy};
use super::fresnel::{dielectric, refract};
use super::ggx::{Ggx, MIN_ALPHA, half_vector, reflect};
use super::lobe::Aspect;
use super::rough_dielectric::shares;
use super::smooth::{Delta, refraction_scale, relative_eta};
use super::thin_film::ThinFilm;
use crate::spectrum::Spectrum;
use glam::{Vec3, Vec4};
use std::f32::consts::FRAC_1_PI;
use std::sync::Arc;

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

/// GGX reflection and refraction (Walter et al. 2007, eqs. 20 and 21) with the multiply scattered rest, as
/// [`super::RoughDielectric`] has it, lane by lane. Of two roughnesses what bounces twice between facets is lost.
#[derive(Clone, Debug)]
pub struct RoughFilmedDielectric {
    ggx: Ggx,
    facet: FilmedDielectric,
    bare: DielectricEnergy,
    /// What the film changes of it.
    filmed: Option<Arc<FilmedEnergy>>,
    /// Energy lost on the mean over the hemisphere, and the share of it that crosses, from outside and from inside.
    mean_loss: [Spectrum; 2],
    transmitted: [Spectrum; 2],
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

impl FilmedDielectric {
    /// About the directional albedo, as if there were no film.
    #[inline]
    pub(super) fn estimate(&self, w: Vec3) -> Spectrum {
        let (f, _) = dielectric(w.z.abs().min(1.0), relative_eta(self.eta, w));
        Spectrum::lerp(self.tint, Spectrum::ONE, f)
    }
}

/// Probability of a reflection: where a lane reflects, and where one transmits, it is neither 0 nor 1.
#[inline]
fn mean(f: Spectrum) -> f32 {
    (f.0.x + f.0.y + f.0.z) / 3.0
}

impl RoughFilmedDielectric {
    /// Facets of roughness α along x and y; `energy` is that of their film, of this roughness and thickness.
    pub fn new(alpha: [f32; 2], facet: FilmedDielectric, energy: &Arc<FilmedEnergy>) -> Self {
        let [ax, ay] = alpha.map(|a| a.clamp(MIN_ALPHA, 1.0));
        let bare = DielectricEnergy::isotropic(ax, facet.eta);
        let filmed = (ax == ay).then(|| energy.clone());
        let mean_loss = energy.mean_loss(&bare, facet.film.thickness, facet.share);
        let crosses = Spectrum::ONE - Angular::new(|cos| facet.reflectance(cos, facet.eta).0).average();
        let lanes = [0, 1, 2, 3].map(|lane| {
            let loss = mean_loss.map(|side| side.0[lane]);
            shares(facet.eta, loss, crosses.0[lane].clamp(0.0, 1.0))
        });
        let transmitted = [0, 1].map(|side| Spectrum(Vec4::from_array(lanes.map(|lane| lane[side]))));
        Self { ggx: Ggx { ax, ay }, facet, bare, filmed, mean_loss, transmitted }
    }

    pub(super) fn is_anisotropic(&self) -> bool {
        self.ggx.ax != self.ggx.ay
    }

    /// What is asked again and again of the direction `w`.
    pub(super) fn aspect(&self, w: Vec3) -> Aspect {
        let FilmedDielectric { film, share, .. } = self.facet;
        let loss = match &self.filmed {
            Some(filmed) => filmed.loss(&self.bare, w, film.thickness, share),
            None => Spectrum::ZERO,
        };
        Aspect { through: loss, multiple: mean(loss), ..Aspect::of(self.facet.estimate(w)) }
    }

    /// f \[1/sr\], and the densities \[1/sr\] of `wi` and, seen from there, of `wo`.
    pub(super) fn eval(&self, [wo, wi]: [Vec3; 2], [e_o, e_i]: [&Aspect; 2], mode: Transport) -> (Spectrum, f32, f32) {
        let (facet, ggx) = (&self.facet, &self.ggx);
        let eta = relative_eta(facet.eta, wo);
        let (here, there) = (side(wo), side(wi));
        // Seen from the side of wo.
        let flip = Vec3::new(1.0, 1.0, 1f32.copysign(wo.z));
        let (o, i) = (wo * flip, wi * flip);
        let again = e_o.through * e_i.through.div_or_zero(self.mean_loss[there]) * FRAC_1_PI;
        let multiple = [e_o.multiple * self.bare.pdf(i.z.abs()), e_i.multiple * self.bare.pdf(o.z)];
        let [crosses_here, crosses_there] = [here, there].map(|side| self.transmitted[side]);
        if i.z > 0.0 {
            let (h, cos) = half_vector(o, i);
            let (f, _) = facet.reflectance(cos, eta);
            let visible = |w, q: f32| (1.0 - q) * mean(f) * 0.25 * ggx.visible_over_cosine(w, h);
            let stays = 1.0 - mean(crosses_here);
            let pdf = visible(o, e_o.multiple) + multiple[0] * stays;
            let pdf_rev = visible(i, e_i.multiple) + multiple[1] * stays;
            let single = f * (0.25 * ggx.d(h) * ggx.g2_over_cosines(o, i));
            return (single + (Spectrum::ONE - crosses_here) * again, pdf, pdf_rev);
        }
        let (mut f, mut pdf, mut pdf_rev) =
            (crosses_here * again, multiple[0] * mean(crosses_here), multiple[1] * mean(crosses_there));
        // The normal that refracts o to i; there is none unless they are on opposite sides of it.
        let h = o + i * eta;
        let length = h.length().max(f32::MIN_POSITIVE);
        let h = h * (1f32.copysign(h.z) / length);
        let (oh, ih) = (o.dot(h), i.dot(h));
        if oh > 0.0 && ih < 0.0 {
            let (reflected, _) = facet.reflectance(oh.min(1.0), eta);
            // |dh/di| = η² |i·h| / (o·h + η i·h)², whose denominator is |o + η i|²; |dh/do| is o·h over it.
            let back = oh * -ih / (length * length);
            let jacobian = back * eta * eta;
            let through = 1.0 - mean(reflected);
            f += (Spectrum::ONE - reflected) * (jacobian * ggx.d(h) * ggx.g2_over_cosines(o, i));
            pdf += (1.0 - e_o.multiple) * through * ggx.visible_over_cosine(o, h) * jacobian;
            pdf_rev += (1.0 - e_i.multiple) * through * ggx.visible_over_cosine(i, h) * back;
        }
        (facet.tint * f * refraction_scale(eta, mode), pdf, pdf_rev)
    }

    /// Draws `wi`, the multiply scattered part, or reflected or refracted at a visible normal, and says which η it crossed.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, aspect: &Aspect, uc: f32, u: [f32; 2]) -> Option<(Vec3, f32)> {
        let eta = relative_eta(self.facet.eta, wo);
        let flip = Vec3::new(1.0, 1.0, 1f32.copysign(wo.z));
        let (o, q) = (wo * flip, aspect.multiple);
        if uc < q {
            let crosses = uc < q * mean(self.transmitted[side(wo)]);
            let wi = self.bare.sample(u);
            let (sign, eta) = if crosses { (-wo.z, eta) } else { (wo.z, 1.0) };
            return Some((Vec3::new(wi.x, wi.y, wi.z.copysign(sign)), eta));
        }
        let uc = (uc - q) / (1.0 - q);
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

    /// Directional albedo, as if smooth: of a clear interface it is 1.
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        self.facet.albedo(wo)
    }
}

/// 0 for directions outside, 1 inside.
#[inline]
fn side(w: Vec3) -> usize {
    usize::from(w.z <= 0.0)
}
