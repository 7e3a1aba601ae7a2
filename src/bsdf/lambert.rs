//! Diffuse lobes: Lambert's, and the one that glows through a specular coat.

use super::angular::Angular;
use super::energy::{Energy, EnergyAt};
use super::fresnel::pow5;
use super::layer::{self, Layer};
use super::{Fresnel, multiple_scattering};
use crate::spectrum::Spectrum;
use crate::warp::cosine_hemisphere;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// f = ρ/π on both sides (Lambert 1760).
#[derive(Clone, Copy, Debug)]
pub struct Lambert {
    /// Albedo ρ.
    pub reflectance: Spectrum,
}

/// Diffuse base under a specular coat of directional albedo E_s, coupled so that the two together are reciprocal and
/// never reflect more than all, and exactly all where the base is white:
///
/// ```text
/// f = ρ/π t(o) t(i) / ⟨t⟩,    t = 1 − E_s,    ⟨t⟩ = (1/π) ∫ t(i) cos θi dωi
/// ```
///
/// (Ashikhmin & Shirley 2000 in the form of Kelemen & Szirmay-Kalos 2001), per lane. Beneath further layers that transmit
/// T(w), which scale f by T(o) T(i), the mean is ⟨T t⟩.
#[derive(Clone, Debug)]
pub struct CoupledDiffuse {
    /// ρ/⟨T t⟩.
    scaled: Spectrum,
    f0: Spectrum,
    f90: f32,
    /// The largest lane of ⟨T t⟩, for estimates.
    average: f32,
    energy: Option<EnergyAt>,
    /// In place of Schlick's terms.
    film: Option<Box<FilmCoat>>,
}

/// Reflectance of a coat under a thin film.
#[derive(Clone, Debug)]
enum FilmCoat {
    Smooth(Fresnel),
    /// By its series, and F_ms of the multiply scattered part; the energy is that of the coat.
    Rough(Angular, Spectrum),
}

impl FilmCoat {
    fn reflected(&self, w: Vec3, energy: Option<&EnergyAt>, e: Energy) -> Spectrum {
        match (self, energy) {
            (Self::Smooth(fresnel), _) => fresnel.eval(w.z.abs().min(1.0)),
            (Self::Rough(series, f_ms), Some(energy)) => energy.reflected(series, w, e.loss) + *f_ms * e.loss,
            (Self::Rough(..), None) => Spectrum::ONE,
        }
    }

    fn reflected_average(&self, energy: Option<&EnergyAt>) -> Spectrum {
        match (self, energy) {
            (Self::Smooth(fresnel), _) => fresnel.average(),
            (Self::Rough(series, f_ms), Some(energy)) => energy.reflected_mean(series) + *f_ms * energy.mean_loss(),
            (Self::Rough(..), None) => Spectrum::ONE,
        }
    }
}

/// A specular coat of Schlick's reflectance, multiple scattering included.
#[derive(Clone, Copy, Debug)]
pub struct Coat {
    /// F at normal incidence.
    pub f0: Spectrum,
    /// F at grazing incidence.
    pub f90: f32,
    /// Energy of the microsurface; none where the coat is smooth.
    pub energy: Option<EnergyAt>,
}

impl Coat {
    /// No coat: everything passes.
    pub const NONE: Self = Self { f0: Spectrum::ZERO, f90: 0.0, energy: None };

    /// A colourless smooth coat of this F₀.
    pub fn smooth(f0: f32) -> Self {
        Self { f0: Spectrum::splat(f0), f90: 1.0, energy: None }
    }

    /// 1 − E_s towards `w`, in [0, 1].
    #[inline]
    pub fn transmitted(&self, w: Vec3) -> Spectrum {
        self.passed(w, self.energy.map_or_else(Energy::default, |energy| energy.at(w)))
    }

    /// 1 − E_s towards `w`, whose energy is known.
    #[inline]
    fn passed(&self, w: Vec3, e: Energy) -> Spectrum {
        match &self.energy {
            None => self.complement(Spectrum::ZERO, 0.0, pow5(1.0 - w.z.abs().min(1.0))),
            Some(energy) => self.complement(self.multiple(energy.mean_loss()), e.loss, e.parts[0]),
        }
    }

    /// 1 − E_s,avg, the cosine-weighted mean over the hemisphere.
    pub fn transmitted_average(&self) -> Spectrum {
        match &self.energy {
            None => self.complement(Spectrum::ZERO, 0.0, 1.0 / 21.0),
            Some(energy) => {
                let mean = energy.mean();
                self.complement(self.multiple(mean.loss), mean.loss, mean.parts[0])
            }
        }
    }

    /// Mean albedo over the hemisphere of what is scattered once.
    pub fn once_average(&self) -> Spectrum {
        let (loss, schlick) = self.energy.map_or((0.0, 1.0 / 21.0), |e| (e.mean().loss, e.mean().parts[0]));
        Spectrum::ONE - self.complement(Spectrum::ZERO, loss, schlick)
    }

    /// F_ms of the multiply scattered part.
    #[inline]
    fn multiple(&self, mean_loss: f32) -> Spectrum {
        multiple_scattering(Spectrum::lerp(self.f0, Spectrum::splat(self.f90), 1.0 / 21.0), mean_loss)
    }

