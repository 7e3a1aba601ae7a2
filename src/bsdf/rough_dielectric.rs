//! Rough interface between two dielectrics: GGX microfacets that reflect and refract.

use super::Transport;
use super::energy::{EnergyTable, Interface, Slice};
use super::fresnel::{dielectric, refract};
use super::ggx::{Ggx, MIN_ALPHA, half_vector, reflect};
use super::smooth::refraction_scale;
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
    ggx: Ggx,
    /// Index of the inside (behind the normal) over the outside.
    eta: f32,
    tint: Spectrum,
    /// Outside, inside.
    sides: [Side; 2],
}

/// One side of the interface.
#[derive(Clone, Copy, Debug)]
struct Side {
    energy: Slice,
    /// Share of the multiply scattered light that crosses.
    transmitted: f32,
}

/// Energy tables of an interface, seen from outside and from inside.
#[derive(Clone, Copy, Debug)]
pub struct DielectricTables([&'static EnergyTable; 2]);

impl DielectricTables {
    /// The isotropic tables of a relative index; computed the first time.
    pub fn new(eta: f32) -> Self {
        Self(interfaces(eta).map(EnergyTable::isotropic))
    }
}

fn interfaces(eta: f32) -> [Interface; 2] {
    [Interface::Dielectric { eta }, Interface::Dielectric { eta: 1.0 / eta }]
}

/// Mean Fresnel reflectance 2 ∫ F(μ) μ dμ of diffuse light.
fn mean_reflectance(eta: f32) -> f32 {
    let n = 64;
    let term = |i: i32| {
        // Midpoints in s = √μ, crowded at the grazing angle.
        let s = (i as f32 + 0.5) / n as f32;
        4.0 * s * s * s * dielectric(s * s, eta).0 / n as f32
    };
    (0..n).map(term).sum()
}

impl RoughDielectric {
    /// Interface of roughness α along x and y, at least [`MIN_ALPHA`]; `eta` is that of the inside over the outside.
    pub fn new(alpha: [f32; 2], eta: f32, tint: Spectrum) -> Self {
        let [ax, ay] = alpha.map(|a| a.clamp(MIN_ALPHA, 1.0));
        let ggx = Ggx { ax, ay };
        Self::with(ggx, eta, tint, interfaces(eta).map(|interface| Slice::new(interface, ggx)))
    }

    /// Isotropic, with the tables at hand.
    pub fn isotropic(alpha: f32, eta: f32, tint: Spectrum, tables: &DielectricTables) -> Self {
        let alpha = alpha.clamp(MIN_ALPHA, 1.0);
        let ggx = Ggx { ax: alpha, ay: alpha };
        Self::with(ggx, eta, tint, tables.0.map(|table| Slice::isotropic(table, alpha)))
    }

    /// The same with another factor on transmitted light.
    #[inline]
    pub fn with_tint(&self, tint: Spectrum) -> Self {
        Self { tint, ..*self }
    }

    fn with(ggx: Ggx, eta: f32, tint: Spectrum, [outside, inside]: [Slice; 2]) -> Self {
        // Of either side, what the smooth interface transmits: t_out η_out² = t_in η_in².
        let (thin_to_dense, n) = (1.0 - mean_reflectance(eta.max(1.0 / eta)), eta.max(1.0 / eta));
        let (t_out, t_in) = if eta >= 1.0 {
            (thin_to_dense, thin_to_dense / (n * n))
        } else {
            (thin_to_dense / (n * n), thin_to_dense)
        };
        let ratio = (inside.mean.loss / outside.mean.loss).sqrt();
        let (t_out, t_in) = (t_out * ratio, t_in / ratio);
        let too_much = t_out.max(t_in).max(1.0);
        let side = |energy, transmitted| Side { energy, transmitted: transmitted / too_much };
        Self { ggx, eta, tint, sides: [side(outside, t_out), side(inside, t_in)] }
    }

    /// The side of `wo`, the other one, and η of the other over its own.
    #[inline]
    fn sides(&self, wo: Vec3) -> (&Side, &Side, f32) {
        let [outside, inside] = &self.sides;
        if wo.z > 0.0 { (outside, inside, self.eta) } else { (inside, outside, 1.0 / self.eta) }
    }

    /// η of the side of `wi` over η of the side of `wo`.
    #[inline]
    pub(super) fn crossed(&self, wo: Vec3, wi: Vec3) -> f32 {
        if wo.z * wi.z > 0.0 { 1.0 } else { self.sides(wo).2 }
    }

    pub(super) fn is_anisotropic(&self) -> bool {
        self.ggx.ax != self.ggx.ay
    }

    /// Directional albedo, both sides together.
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        let (own, _, _) = self.sides(wo);
        let e = own.energy.at(wo);
        let transmitted = e.parts[0] + e.loss * own.transmitted;
        Spectrum::splat(1.0 - transmitted) + self.tint * transmitted
    }

    /// f \[1/sr\] and density \[1/sr\] of `wi`.
    #[inline]
    pub(super) fn eval(&self, wo: Vec3, wi: Vec3, mode: Transport) -> (Spectrum, f32) {
        let (own, other, eta) = self.sides(wo);
        // Seen from the side of wo.
        let flip = Vec3::new(1.0, 1.0, 1f32.copysign(wo.z));
        let (o, i) = (wo * flip, wi * flip);
        let e_o = own.energy.at(o);
        let q = e_o.loss;
        if i.z > 0.0 {
            let (h, cos) = half_vector(o, i);
            let (f, _) = dielectric(cos, eta);
            let stays = 1.0 - own.transmitted;
            let single = f * 0.25 * self.ggx.d(h) * self.ggx.g2_over_cosines(o, i);
            let multiple = stays * FRAC_1_PI * e_o.loss * own.energy.at(i).loss / own.energy.mean.loss;
            let visible = f * 0.25 * self.ggx.visible_over_cosine(o, h);
            let pdf = (1.0 - q) * visible + q * stays * own.energy.pdf(i.z);
            return (Spectrum::splat(single + multiple), pdf);
        }

        let crosses = own.transmitted;
        let mut f = crosses * FRAC_1_PI * e_o.loss * other.energy.at(i).loss / other.energy.mean.loss;
        let mut pdf = q * crosses * other.energy.pdf(-i.z);
        // The normal that refracts o to i; there is none unless they are on opposite sides of it.
        let h = o + i * eta;
        let length = h.length().max(f32::MIN_POSITIVE);
        let h = h * (1f32.copysign(h.z) / length);
        let (oh, ih) = (o.dot(h), i.dot(h));
        if oh > 0.0 && ih < 0.0 {
            let (fresnel, _) = dielectric(oh.min(1.0), eta);
            // |dh/di| = η² |i·h| / (o·h + η i·h)², whose denominator is |o + η i|².
            let jacobian = eta * eta * -ih / (length * length);
            f += (1.0 - fresnel) * oh * jacobian * self.ggx.d(h) * self.ggx.g2_over_cosines(o, i);
            pdf += (1.0 - q) * (1.0 - fresnel) * self.ggx.visible_over_cosine(o, h) * oh * jacobian;
        }
        (self.tint * (f * refraction_scale(eta, mode)), pdf)
    }

    /// Draws `wi`: the multiply scattered part, or reflection or refraction at a visible normal.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2]) -> Option<Vec3> {
        let (own, other, eta) = self.sides(wo);
        let flip = Vec3::new(1.0, 1.0, 1f32.copysign(wo.z));
        let o = wo * flip;
        let q = own.energy.at(o).loss;
        if uc < q {
            let crosses = uc < q * own.transmitted;
            let (side, sign) = if crosses { (other, -wo.z) } else { (own, wo.z) };
            let wi = side.energy.sample(u);
            return Some(Vec3::new(wi.x, wi.y, wi.z.copysign(sign)));
        }
        let uc = (uc - q) / (1.0 - q);
        let m = self.ggx.sample_visible(o, u);
        let cos = o.dot(m).clamp(0.0, 1.0);
        let (f, cos_t) = dielectric(cos, eta);
        let (i, valid) = if uc < f {
            let i = reflect(o, m).normalize();
            (i, i.z > 0.0)
        } else {
            let i = refract(o, m, cos, cos_t, eta);
            (i, i.z < 0.0)
        };
        valid.then(|| i * flip)
    }
}
