//! Rough interface between two dielectrics: GGX microfacets that reflect and refract.

use super::Transport;
use super::energy::{DielectricEnergy, DielectricPair};
use super::fresnel::{dielectric, refract};
use super::ggx::{Ggx, MIN_ALPHA, half_vector, reflect};
use super::lobe::{Aspect, importance};
use super::smooth::{refraction_scale, relative_eta};
use crate::spectrum::Spectrum;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// GGX reflection and refraction (Walter et al. 2007, eqs. 20 and 21) with the multiply scattered rest.
///
/// Lost energy comes back on both sides by Kulla–Conty lobes. From side a, the share T_ab of it crosses to b,
///
/// ```text
/// f_ms(o ∈ a, i ∈ b) = T_ab loss_a(o) loss_b(i) / (π loss_avg,b)
/// ```
///
/// and 1 − T_ab stays. Nothing is lost, and reciprocity f(a→b)/η_b² = f(b→a)/η_a² holds where
/// T_ab η_a² loss_avg,a = T_ba η_b² loss_avg,b. Of these the pair is taken whose geometric mean is that of the mean
/// Fresnel transmittances, both kept below 1.
#[derive(Clone, Copy, Debug)]
pub struct RoughDielectric {
    tint: Spectrum,
    energy: DielectricEnergy,
    /// Share of the multiply scattered light that crosses, from outside and from inside.
    transmitted: [f32; 2],
}

/// Mean Fresnel reflectance 2 ∫ F(μ) μ dμ of diffuse light that arrives at a medium of `n` ≥ 1 times the index (Walsh
/// 1926, as Duntley 1942 has it).
fn mean_reflectance(n: f32) -> f32 {
    // The closed form is a difference of large terms near 1, where F is near its square.
    let n = f64::from(n);
    if n < 1.0 + 1e-3 {
        return 0.0;
    }
    let (n2, m) = (n * n, n * n - 1.0);
    let (p, q) = (n2 + 1.0, n2 * n2 - 1.0);
    let mean = 0.5
        + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0).powi(2))
        + n2 * m * m / p.powi(3) * ((n - 1.0) / (n + 1.0)).ln()
        - 2.0 * n * n2 * (n2 + 2.0 * n - 1.0) / (p * q)
        + 8.0 * n2 * n2 * (n2 * n2 + 1.0) / (p * q * q) * n.ln();
    mean.clamp(0.0, 1.0) as f32
}

impl RoughDielectric {
    /// Interface of roughness α along x and y, at least [`MIN_ALPHA`]; `eta` is that of the inside over the outside. Two
    /// different roughnesses take tables of their own, computed the first time: for materials that are compiled.
    pub fn new(alpha: [f32; 2], eta: f32, tint: Spectrum) -> Self {
        match alpha.map(|a| a.clamp(MIN_ALPHA, 1.0)) {
            [ax, ay] if ax == ay => Self::isotropic(ax, eta, tint),
            [ax, ay] => Self::between(DielectricPair::new(Ggx { ax, ay }, eta), eta, tint),
        }
    }

    /// Interface of one roughness.
    #[inline]
    pub fn isotropic(alpha: f32, eta: f32, tint: Spectrum) -> Self {
        Self::with(DielectricEnergy::isotropic(alpha.clamp(MIN_ALPHA, 1.0), eta), tint)
    }

    /// Interface of two roughnesses whose tables are at hand, at any index.
    pub fn between(tables: &'static DielectricPair, eta: f32, tint: Spectrum) -> Self {
        Self::with(DielectricEnergy::of(tables, eta), tint)
    }

    /// This interface with another factor on transmitted light.
    #[inline]
    pub fn with_tint(&self, tint: Spectrum) -> Self {
        Self { tint, ..*self }
    }

    fn with(energy: DielectricEnergy, tint: Spectrum) -> Self {
        let transmitted = {
            let eta = energy.eta();
            shares(eta, energy.mean_loss(), 1.0 - mean_reflectance(eta.max(1.0 / eta)))
        };
        Self { tint, energy, transmitted }
    }

    /// 0 for directions outside, 1 inside.
    #[inline]
    fn side(w: Vec3) -> usize {
        usize::from(w.z <= 0.0)
    }

    pub(super) fn is_anisotropic(&self) -> bool {
        let Ggx { ax, ay } = self.energy.ggx();
        ax != ay
    }

