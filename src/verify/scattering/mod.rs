//! Scattering functions under test: ours, those of a user's file, and anyone's own.
//!
//! A [`Scattering`] is three functions: `sample`, `eval` and `pdf`. What must hold of them is in the files here, one
//! question each; [`check`] asks them all.
//!
//! | file | what must hold |
//! | --- | --- |
//! | `density` | samples follow `pdf` (χ²), and ∫ pdf + deltas + failures = 1 |
//! | `identities` | `sample().pdf` = `pdf(wi)`, weight = f \|cos\|/pdf, f(a, b) = f(b, a); nothing is negative or no number |
//! | `reverse` | what is said of the density from the other end is the density there, by value and by χ² |
//! | `energy` | the directional albedo is at most 1, or is 1 |
//! | `bins`, `quadrature` | cells that follow the draws of a function, however narrow its lobes, and integrals over them |
//!
//! In the tests of another project:
//!
//! ```
//! use radianza::glam::DVec3;
//! use radianza::verify::scattering::{Claims, Closures, Density, Draw, Scattering, check};
//! use radianza::verify::{Findings, Size, Trial};
//! use radianza::warp::cosine_hemisphere;
//! use std::f64::consts::FRAC_1_PI;
//!
//! // Lambert's lobe of albedo 0.8, and one whose author forgot the 1/π.
//! fn lambert(f: f64) -> impl Scattering {
//!     Closures {
//!         sample: move |_: DVec3, [_, u, v]: [f32; 3]| {
//!             let wi = cosine_hemisphere([u, v]).as_dvec3();
//!             let pdf = wi.z * FRAC_1_PI;
//!             let weight = [f * wi.z / pdf; 3];
//!             (pdf > 0.0).then_some(Draw { wi, weight, density: Density::SolidAngle(pdf), eta: 1.0 })
//!         },
//!         eval: move |_, wi: DVec3| if wi.z > 0.0 { [f; 3] } else { [0.0; 3] },
//!         pdf: |_, wi: DVec3| wi.z.max(0.0) * FRAC_1_PI,
//!     }
//! }
//!
//! let trial = Trial { seed: 1, size: Size::Default };
//! let ask = |f: f64| {
//!     let mut found = Findings::new("Lambert");
//!     check(&mut found, &trial, "lambert", &lambert(f), &Claims::default());
//!     found
//! };
//! let right = ask(0.8 * FRAC_1_PI);
//! assert!(right.checks.passes(), "{}", right.checks);
//! let wrong = ask(0.8);
//! assert!(!wrong.checks.passes());
//! assert!(wrong.checks.failures().all(|check| check.name.contains("albedo ≤ 1")));
//! println!("{}", wrong.words.join("; ")); // lambert: sends on 2.5133 of the light at every angle
//! ```

mod bins;
mod bsdf;
mod density;
mod energy;
mod identities;
mod quadrature;
mod reverse;
mod suite;

pub use density::{Integrals, density, integrals};
pub use energy::{Sampled, energy, sampled};
pub use identities::{draws, reciprocity};
pub use reverse::{Reversed, reverse};
pub use suite::check;

use glam::DVec3;

/// Red, green and blue; a grey function repeats its value.
pub type Rgb = [f64; 3];

/// A function that scatters light, in a local frame: z is the surface's normal, directions are unit vectors that point
/// away from the surface, and one of the two is below the horizon where light is transmitted.
///
/// `wo` is where light comes from and `wi` where it goes (or the other way round, by reciprocity). Across a refracting
/// interface the function is that of energy (importance transport): without the factor 1/η² of radiance, so that what
/// leaves can be compared with what arrives.
pub trait Scattering: Sync {
    /// Draws `wi` for three numbers in \[0, 1); `None` where the draw fails and counts as nothing.
    fn sample(&self, wo: DVec3, u: [f32; 3]) -> Option<Draw>;

    /// f \[1/sr\], without the cosine and without deltas.
    fn eval(&self, wo: DVec3, wi: DVec3) -> Rgb;

