//! Fresnel reflectance: exact for dielectrics and metals, Schlick's approximation for authored colours.

use super::angular::Angular;
use super::thin_film::ThinFilm;
use crate::math::sqr;
use crate::spectrum::Spectrum;
use glam::{Vec3, Vec4};

/// Reflectance of a conductor, or of a layer whose reflectance is authored, over the angle.
#[derive(Clone, Debug, PartialEq)]
pub enum Fresnel {
    /// F = F₀ + (F₉₀ − F₀)(1 − cos θ)⁵ (Schlick 1994).
    Schlick {
        /// Reflectance at normal incidence.
        f0: Spectrum,
        /// Reflectance at grazing incidence.
        f90: f32,
    },
    /// This much at every angle.
    Constant(Spectrum),
    /// Exact; made by [`Fresnel::complex`].
    Complex(Box<Conductor>),
    /// Under a thin film, wholly or in part; made by [`Fresnel::under_film`].
    Film(Box<Film>),
}

/// A metal's index, and what follows of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    /// Real part of the index η − iκ per lane over the outside, and the extinction κ.
    eta: Vec4,
    k: Vec4,
    fit: Fit,
}

/// Schlick's approximation beside bases under one film, f = F₀ + (F₉₀ − F₀)(1 − cos θ)⁵ + Σ weight · film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    f0: Spectrum,
    f90: f32,
    film: ThinFilm,
    bases: [Base; 2],
    fit: Fit,
}

/// What a film lies on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Base {
    weight: f32,
    /// √F₀ of the base alone.
    root: Vec4,
}

/// F ≈ F₀ + (F₉₀ − F₀)(1 − c)⁵ − k c(1 − c)⁶ over the cosine c (the form of Hoffman 2019, "Fresnel Equations Considered
/// Harmful").
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fit {
    /// F₀.
    pub f0: Spectrum,
    /// F₉₀.
    pub f90: Spectrum,
    /// k.
    pub k: Spectrum,
}

impl Fit {
    /// Exact at normal and grazing incidence and in the mean over the hemisphere.
    fn new(f0: Spectrum, f90: Spectrum, average: Spectrum) -> Self {
        // The means of (1 − c)⁵ and c(1 − c)⁶ are 1/21 and 1/126.
        Self { f0, f90, k: (Spectrum::lerp(f0, f90, 1.0 / 21.0) - average) * 126.0 }
    }

    #[inline]
    fn average(&self) -> Spectrum {
        Spectrum::lerp(self.f0, self.f90, 1.0 / 21.0) - self.k * (1.0 / 126.0)
    }

    #[inline]
    fn eval(&self, cos: f32) -> Spectrum {
        let x = 1.0 - cos;
        let fifth = pow5(x);
        (Spectrum::lerp(self.f0, self.f90, fifth) - self.k * (cos * x * fifth)).max(Spectrum::ZERO)
    }
}

impl Film {
    fn new(f0: Spectrum, f90: f32, film: ThinFilm, bases: [Base; 2]) -> Self {
        let mut new = Self { f0, f90, film, bases, fit: Fit::default() };
        let average = Angular::new(|cos| new.eval(cos)).average();
        new.fit = Fit::new(new.eval(1.0), new.eval(0.0), average);
        new
    }

    #[inline]
    fn eval(&self, cos: f32) -> Spectrum {
        let mut f = Spectrum::lerp(self.f0, Spectrum::splat(self.f90), pow5(1.0 - cos));
        for base in self.bases.iter().filter(|b| b.weight > 0.0) {
            f += self.film.reflectance(cos, base.root) * base.weight;
        }
        f
    }
}

impl Fresnel {
    /// Reflects everything at every angle.
    pub const ONE: Self = Self::Constant(Spectrum::ONE);

    /// Schlick's approximation, `f90` at the grazing angle.
    #[inline]
    pub fn schlick(f0: Spectrum, f90: f32) -> Self {
        Self::Schlick { f0, f90 }
    }