    /// Directional albedo, both sides together.
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        let e = self.energy.at(wo);
        let transmitted = e.parts[0] + e.loss * self.transmitted[Self::side(wo)];
        Spectrum::splat(1.0 - transmitted) + self.tint * transmitted
    }

    /// What is asked again and again of the direction `w`.
    #[inline]
    pub(super) fn aspect(&self, w: Vec3) -> Aspect {
        let e = self.energy.at(w);
        let transmitted = e.parts[0] + e.loss * self.transmitted[Self::side(w)];
        let weight = importance(Spectrum::splat(1.0 - transmitted) + self.tint * transmitted);
        Aspect { loss: e.loss, multiple: e.loss, weight, ..Aspect::NONE }
    }

    /// f \[1/sr\], and the densities \[1/sr\] of `wi` and, seen from there, of `wo`.
    #[inline]
    pub(super) fn eval(&self, [wo, wi]: [Vec3; 2], [e_o, e_i]: [&Aspect; 2], mode: Transport) -> (Spectrum, f32, f32) {
        let (ggx, eta) = (self.energy.ggx(), relative_eta(self.energy.eta(), wo));
        let (here, there) = (Self::side(wo), Self::side(wi));
        // Seen from the side of wo.
        let flip = Vec3::new(1.0, 1.0, 1f32.copysign(wo.z));
        let (o, i) = (wo * flip, wi * flip);
        let again = FRAC_1_PI * e_o.loss * e_i.loss / self.energy.mean_loss()[there];
        let multiple = [e_o.multiple * self.energy.pdf(i.z.abs()), e_i.multiple * self.energy.pdf(o.z)];
        if i.z > 0.0 {
            let (h, cos) = half_vector(o, i);
            let (f, _) = dielectric(cos, eta);
            let stays = 1.0 - self.transmitted[here];
            let single = f * 0.25 * ggx.d(h) * ggx.g2_over_cosines(o, i);
            let visible = |w, q: f32| (1.0 - q) * f * 0.25 * ggx.visible_over_cosine(w, h);
            let pdf = visible(o, e_o.multiple) + multiple[0] * stays;
            let pdf_rev = visible(i, e_i.multiple) + multiple[1] * stays;
            return (Spectrum::splat(single + stays * again), pdf, pdf_rev);
        }

        let mut f = self.transmitted[here] * again;
        let mut pdf = multiple[0] * self.transmitted[here];
        let mut pdf_rev = multiple[1] * self.transmitted[there];
        // The normal that refracts o to i; there is none unless they are on opposite sides of it.
        let h = o + i * eta;
        let length = h.length().max(f32::MIN_POSITIVE);
        let h = h * (1f32.copysign(h.z) / length);
        let (oh, ih) = (o.dot(h), i.dot(h));
        if oh > 0.0 && ih < 0.0 {
            let (fresnel, _) = dielectric(oh.min(1.0), eta);
            // |dh/di| = η² |i·h| / (o·h + η i·h)², whose denominator is |o + η i|²; |dh/do| is o·h over it.
            let (jacobian, back) = (eta * eta * -ih / (length * length), oh / (length * length));
            let through = 1.0 - fresnel;
            f += through * oh * jacobian * ggx.d(h) * ggx.g2_over_cosines(o, i);
            pdf += (1.0 - e_o.multiple) * through * ggx.visible_over_cosine(o, h) * oh * jacobian;
            pdf_rev += (1.0 - e_i.multiple) * through * ggx.visible_over_cosine(i, h) * -ih * back;
        }
        (self.tint * (f * refraction_scale(eta, mode)), pdf, pdf_rev)
    }

    /// Draws `wi`, the multiply scattered part, or reflection or refraction at a visible normal, and says which η it crossed.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, aspect: &Aspect, uc: f32, u: [f32; 2]) -> Option<(Vec3, f32)> {
        let (ggx, eta) = (self.energy.ggx(), relative_eta(self.energy.eta(), wo));
        let flip = Vec3::new(1.0, 1.0, 1f32.copysign(wo.z));
        let (o, q) = (wo * flip, aspect.multiple);
        if uc < q {
            let crosses = uc < q * self.transmitted[Self::side(wo)];
            let wi = self.energy.sample(u);
            let (sign, eta) = if crosses { (-wo.z, eta) } else { (wo.z, 1.0) };
            return Some((Vec3::new(wi.x, wi.y, wi.z.copysign(sign)), eta));
        }
        let uc = (uc - q) / (1.0 - q);
        let m = ggx.sample_visible(o, u);
        let cos = o.dot(m).clamp(0.0, 1.0);
        let (f, cos_t) = dielectric(cos, eta);
        if uc < f {
            let i = reflect(o, m).normalize();
            return (i.z > 0.0).then_some((i * flip, 1.0));
        }
        let i = refract(o, m, cos, cos_t, eta);
        (i.z < 0.0).then_some((i * flip, eta))
    }
}

/// T_ab from outside and from inside, of an interface of index `eta` that loses this much on the mean, and of the smooth one
/// transmits the share `thin_to_dense` of diffuse light on the thinner side.
pub(super) fn shares(eta: f32, [outside, inside]: [f32; 2], thin_to_dense: f32) -> [f32; 2] {
    // Of either side, what the smooth interface transmits: t_out η_out² = t_in η_in².
    let n = eta.max(1.0 / eta);
    let dense_to_thin = thin_to_dense / (n * n);
    let [t_out, t_in] = if eta >= 1.0 { [thin_to_dense, dense_to_thin] } else { [dense_to_thin, thin_to_dense] };
    let ratio = (inside / outside).sqrt();
    let [t_out, t_in] = [t_out * ratio, t_in / ratio];
    let too_much = t_out.max(t_in).max(1.0);
    [t_out / too_much, t_in / too_much]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diffuse_light_is_reflected_by_the_closed_form() {
        for n in [1.01f32, 1.1, 1.33, 1.5, 2.4, 4.0] {
            // Midpoints in s = √μ, crowded at the grazing angle.
            let term = |i: i32| {
                let s = (i as f32 + 0.5) / 512.0;
                4.0 * s * s * s * dielectric(s * s, n).0 / 512.0
            };
            let sum: f32 = (0..512).map(term).sum();
            assert!((mean_reflectance(n) - sum).abs() < 2e-4, "{n}: {} {sum}", mean_reflectance(n));
        }
    }
}
