//! Bidirectional scattering distribution functions.
//!
//! Everything here works in the local shading frame (z = ns). `wo` and `wi` are unit vectors that point away from
//! the surface; one is below the horizon where light is transmitted. Numbers come in, `Option<Sample>` goes out.
//!
//! Lobes are small, immutable and bound to no direction; [`Bsdf::towards`] looks up what one direction needs, once.
//!
//! z always points to the front (outside). Opaque lobes are two-sided; dielectrics take the side from the sign of wo.z.
//! A [`Bsdf`] is a sum of [`Lobe`]s; each lobe family has its file:
//!
//! | file | lobes |
//! | --- | --- |
//! | `lambert` | Lambert; diffuse base coupled to a specular coat |
//! | `diffuse_transmission` | diffuse to the other side |
//! | `eon` | rough diffuse |
//! | `smooth` | mirror and smooth metal, smooth dielectric, straight transmission |
//! | `rough_reflection` | GGX and Cook–Torrance reflection; GGX transmission through a thin sheet |
//! | `rough_dielectric` | GGX reflection and refraction |
//! | `sheen` | fibres |
//! | `mixture`, `toward` | the sum, and what is drawn from it seen from one direction |
//! | `entry`, `layer` | a lobe in its frame, and beneath the layers that dim it |
//! | `phong` | Phong |
//! | `filmed_dielectric` | smooth and rough dielectric under a thin film |
//! | `fresnel`, `thin_film`, `angular`, `ggx`, `beckmann`, `energy` | what they share: reflectance, microsurface, multiple scattering |

mod angular;
pub mod beckmann;
mod diffuse_transmission;
mod energy;
mod entry;
mod eon;
mod filmed_dielectric;
pub mod fresnel;
pub mod ggx;
mod lambert;
mod layer;
mod lobe;
mod mixture;
mod phong;
mod rough_dielectric;
mod rough_reflection;
mod sheen;
mod smooth;
mod specimens;
mod thin_film;
mod toward;

pub use angular::Angular;
pub use beckmann::Beckmann;
pub use energy::{DielectricEnergy, DielectricPair, Energy, EnergyAt, EnergyTable, FilmedEnergy, Interface};
pub use entry::MAX_LAYERS;
pub use eon::Eon;
pub use filmed_dielectric::{FilmedDielectric, RoughFilmedDielectric};
pub use fresnel::{Fit, Fresnel};
pub use ggx::{Ggx, MIN_ALPHA};
pub use lambert::{Coat, CoupledDiffuse, Lambert};
pub use layer::Layer;
pub use lobe::Lobe;
pub use mixture::{Bsdf, MAX_LOBES, MOST_DELTAS};
pub use phong::Phong;
pub use rough_dielectric::RoughDielectric;
pub use rough_reflection::{Micro, Microsurface, RoughReflection, RoughThin, multiple_scattering};
pub use sheen::{Sheen, SheenAlbedo};
pub use smooth::{Delta, Mirror, SmoothDielectric, ThinTransmission};
pub use specimens::{Lazy, Specimen, specimens};
pub use thin_film::ThinFilm;
pub use toward::{BsdfAt, Scratch, Toward};

use crate::spectrum::Spectrum;
use glam::Vec3;

/// What is carried along the path: radiance from lights to the eye (paths traced from the camera), or importance
/// (particles traced from lights). Refraction scales radiance by 1/η², importance not (Veach 1997, section 5.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transport {
    /// The path was traced from the camera.
    Radiance,
    /// The path was traced from a light.
    Importance,
}

/// The two letters of light path expressions: diffuse (Lambertian) or specular (mirror-like or glossy).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// Lambertian.
    Diffuse,
    /// Microfacet, mirror or refraction.
    Specular,
}

/// How likely a direction was drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pdf {
    /// Density over solid angle \[1/sr\], of the whole non-delta part of the BSDF.
    SolidAngle(f32),
    /// Probability of a direction from a delta distribution.
    Discrete(f32),
}

/// A drawn direction.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// The direction, local, unit.
    pub wi: Vec3,
    /// f |cos θi| / pdf, of all non-delta lobes together, or of the delta lobe that was drawn.
    pub weight: Spectrum,
    /// The part of `weight` that specular lobes give; all of it or nothing where one class was present.
    pub specular: Spectrum,
    /// Density or probability of the draw, the choice among lobes included.
    pub pdf: Pdf,
    /// Relative index of refraction crossed: η of the side of `wi` over η of the side of `wo`; 1 for a reflection.
    pub eta: f32,
}

/// The non-delta part of a BSDF for two directions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Eval {
    /// f \[1/sr\], without the cosine.
    pub f: Spectrum,
    /// The part of `f` that specular lobes give.
    pub specular: Spectrum,
    /// Density \[1/sr\] with which `sample` draws `wi`, the choice among lobes included. It integrates over the
    /// sphere to one minus the probability of the delta lobes (and of failed draws).
    pub pdf: f32,
    /// Density \[1/sr\] with which a draw from `wi` takes `wo`.
    pub pdf_rev: f32,
}
