//! Microfacets that reflect, or pass light on below: conductors, glTF's specular coat, and its thin transmission. GGX, or
//! Beckmann's as Cook and Torrance have them.

use super::beckmann::Beckmann;
use super::energy::{Atlas, Energy, Slice};
use super::ggx::{Ggx, half_vector, reflect};
use super::{Coat, Fresnel, Interface};
use crate::spectrum::Spectrum;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// How normals are distributed, which of them are seen, and from where to where light gets.
pub trait Microsurface: Copy {
    /// Distribution of normals D(m) \[1/sr\].
    fn d(&self, m: Vec3) -> f32;
    /// Masking and shadowing over the cosines, G₂/(|cos o||cos i|).
    fn g2_over_cosines(&self, o: Vec3, i: Vec3) -> f32;
    /// Density \[1/sr\] of visible normals over the cosine ⟨o·m⟩.
    fn visible_over_cosine(&self, o: Vec3, m: Vec3) -> f32;
    /// Normal visible from `o` (o.z > 0).
    fn sample_visible(&self, o: Vec3, u: [f32; 2]) -> Vec3;
}

/// Microfacet reflection with the multiply scattered rest:
///
/// ```text
/// f = F(o·h) D(h) G₂(o, i) / (4 |cos o||cos i|) + F_ms loss(o) loss(i) / (π loss_avg)
/// ```
///
/// (Cook & Torrance 1982; Walter et al. 2007; Heitz 2014; Kulla & Conty 2017). Two-sided.
#[derive(Clone, Copy, Debug)]
pub struct RoughReflection<M = Ggx> {
    micro: Micro<M>,
    fresnel: Fresnel,
    /// F₀, F₉₀, k of [`Fresnel::fit`], for the albedo.
    fit: (Spectrum, Spectrum, Spectrum),
    f_ms: Spectrum,
}

/// What a coat of GGX microfacets lets through an infinitely thin sheet: the reflection lobe mirrored to the other
/// side, with 1 − F for F and 1 − F_ms for F_ms.
#[derive(Clone, Copy, Debug)]
pub struct RoughThin {
    coat: RoughReflection,
    tint: Spectrum,
}

/// A microsurface and its energy.
#[derive(Clone, Copy, Debug)]
pub struct Micro<M = Ggx> {
    surface: M,
    energy: Slice,
}

impl Micro {
    /// Microsurface of roughness α along x and y, at least [`super::MIN_ALPHA`].
    pub fn new(alpha: [f32; 2]) -> Self {
        let [ax, ay] = alpha.map(|a| a.clamp(super::MIN_ALPHA, 1.0));
        let ggx = Ggx { ax, ay };
        Self { surface: ggx, energy: Slice::new(Interface::Mirror, ggx) }
    }

    /// Isotropic, with the table at hand.
    #[inline]
    pub fn isotropic(alpha: f32, table: &'static super::EnergyTable) -> Self {
        let a = alpha.clamp(super::MIN_ALPHA, 1.0);
        Self { surface: Ggx { ax: a, ay: a }, energy: Slice::isotropic(table, a) }
    }

    /// Anisotropic, without a table of its own; `table` is that of the isotropic ones.
    #[inline]
    pub fn varying(alpha: [f32; 2], atlas: &'static Atlas, table: &'static super::EnergyTable) -> Self {
        let [ax, ay] = alpha.map(|a| a.clamp(super::MIN_ALPHA, 1.0));
        let ggx = Ggx { ax, ay };
        Self { surface: ggx, energy: Slice::anisotropic(atlas, table, ggx) }
    }
}

impl Micro<Beckmann> {
    /// Beckmann's of roughness α along x and y, at least [`super::MIN_ALPHA`].
    pub fn beckmann(alpha: [f32; 2]) -> Self {
        let [ax, ay] = alpha.map(|a| a.clamp(super::MIN_ALPHA, 1.0));
        Self { surface: Beckmann { ax, ay }, energy: Slice::new(Interface::BeckmannMirror, Ggx { ax, ay }) }
    }

    /// Beckmann's, isotropic, with the table at hand.
    #[inline]
    pub fn isotropic_beckmann(alpha: f32, table: &'static super::EnergyTable) -> Self {
        let a = alpha.clamp(super::MIN_ALPHA, 1.0);
        Self { surface: Beckmann { ax: a, ay: a }, energy: Slice::isotropic(table, a) }
    }
}

impl<M> Micro<M> {
    /// Normals and masking.
    pub fn surface(&self) -> &M {
        &self.surface
    }

    /// Its energy table at this roughness.
    pub fn energy(&self) -> &Slice {
        &self.energy
    }
}

/// F_ms = F² E_avg / (1 − F (1 − E_avg)) of the series of bounces, F the mean of the Fresnel term and
/// E_avg = 1 − `loss` (Kulla & Conty 2017).
#[inline]
pub fn multiple_scattering(f: Spectrum, loss: f32) -> Spectrum {
    let denominator = Spectrum::ONE - f * loss;
    (f * f * (1.0 - loss)).div_or_zero(denominator)
}

impl<M: Microsurface> RoughReflection<M> {
    /// Its microsurface.
    pub fn micro(&self) -> &Micro<M> {
        &self.micro
    }

    pub(super) fn energy_mut(&mut self) -> &mut Slice {
        &mut self.micro.energy
    }

    /// Microsurface of this material.
    pub fn new(micro: Micro<M>, fresnel: Fresnel) -> Self {
        Self::with(micro, fresnel, multiple_scattering(fresnel.average(), micro.energy.mean.loss))
    }

