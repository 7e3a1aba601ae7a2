//! Microfacets that reflect, or pass light on below: conductors, glTF's specular coat, and its thin transmission. GGX, or
//! Beckmann's as Cook and Torrance have them.

use super::beckmann::Beckmann;
use super::energy::{Energy, EnergyAt, EnergyTable};
use super::ggx::{Ggx, half_vector, reflect};
use super::lobe::{Aspect, importance};
use super::{Coat, Fresnel, Interface};
use crate::spectrum::Spectrum;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;
use std::marker::PhantomData;

/// How normals are distributed, which of them are seen, and from where to where light gets.
pub trait Microsurface: Copy {
    /// Of these roughnesses.
    fn of(ggx: Ggx) -> Self;
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
#[derive(Clone, Debug)]
pub struct RoughReflection<M = Ggx> {
    micro: Micro<M>,
    fresnel: Fresnel,
    f_ms: Spectrum,
}

/// What a coat of GGX microfacets lets through an infinitely thin sheet: the reflection lobe mirrored to the other
/// side, with 1 − F for F and 1 − F_ms for F_ms.
#[derive(Clone, Debug)]
pub struct RoughThin {
    micro: Micro,
    fresnel: Fresnel,
    tint: Spectrum,
}

/// A microsurface and its energy.
#[derive(Clone, Copy, Debug)]
pub struct Micro<M = Ggx> {
    energy: EnergyAt,
    kind: PhantomData<M>,
}

/// α of a surface that is not smooth.
fn clamped([ax, ay]: [f32; 2]) -> Ggx {
    // Not `clamp`, which keeps NaN.
    let clamp = |a: f32| if a > super::MIN_ALPHA { a.min(1.0) } else { super::MIN_ALPHA };
    Ggx { ax: clamp(ax), ay: clamp(ay) }
}

impl<M> Micro<M> {
    fn with(energy: EnergyAt) -> Self {
        Self { energy, kind: PhantomData }
    }
}

impl Micro {
    /// Microsurface of roughness α along x and y, at least [`super::MIN_ALPHA`].
    pub fn new(alpha: [f32; 2]) -> Self {
        Self::with(EnergyAt::new(Interface::Mirror, clamped(alpha)))
    }

    /// Microsurface that `table` has, at hand: that of all isotropic ones, or of every pair.
    #[inline]
    pub fn of(alpha: [f32; 2], table: &'static EnergyTable) -> Self {
        Self::with(EnergyAt::of(table, clamped(alpha)))
    }
}

impl Micro<Beckmann> {
    /// Beckmann's of roughness α along x and y, at least [`super::MIN_ALPHA`].
    pub fn beckmann(alpha: [f32; 2]) -> Self {
        Self::with(EnergyAt::new(Interface::BeckmannMirror, clamped(alpha)))
    }

    /// Beckmann's, isotropic, with the table at hand.
    #[inline]
    pub fn isotropic_beckmann(alpha: f32, table: &'static EnergyTable) -> Self {
        Self::with(EnergyAt::of(table, clamped([alpha; 2])))
    }
}

impl<M: Microsurface> Micro<M> {
    /// Normals and masking.
    #[inline]
    pub fn surface(&self) -> M {
        M::of(self.energy.ggx())
    }

    /// Its energy.
    #[inline]
    pub fn energy(&self) -> &EnergyAt {
        &self.energy
    }

    /// Single scattering, its Fresnel term and its density at the mirrored normal of directions above the horizon:
    /// D G₂/(4 |cos o||cos i|), cos, and the densities of `wi` seen from `wo` and of `wo` seen from `wi`.
    #[inline]
    fn mirrored(&self, wo: Vec3, wi: Vec3) -> (f32, f32, [f32; 2]) {
        let surface = self.surface();
        // o·h = |o + i|/2 = i·h: the same for both, and nothing cancels.
        let (h, cos) = half_vector(wo, wi);
        let visible = [wo, wi].map(|w| 0.25 * surface.visible_over_cosine(w, h));
        (0.25 * surface.d(h) * surface.g2_over_cosines(wo, wi), cos, visible)
    }