    #[inline]
    fn complement(&self, f_ms: Spectrum, loss: f32, schlick: f32) -> Spectrum {
        let e = self.f0 * (1.0 - loss - schlick) + Spectrum::splat(self.f90 * schlick) + f_ms * loss;
        (Spectrum::ONE - e).max(Spectrum::ZERO)
    }
}

impl CoupledDiffuse {
    /// Base of albedo `reflectance` under `coat`.
    pub fn new(reflectance: Spectrum, coat: Coat) -> Self {
        Self::with(reflectance, coat, coat.transmitted_average(), None)
    }

    /// Base under a coat whose reflectance is not Schlick's: of `coat`, only the energy counts.
    pub fn under(reflectance: Spectrum, coat: Coat, fresnel: &Fresnel) -> Self {
        let film = match (&coat.energy, fresnel.angular()) {
            (_, None) => return Self::new(reflectance, coat),
            (None, Some(_)) => FilmCoat::Smooth(fresnel.clone()),
            (Some(energy), Some(series)) => {
                FilmCoat::Rough(series.covering(), multiple_scattering(fresnel.average(), energy.mean_loss()))
            }
        };
        let reflected = film.reflected_average(coat.energy.as_ref());
        Self::with(reflectance, coat, (Spectrum::ONE - reflected).max(Spectrum::ZERO), Some(Box::new(film)))
    }

    fn with(reflectance: Spectrum, coat: Coat, average: Spectrum, film: Option<Box<FilmCoat>>) -> Self {
        let Coat { f0, f90, energy } = coat;
        let scaled = over(reflectance, average);
        Self { scaled, f0, f90, average: average.max_element(), energy, film }
    }

    /// This base beneath the layers `above`, in place of those that it lies beneath now.
    pub(super) fn beneath(self, now: &[Layer], above: &[Layer]) -> Self {
        let (reflectance, average) = (self.reflectance(now), self.mean(above));
        Self { scaled: over(reflectance, average), average: average.max_element(), ..self }
    }

    /// ρ, beneath layers.
    pub(super) fn reflectance(&self, above: &[Layer]) -> Spectrum {
        self.scaled * self.mean(above)
    }

    /// ⟨T t⟩.
    fn mean(&self, above: &[Layer]) -> Spectrum {
        if !above.is_empty() {
            let t = |mu: f32| above.iter().map(|layer| layer.transmitted_at(mu)).product::<f32>();
            return layer::mean(self.is_anisotropic(), |w| self.transmitted(w, self.energy_of(w)) * t(w.z));
        }
        match &self.film {
            None => self.coat().transmitted_average(),
            Some(film) => (Spectrum::ONE - film.reflected_average(self.energy.as_ref())).max(Spectrum::ZERO),
        }
    }

    #[inline]
    fn coat(&self) -> Coat {
        Coat { f0: self.f0, f90: self.f90, energy: self.energy }
    }

    #[inline]
    pub(super) fn energy(&self) -> Option<&EnergyAt> {
        self.energy.as_ref()
    }

    fn energy_of(&self, w: Vec3) -> Energy {
        self.energy.map_or_else(Energy::default, |energy| energy.at(w))
    }

    pub(super) fn is_anisotropic(&self) -> bool {
        self.energy.is_some_and(|energy| energy.is_anisotropic())
    }

    /// t towards `w`, whose energy is `e`.
    #[inline]
    pub(super) fn transmitted(&self, w: Vec3, e: Energy) -> Spectrum {
        match &self.film {
            None => self.coat().passed(w, e),
            Some(film) => (Spectrum::ONE - film.reflected(w, self.energy.as_ref(), e)).max(Spectrum::ZERO),
        }
    }

    /// f \[1/sr\] for directions on the same side that `t_o` and `t_i` of the coat transmit.
    #[inline]
    pub(super) fn f(&self, t_o: Spectrum, t_i: Spectrum) -> Spectrum {
        self.scaled * t_o * t_i * FRAC_1_PI
    }

    /// About the directional albedo, where the coat transmits `t`.
    #[inline]
    pub(super) fn estimate(&self, t: Spectrum) -> Spectrum {
        self.scaled * t * self.average
    }

    /// Directional albedo, beneath layers that are still to dim it.
    pub(super) fn albedo(&self, wo: Vec3, above: &[Layer]) -> Spectrum {
        self.reflectance(above) * self.transmitted(wo, self.energy_of(wo))
    }
}

/// ρ/⟨t⟩; where a coat lets nothing through there is no base to be seen.
fn over(reflectance: Spectrum, average: Spectrum) -> Spectrum {
    reflectance.div_or_zero(average.map(|t| if t > 1e-6 { t } else { 0.0 }))
}

/// Direction of density |cos θ|/π on the side of `wo`.
#[inline]
pub(super) fn sample_cosine(wo: Vec3, u: [f32; 2]) -> Vec3 {
    let wi = cosine_hemisphere(u);
    Vec3::new(wi.x, wi.y, wi.z.copysign(wo.z))
}
