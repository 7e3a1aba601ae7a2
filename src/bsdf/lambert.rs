//! Diffuse lobes: Lambert's, and the one that glows through a specular coat.

use super::Fresnel;
use super::angular::Angular;
use super::energy::Slice;
use super::fresnel::pow5;
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
/// f = ρ/π (1 − E_s(o)) (1 − E_s(i)) / (1 − E_s,avg)
/// ```
///
/// (Ashikhmin & Shirley 2000 in the form of Kelemen & Szirmay-Kalos 2001), per lane.
#[derive(Clone, Copy, Debug)]
pub struct CoupledDiffuse {
    /// ρ/(1 − E_s,avg).
    scaled: Spectrum,
    average: Spectrum,
    coat: Coat,
    /// In place of Schlick's terms.
    film: Option<FilmCoat>,
}

/// Reflectance of a coat under a thin film.
#[derive(Clone, Copy, Debug)]
enum FilmCoat {
    Smooth(Fresnel),
    /// By its series; the energy is that of the coat.
    Rough(Angular),
}

impl FilmCoat {
    /// 1 − E_s towards `w`.
    #[inline]
    fn transmitted(&self, w: Vec3, coat: &Coat) -> Spectrum {
        let e = match (self, &coat.energy) {
            (Self::Smooth(fresnel), _) => fresnel.eval(w.z.abs().min(1.0)),
            (Self::Rough(series), Some(energy)) => energy.reflected(series, w) + coat.f_ms * energy.at(w).loss,
            (Self::Rough(_), None) => Spectrum::ONE,
        };
        (Spectrum::ONE - e).max(Spectrum::ZERO)
    }

    fn transmitted_average(&self, coat: &Coat) -> Spectrum {
        let e = match (self, &coat.energy) {
            (Self::Smooth(fresnel), _) => fresnel.average(),
            (Self::Rough(series), Some(energy)) => energy.reflected_mean(series) + coat.f_ms * energy.mean.loss,
            (Self::Rough(_), None) => Spectrum::ONE,
        };
        (Spectrum::ONE - e).max(Spectrum::ZERO)
    }
}

/// Albedo of a specular coat by Schlick's terms, multiple scattering included.
#[derive(Clone, Copy, Debug)]
pub struct Coat {
    /// F at normal incidence.
    pub f0: Spectrum,
    /// F at grazing incidence.
    pub f90: Spectrum,
    /// F_ms of the multiply scattered part.
    pub f_ms: Spectrum,
    /// Energy of the microsurface; none where the coat is smooth.
    pub energy: Option<Slice>,
}

impl Coat {
    /// No coat: everything passes.
    pub const NONE: Self = Self { f0: Spectrum::ZERO, f90: Spectrum::ZERO, f_ms: Spectrum::ZERO, energy: None };

    /// A colourless smooth coat of this F₀.
    pub fn smooth(f0: f32) -> Self {
        Self { f0: Spectrum::splat(f0), f90: Spectrum::ONE, f_ms: Spectrum::ZERO, energy: None }
    }

    /// 1 − E_s towards `w`, in [0, 1].
    #[inline]
    pub fn transmitted(&self, w: Vec3) -> Spectrum {
        let (loss, schlick) = match &self.energy {
            None => (0.0, pow5(1.0 - w.z.abs().min(1.0))),
            Some(slice) => {
                let e = slice.at(w);
                (e.loss, e.parts[0])
            }
        };
        self.complement(loss, schlick)
    }

    /// 1 − E_s,avg, the cosine-weighted mean over the hemisphere.
    pub fn transmitted_average(&self) -> Spectrum {
        let (loss, schlick) = self.energy.map_or((0.0, 1.0 / 21.0), |e| (e.mean.loss, e.mean.parts[0]));
        self.complement(loss, schlick)
    }

    #[inline]
    fn complement(&self, loss: f32, schlick: f32) -> Spectrum {
        let e = self.f0 * (1.0 - loss - schlick) + self.f90 * schlick + self.f_ms * loss;
        (Spectrum::ONE - e).max(Spectrum::ZERO)
    }
}

impl CoupledDiffuse {
    /// Base of albedo `reflectance` under `coat`.
    pub fn new(reflectance: Spectrum, coat: Coat) -> Self {
        Self::with(reflectance, coat, coat.transmitted_average(), None)
    }

    /// Base under a coat whose reflectance is not Schlick's: of `coat`, only the energy and F_ms count.
    pub fn under(reflectance: Spectrum, coat: Coat, fresnel: Fresnel) -> Self {
        let film = match (coat.energy, fresnel.angular()) {
            (_, None) => return Self::new(reflectance, coat),
            (None, Some(_)) => FilmCoat::Smooth(fresnel),
            (Some(_), Some(series)) => FilmCoat::Rough(series.covering()),
        };
        Self::with(reflectance, coat, film.transmitted_average(&coat), Some(film))
    }

    fn with(reflectance: Spectrum, coat: Coat, average: Spectrum, film: Option<FilmCoat>) -> Self {
        // Where a coat lets nothing through there is no base to be seen.
        let scaled = reflectance.div_or_zero(average.map(|t| if t > 1e-6 { t } else { 0.0 }));
        Self { scaled, average, coat, film }
    }

    /// The same base beneath further layers, which scale f by T(o) T(i): 1 − E_s,avg becomes the mean ⟨T (1 − E_s)⟩, which
    /// `mean` finds, given the microsurface that 1 − E_s depends on and 1 − E_s itself.
    pub(super) fn beneath(&self, mean: impl Fn(Option<&Slice>, &dyn Fn(Vec3) -> Spectrum) -> Spectrum) -> Self {
        let average = mean(self.coat.energy.as_ref(), &|w| self.transmitted(w));
        let reflectance = self.scaled * self.average;
        let scaled = reflectance.div_or_zero(average.map(|t| if t > 1e-6 { t } else { 0.0 }));
        Self { scaled, average, ..*self }
    }

    pub(super) fn energy_mut(&mut self) -> Option<&mut Slice> {
        self.coat.energy.as_mut()
    }

    pub(super) fn is_anisotropic(&self) -> bool {
        self.coat.energy.is_some_and(|energy| energy.is_anisotropic())
    }

    /// f \[1/sr\] for directions on the same side.
    #[inline]
    pub(super) fn f(&self, wo: Vec3, wi: Vec3) -> Spectrum {
        self.scaled * self.transmitted(wo) * self.transmitted(wi) * FRAC_1_PI
    }

    /// Directional albedo.
    #[inline]
    pub(super) fn albedo(&self, wo: Vec3) -> Spectrum {
        self.scaled * self.transmitted(wo) * self.average
    }

    #[inline]
    fn transmitted(&self, w: Vec3) -> Spectrum {
        match &self.film {
            None => self.coat.transmitted(w),
            Some(film) => film.transmitted(w, &self.coat),
        }
    }
}

/// Direction of density |cos θ|/π on the side of `wo`.
#[inline]
pub(super) fn sample_cosine(wo: Vec3, u: [f32; 2]) -> Vec3 {
    let wi = cosine_hemisphere(u);
    Vec3::new(wi.x, wi.y, wi.z.copysign(wo.z))
}