    /// Multiple scattering of directions of these losses, before F_ms.
    #[inline]
    fn again(&self, loss_o: f32, loss_i: f32) -> f32 {
        FRAC_1_PI * loss_o * loss_i / self.energy.mean_loss()
    }

    /// Density of `w` where that of the mirrored part is `mirrored` and the other part is drawn with probability `q`.
    #[inline]
    fn density(&self, q: f32, mirrored: f32, w: Vec3) -> f32 {
        (1.0 - q) * mirrored + q * self.energy.pdf(w.z)
    }

    /// A mirrored direction at a visible normal, or with the probability `q` one of the multiply scattered part.
    #[inline]
    fn sample(&self, wo: Vec3, q: f32, uc: f32, u: [f32; 2]) -> Option<Vec3> {
        if uc < q {
            let wi = self.energy.sample(u);
            return Some(Vec3::new(wi.x, wi.y, wi.z.copysign(wo.z)));
        }
        let o = above(wo);
        let wi = reflect(o, self.surface().sample_visible(o, u));
        (wi.z > 0.0).then(|| Vec3::new(wi.x, wi.y, wi.z.copysign(wo.z)).normalize())
    }
}

/// F_ms = F² E_avg / (1 − F (1 − E_avg)) of the series of bounces, F the mean of the Fresnel term and
/// E_avg = 1 − `loss` (Kulla & Conty 2017).
#[inline]
pub fn multiple_scattering(f: Spectrum, loss: f32) -> Spectrum {
    let denominator = Spectrum::ONE - f * loss;
    (f * f * (1.0 - loss)).div_or_zero(denominator)
}

/// What single scattering reflects, by the terms of the fit.
#[inline]
fn once(fresnel: &Fresnel, e: Energy) -> Spectrum {
    let fit = fresnel.fit();
    (fit.f0 * (1.0 - e.loss - e.parts[0]) + fit.f90 * e.parts[0] - fit.k * e.parts[1]).max(Spectrum::ZERO)
}

/// What single scattering reflects towards `w`.
fn once_exactly<M>(micro: &Micro<M>, fresnel: &Fresnel, w: Vec3, e: Energy) -> Spectrum {
    match fresnel.angular() {
        None => once(fresnel, e),
        Some(series) => micro.energy.reflected(&series, w, e.loss).max(Spectrum::ZERO),
    }
}

impl<M: Microsurface> RoughReflection<M> {
    /// Its microsurface.
    pub fn micro(&self) -> &Micro<M> {
        &self.micro
    }

    /// Microsurface of this material.
    pub fn new(micro: Micro<M>, fresnel: Fresnel) -> Self {
        let f_ms = multiple_scattering(fresnel.average(), micro.energy.mean_loss());
        Self { micro, fresnel, f_ms }
    }

    /// Microsurface of a mixture of materials, whose F and F_ms are the mixtures of theirs.
    #[inline]
    pub fn with(micro: Micro<M>, fresnel: Fresnel, f_ms: Spectrum) -> Self {
        Self { micro, fresnel, f_ms }
    }

    /// Its albedo, as of something that others lie beneath; for Schlick's terms.
    pub fn coat(&self) -> Coat {
        let fit = self.fresnel.fit();
        Coat { f0: fit.f0, f90: fit.f90.max_element(), energy: Some(self.micro.energy) }
    }

    /// Directional albedo.
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        let e = self.micro.energy.at(wo);
        once_exactly(&self.micro, &self.fresnel, wo, e) + self.f_ms * e.loss
    }

    /// What is asked again and again of a direction of energy `e`.
    #[inline]
    pub(super) fn aspect(&self, e: Energy) -> Aspect {
        let (single, multiple) = (importance(once(&self.fresnel, e)), importance(self.f_ms * e.loss));
        let weight = single + multiple;
        Aspect { loss: e.loss, multiple: if multiple > 0.0 { multiple / weight } else { 0.0 }, weight, ..Aspect::NONE }
    }