    /// Metal of index η − iκ per lane over the outside.
    pub fn complex(eta: Vec4, k: Vec4) -> Self {
        // Midpoint rule for 2 ∫ F μ dμ in s = √μ: its nodes crowd at the grazing angle, where metals rise.
        const N: u32 = 256;
        let node = |i: u32| (i as f32 + 0.5) / N as f32;
        let term = |i| conductor(sqr(node(i)), eta, k) * (4.0 * node(i).powi(3) / N as f32);
        let fit = Fit::new(conductor(1.0, eta, k), conductor(0.0, eta, k), (0..N).map(term).sum());
        Self::Complex(Box::new(Conductor { eta, k, fit }))
    }

    /// A base that reflects `f0` at normal incidence, by Schlick's approximation where it is bare and by Airy's sum on the
    /// `share` of it that is under the film; `weight` times all of it.
    pub fn under_film(film: ThinFilm, share: f32, f0: Spectrum, weight: f32) -> Self {
        let bare = weight * (1.0 - share);
        let base = Base { weight: weight * share, root: f0.map(|f| f.clamp(0.0, 1.0).sqrt()).0 };
        let bases = [base, Base { weight: 0.0, root: Vec4::ZERO }];
        Self::Film(Box::new(Film::new(f0 * bare, bare, film, bases)))
    }

    /// a · `self` + b · `other`, for two of Schlick's or two under the same film.
    pub fn mixed(&self, a: f32, other: &Self, b: f32) -> Self {
        match (self, other) {
            (Self::Film(x), Self::Film(y)) => {
                let base = |f: &Film, weight: f32| Base { weight: f.bases[0].weight * weight, ..f.bases[0] };
                let fit = Fit {
                    f0: x.fit.f0 * a + y.fit.f0 * b,
                    f90: x.fit.f90 * a + y.fit.f90 * b,
                    k: x.fit.k * a + y.fit.k * b,
                };
                let bases = [base(x, a), base(y, b)];
                Self::Film(Box::new(Film {
                    f0: x.f0 * a + y.f0 * b,
                    f90: x.f90 * a + y.f90 * b,
                    film: x.film,
                    bases,
                    fit,
                }))
            }
            (Self::Schlick { f0, f90 }, Self::Schlick { f0: g0, f90: g90 }) => {
                Self::schlick(*f0 * a + *g0 * b, f90 * a + g90 * b)
            }
            _ => {
                let (f, g) = (self.fit(), other.fit());
                Self::schlick(f.f0 * a + g.f0 * b, f.f90.max_element() * a + g.f90.max_element() * b)
            }
        }
    }

    /// Reflectance at the angle of cosine `cos` ≥ 0.
    #[inline]
    pub fn eval(&self, cos: f32) -> Spectrum {
        match self {
            Self::Schlick { f0, f90 } => Spectrum::lerp(*f0, Spectrum::splat(*f90), pow5(1.0 - cos)),
            Self::Constant(f) => *f,
            Self::Complex(metal) => conductor(cos, metal.eta, metal.k),
            Self::Film(film) => film.eval(cos),
        }
    }

    /// About [`Self::eval`], of metals and films by their fit: quicker, and enough to choose by.
    #[inline]
    pub(super) fn estimate(&self, cos: f32) -> Spectrum {
        match self {
            Self::Schlick { .. } | Self::Constant(_) => self.eval(cos),
            Self::Complex(metal) => metal.fit.eval(cos),
            Self::Film(film) => film.fit.eval(cos),
        }
    }

    /// Cosine-weighted mean over the hemisphere, 2 ∫ F(μ) μ dμ.
    #[inline]
    pub fn average(&self) -> Spectrum {
        match self {
            Self::Schlick { f0, f90 } => Spectrum::lerp(*f0, Spectrum::splat(*f90), 1.0 / 21.0),
            Self::Constant(f) => *f,
            Self::Complex(metal) => metal.fit.average(),
            Self::Film(film) => film.fit.average(),
        }
    }