    /// Density \[1/sr\] with which [`sample`](Self::sample) draws `wi`, other than as a delta. Over the sphere it
    /// integrates to 1, less the probabilities of deltas and of failures.
    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64;

    /// `eval` and `pdf` together, for those that have both at the price of one.
    fn both(&self, wo: DVec3, wi: DVec3) -> (Rgb, f64) {
        (self.eval(wo, wi), self.pdf(wo, wi))
    }

    /// What is said at `wo` of the density \[1/sr\] with which a draw from `wi` takes `wo`, where anything is: it must be
    /// `pdf(wi, wo)`. Paths that are joined in the middle weigh by it.
    fn pdf_rev(&self, _wo: DVec3, _wi: DVec3) -> Option<f64> {
        None
    }
}

/// A direction drawn by a [`Scattering`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draw {
    /// The direction.
    pub wi: DVec3,
    /// f |cos θi| / pdf; of a delta, its energy over its probability.
    pub weight: Rgb,
    /// How likely it was.
    pub density: Density,
    /// Index of refraction of the side of `wi` over that of the side of `wo`: 1 for reflections and for thin sheets.
    pub eta: f64,
}

/// How likely a direction was drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Density {
    /// Density over solid angle \[1/sr\].
    SolidAngle(f64),
    /// Probability of a delta.
    Discrete(f64),
}

impl<S: Scattering + ?Sized> Scattering for &S {
    fn sample(&self, wo: DVec3, u: [f32; 3]) -> Option<Draw> {
        (**self).sample(wo, u)
    }
    fn eval(&self, wo: DVec3, wi: DVec3) -> Rgb {
        (**self).eval(wo, wi)
    }
    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        (**self).pdf(wo, wi)
    }
    fn both(&self, wo: DVec3, wi: DVec3) -> (Rgb, f64) {
        (**self).both(wo, wi)
    }
    fn pdf_rev(&self, wo: DVec3, wi: DVec3) -> Option<f64> {
        (**self).pdf_rev(wo, wi)
    }
}

/// A [`Scattering`] of three closures.
#[derive(Clone, Copy, Debug)]
pub struct Closures<S, E, P> {
    /// [`Scattering::sample`].
    pub sample: S,
    /// [`Scattering::eval`].
    pub eval: E,
    /// [`Scattering::pdf`].
    pub pdf: P,
}

impl<S, E, P> Scattering for Closures<S, E, P>
where
    S: Fn(DVec3, [f32; 3]) -> Option<Draw> + Sync,
    E: Fn(DVec3, DVec3) -> Rgb + Sync,
    P: Fn(DVec3, DVec3) -> f64 + Sync,
{
    fn sample(&self, wo: DVec3, u: [f32; 3]) -> Option<Draw> {
        (self.sample)(wo, u)
    }
    fn eval(&self, wo: DVec3, wi: DVec3) -> Rgb {
        (self.eval)(wo, wi)
    }
    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        (self.pdf)(wo, wi)
    }
}

/// What a function claims of itself, and how exact its arithmetic is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Claims {
    /// All light that arrives leaves again: the albedo is 1, not only at most 1.
    pub lossless: bool,
    /// f(a, b) = f(b, a), and f(a → b)/η_b² = f(b → a)/η_a² across an interface.
    pub reciprocal: bool,
    /// Light may arrive from below as well.
    pub two_sided: bool,
    /// Relative error that arithmetic and tables may make in energy.
    pub granted: f64,
    /// Relative error that arithmetic may make in f and pdf at one pair of directions.
    pub rounding: f64,
}

impl Default for Claims {
    /// Reciprocal and one-sided in f32.
    fn default() -> Self {
        Self { lossless: false, reciprocal: true, two_sided: false, granted: 1e-4, rounding: 1e-3 }
    }
}

/// Direction of cosine `mu` to the normal, negative from below, in some general azimuth.
pub fn at_cosine(mu: f64) -> DVec3 {
    let r = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
    DVec3::new(0.8 * r, 0.6 * r, mu)
}