    /// f \[1/sr\], and the densities \[1/sr\] of `wi` and, seen from there, of `wo`; nothing across the surface.
    #[inline]
    pub(super) fn eval(&self, [wo, wi]: [Vec3; 2], [o, i]: [&Aspect; 2]) -> (Spectrum, f32, f32) {
        if wo.z * wi.z <= 0.0 {
            return (Spectrum::ZERO, 0.0, 0.0);
        }
        let (wo, wi) = (above(wo), above(wi));
        let (single, cos, visible) = self.micro.mirrored(wo, wi);
        let f = self.fresnel.eval(cos) * single + self.f_ms * self.micro.again(o.loss, i.loss);
        let pdf = self.micro.density(o.multiple, visible[0], wi);
        (f, pdf, self.micro.density(i.multiple, visible[1], wo))
    }

    /// Draws `wi`: a mirrored direction at a visible normal, or one of the multiply scattered part.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, aspect: &Aspect, uc: f32, u: [f32; 2]) -> Option<Vec3> {
        self.micro.sample(wo, aspect.multiple, uc, u)
    }
}

impl RoughThin {
    /// Transmission `tint` (1 − F) under a coat of reflectance F.
    #[inline]
    pub fn new(micro: Micro, fresnel: Fresnel, tint: Spectrum) -> Self {
        Self { micro, fresnel, tint }
    }

    pub(super) fn micro(&self) -> &Micro {
        &self.micro
    }

    #[inline]
    fn f_ms(&self) -> Spectrum {
        multiple_scattering(self.fresnel.average(), self.micro.energy.mean_loss())
    }

    /// Directional albedo.
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        let e = self.micro.energy.at(wo);
        let coat = once_exactly(&self.micro, &self.fresnel, wo, e) + self.f_ms() * e.loss;
        self.tint * (Spectrum::ONE - coat).max(Spectrum::ZERO)
    }

    /// What is asked again and again of a direction of energy `e`.
    #[inline]
    pub(super) fn aspect(&self, e: Energy) -> Aspect {
        let coat = once(&self.fresnel, e) + self.f_ms() * e.loss;
        let weight = importance(self.tint * (Spectrum::ONE - coat).max(Spectrum::ZERO));
        Aspect { loss: e.loss, multiple: e.loss, weight, ..Aspect::NONE }
    }

    /// f \[1/sr\], and the densities \[1/sr\] of `wi` and, seen from there, of `wo`; nothing on the side of `wo`.
    #[inline]
    pub(super) fn eval(&self, [wo, wi]: [Vec3; 2], [o, i]: [&Aspect; 2]) -> (Spectrum, f32, f32) {
        if wo.z * wi.z >= 0.0 {
            return (Spectrum::ZERO, 0.0, 0.0);
        }
        let (wo, wi) = (above(wo), above(wi));
        let (single, cos, visible) = self.micro.mirrored(wo, wi);
        let (f, f_ms) = (Spectrum::ONE - self.fresnel.eval(cos), Spectrum::ONE - self.f_ms());
        let f = f * single + f_ms * self.micro.again(o.loss, i.loss);
        let pdf = self.micro.density(o.multiple, visible[0], wi);
        (f * self.tint, pdf, self.micro.density(i.multiple, visible[1], wo))
    }

    /// Draws `wi`.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, aspect: &Aspect, uc: f32, u: [f32; 2]) -> Option<Vec3> {
        self.micro.sample(wo, aspect.multiple, uc, u).map(|wi| Vec3::new(wi.x, wi.y, -wi.z))
    }
}

/// `w` mirrored to the upper side.
#[inline]
fn above(w: Vec3) -> Vec3 {
    Vec3::new(w.x, w.y, w.z.abs())
}