    /// The series that rough surfaces sum their energy by; none for Schlick's, whose own two terms are tabulated.
    pub fn angular(&self) -> Option<Angular> {
        match self {
            Self::Schlick { .. } | Self::Constant(_) => None,
            Self::Complex(_) | Self::Film(_) => Some(Angular::new(|cos| self.eval(cos))),
        }
    }

    /// Its terms, or those that fit it: exact for Schlick.
    #[inline]
    pub fn fit(&self) -> Fit {
        match self {
            Self::Schlick { f0, f90 } => Fit { f0: *f0, f90: Spectrum::splat(*f90), k: Spectrum::ZERO },
            Self::Constant(f) => Fit { f0: *f, f90: *f, k: Spectrum::ZERO },
            Self::Complex(metal) => metal.fit,
            Self::Film(film) => film.fit,
        }
    }
}

/// Share of emitted light that leaves through a clear coat of index 1.5 on the share `factor` of the surface, at the
/// cosine `cos` to the normal: 1 − c (F₀ + (1 − F₀)(1 − |cos|)⁵), F₀ = 0.04 (KHR_materials_clearcoat).
#[inline]
pub fn through_coat(factor: f32, cos: f32) -> f32 {
    1.0 - factor * (0.04 + 0.96 * pow5(1.0 - cos.abs().min(1.0)))
}

/// x⁵.
#[inline]
pub fn pow5(x: f32) -> f32 {
    sqr(sqr(x)) * x
}

/// Unpolarised reflectance of an interface between dielectrics and the cosine of the refracted angle, for the cosine
/// `cos` ≥ 0 of the angle of incidence and the relative index `eta` = η_t/η_i; (1, 0) beyond the critical angle.
#[inline]
pub fn dielectric(cos: f32, eta: f32) -> (f32, f32) {
    // η² − sin²θ, without the cancellation of 1 − sin²θ/η² at the critical angle.
    let d = (eta - 1.0) * (eta + 1.0) + cos * cos;
    if d <= 0.0 {
        return (1.0, 0.0);
    }
    let g = d.sqrt(); // η cos θ_t
    let cos_t = g / eta;
    let perpendicular = (cos - g) / (cos + g);
    let parallel = (eta * cos - cos_t) / (eta * cos + cos_t);
    (0.5 * (sqr(perpendicular) + sqr(parallel)), cos_t)
}

/// Refracted direction for `wo` on the side of the unit vector `m` (cos = wo·m ≥ 0), by Snell's law.
#[inline]
pub fn refract(wo: Vec3, m: Vec3, cos: f32, cos_t: f32, eta: f32) -> Vec3 {
    (m * (cos / eta - cos_t) - wo / eta).normalize()
}

/// Unpolarised reflectance of a metal of index η − iκ in every lane (Born & Wolf, section 14.2).
#[inline]
pub fn conductor(cos: f32, eta: Vec4, k: Vec4) -> Spectrum {
    let (c2, s2) = (Vec4::splat(cos * cos), Vec4::splat(1.0 - cos * cos));
    let (eta2, k2) = (eta * eta, k * k);
    let t0 = eta2 - k2 - s2;
    let a2b2 = (t0 * t0 + 4.0 * eta2 * k2).map(f32::sqrt);
    let a = (0.5 * (a2b2 + t0)).max(Vec4::ZERO).map(f32::sqrt);
    let (t1, t2) = (a2b2 + c2, 2.0 * cos * a);
    let perpendicular = (t1 - t2) / (t1 + t2);
    let (t3, t4) = (c2 * a2b2 + s2 * s2, t2 * s2);
    // At exactly grazing incidence on an index of 1 both sums vanish; everything is reflected there.
    let ratio = Vec4::select((t3 + t4).cmpgt(Vec4::ZERO), (t3 - t4) / (t3 + t4), Vec4::ONE);
    let f = 0.5 * perpendicular * (Vec4::ONE + ratio);
    Spectrum(Vec4::select((t1 + t2).cmpgt(Vec4::ZERO), f, Vec4::ONE))
}