    /// The same with F_ms given: of a mixture of materials it is the mixture of theirs.
    #[inline]
    pub fn with(micro: Micro<M>, fresnel: Fresnel, f_ms: Spectrum) -> Self {
        Self { micro, fresnel, fit: fresnel.fit(), f_ms }
    }

    /// Its albedo, as of something that others lie beneath; for Schlick's terms.
    pub fn coat(&self) -> Coat {
        let (f0, f90, _) = self.fit;
        Coat { f0, f90, f_ms: self.f_ms, energy: Some(self.micro.energy) }
    }

    /// Energy of single scattering, and of multiple scattering.
    #[inline]
    fn shares(&self, e: Energy) -> (Spectrum, Spectrum) {
        let (f0, f90, k) = self.fit;
        let single = f0 * (1.0 - e.loss - e.parts[0]) + f90 * e.parts[0] - k * e.parts[1];
        (single.max(Spectrum::ZERO), self.f_ms * e.loss)
    }

    /// Directional albedo.
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        let energy = &self.micro.energy;
        match self.fresnel.angular() {
            None => self.fitted_albedo(wo),
            Some(series) => energy.reflected(&series, wo).max(Spectrum::ZERO) + self.f_ms * energy.at(wo).loss,
        }
    }

    /// Directional albedo by the fit of the Fresnel term (of metals and films within a few per cent): quicker, and enough
    /// to choose by.
    pub(super) fn fitted_albedo(&self, wo: Vec3) -> Spectrum {
        let (single, multiple) = self.shares(self.micro.energy.at(wo));
        single + multiple
    }

    /// Probability of drawing from the multiply scattered part.
    #[inline]
    fn multiple_probability(&self, e: Energy, through: bool) -> f32 {
        if through {
            return e.loss;
        }
        let (single, multiple) = self.shares(e);
        let (s, m) = (single.max_element(), multiple.max_element());
        if m > 0.0 { m / (s + m) } else { 0.0 }
    }

    /// f and density for directions above the horizon.
    #[inline]
    fn eval_above(&self, wo: Vec3, wi: Vec3, through: bool) -> (Spectrum, f32) {
        let Micro { surface, energy } = &self.micro;
        // o·h = |o + i|/2 = i·h: the same for both, and nothing cancels.
        let (h, cos) = half_vector(wo, wi);
        let (e_o, e_i) = (energy.at(wo), energy.at(wi));
        let q = self.multiple_probability(e_o, through);
        let (f, f_ms) = (self.fresnel.eval(cos), self.f_ms);
        let (f, f_ms) = if through { (Spectrum::ONE - f, Spectrum::ONE - f_ms) } else { (f, f_ms) };
        let single = f * (0.25 * surface.d(h) * surface.g2_over_cosines(wo, wi));
        let multiple = f_ms * (FRAC_1_PI * e_o.loss * e_i.loss / energy.mean.loss);
        let pdf = (1.0 - q) * 0.25 * surface.visible_over_cosine(wo, h) + q * energy.pdf(wi.z);
        (single + multiple, pdf)
    }

    /// f \[1/sr\] and density \[1/sr\] of `wi`; nothing across the surface.
    #[inline]
    pub(super) fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32) {
        if wo.z * wi.z <= 0.0 {
            return (Spectrum::ZERO, 0.0);
        }
        self.eval_above(above(wo), above(wi), false)
    }

    /// Draws `wi`: a mirrored direction at a visible normal, or one of the multiply scattered part.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2]) -> Option<Vec3> {
        self.sample_same_side(wo, uc, u, false)
    }

    #[inline]
    fn sample_same_side(&self, wo: Vec3, uc: f32, u: [f32; 2], through: bool) -> Option<Vec3> {
        let o = above(wo);
        let q = self.multiple_probability(self.micro.energy.at(o), through);
        if uc < q {
            let wi = self.micro.energy.sample(u);
            return Some(Vec3::new(wi.x, wi.y, wi.z.copysign(wo.z)));
        }
        let wi = reflect(o, self.micro.surface.sample_visible(o, u));
        (wi.z > 0.0).then(|| Vec3::new(wi.x, wi.y, wi.z.copysign(wo.z)).normalize())
    }
}

impl RoughThin {
    /// Transmission `tint` (1 − F) under a coat with reflectance F.
    #[inline]
    pub fn new(coat: RoughReflection, tint: Spectrum) -> Self {
        Self { coat, tint }
    }

    pub(super) fn is_anisotropic(&self) -> bool {
        self.coat.micro.energy.is_anisotropic()
    }

    /// Directional albedo.
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        self.tint * (Spectrum::ONE - self.coat.albedo(wo)).max(Spectrum::ZERO)
    }

    /// The same by [`RoughReflection::fitted_albedo`].
    pub(super) fn fitted_albedo(&self, wo: Vec3) -> Spectrum {
        self.tint * (Spectrum::ONE - self.coat.fitted_albedo(wo)).max(Spectrum::ZERO)
    }

    /// f \[1/sr\] and density \[1/sr\] of `wi`; nothing on the side of `wo`.
    #[inline]
    pub(super) fn eval(&self, wo: Vec3, wi: Vec3) -> (Spectrum, f32) {
        if wo.z * wi.z >= 0.0 {
            return (Spectrum::ZERO, 0.0);
        }
        let (f, pdf) = self.coat.eval_above(above(wo), above(wi), true);
        (f * self.tint, pdf)
    }

    /// Draws `wi`.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2]) -> Option<Vec3> {
        self.coat.sample_same_side(wo, uc, u, true).map(|wi| Vec3::new(wi.x, wi.y, -wi.z))
    }
}

/// `w` mirrored to the upper side.
#[inline]
fn above(w: Vec3) -> Vec3 {
    Vec3::new(w.x, w.y, w.z.abs())
}
