//! Lights, and choosing one.
//!
//! A light answers three questions: what arrives at a point from a direction that was drawn towards it
//! ([`Light::sample`]), how likely a direction that met it otherwise would have been drawn ([`Light::pdf`]), and what
//! it emits where it was met ([`Light::le`]). [`Lights`] asks one of many: chosen by power where they are
//! few, by a tree of what they can send ([`tree`]) where they are many.

mod alias;
mod area;
mod cells;
mod choose;
mod directional;
mod emitter;
mod environment;
mod grid;
mod point;
mod profile;
mod quadric;
mod receiver;
mod sampler;
mod specimens;
mod spherical_triangle;
mod spot;
mod sun;
pub mod tree;
mod triangle;

pub use alias::Alias;
pub use choose::Lights;
pub use directional::DirectionalLight;
pub use emitter::Emitter;
pub use environment::{Environment, Texels};
pub use point::PointLight;
pub use profile::ProfileLight;
pub use quadric::QuadricLight;
pub use receiver::{Facing, LightSampleContext};
pub use sampler::LightSampler;
pub use specimens::{Specimen, specimens};
pub use spherical_triangle::SphericalTriangle;
pub use spot::SpotLight;
pub use sun::SunLight;
pub use triangle::TriangleLight;

use crate::bsdf::Pdf;
use crate::desc;
use crate::math::Ray;
use crate::shape::{Primitive, Surface};
use crate::spectrum::Spectrum;
use crate::texture::Textures;
use glam::{Vec2, Vec3A, Vec4};
use tree::LightBounds;

/// Light drawn towards a point: Lₑ (or intensity over squared distance, or irradiance) that arrives from `wi`.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Direction from the point to the light, unit, world space.
    pub wi: Vec3A,
    /// How far it is to the point of the light \[m\]; infinite for light from infinity.
    pub distance: f32,
    /// The point of the light; of no meaning for light from infinity.
    pub p: Vec3A,
    /// By how much a shadow ray ends short of that \[m\], so that it does not meet the neighbours of a triangle, which go on
    /// where that ends: rounding moves the point off the surface. The light's own primitive is excluded from the ray.
    pub margin: f32,
    /// Arriving radiance \[W·sr⁻¹·m⁻²\], of a surface with holes times its coverage; for delta lights irradiance
    /// perpendicular to `wi` \[W/m²\].
    pub le: Spectrum,
    /// Density over solid angle at the point, or the probability of a delta light; the choice among lights included
    /// where the sample was drawn from all of them.
    pub pdf: Pdf,
}

impl LightSample {
    #[inline]
    fn from_infinity(wi: Vec3A, le: Spectrum, pdf: Pdf) -> Self {
        Self { wi, distance: f32::INFINITY, p: Vec3A::ZERO, margin: 0.0, le, pdf }
    }
}

/// A source of light. The large ones are boxed, so that a million emissive triangles stay compact.
#[derive(Clone, Debug)]
pub enum Light {
    /// Emissive triangle.
    Triangle(TriangleLight),
    /// Emissive sphere, disk or cylinder.
    Quadric(Box<QuadricLight>),
    /// Radiates alike in all directions from a point.
    Point(PointLight),
    /// Radiates into a cone from a point.
    Spot(SpotLight),
    /// Radiates from a point as was measured.
    Profile(Box<ProfileLight>),
    /// Parallel light.
    Directional(DirectionalLight),
    /// A disk at infinity.
    Sun(Box<SunLight>),
    /// Light from all around, at infinity.
    Environment(Box<Environment>),
}

impl Light {
    /// The light without a surface that was written.
    pub fn from_desc(light: &desc::Light) -> Self {
        match *light {
            desc::Light::Point { position, intensity, range } => {
                Self::Point(PointLight::new(position, intensity, range))
            }
            desc::Light::Spot { position, direction, intensity, inner, outer, range } => {
                Self::Spot(SpotLight::new(position, direction, intensity, [inner, outer], range))
            }
            desc::Light::Profile { position, to_world, intensity, ref profile } => {
                Self::Profile(Box::new(ProfileLight::new(position, to_world, intensity, profile.clone())))
            }
            desc::Light::Directional { direction, irradiance } => {
                Self::Directional(DirectionalLight::new(direction, irradiance))
            }
            desc::Light::Sun { direction, irradiance, diameter } => {
                Self::Sun(Box::new(SunLight::new(direction, irradiance, diameter)))
            }
        }
    }

    /// Draws light that arrives at `p`, nothing in between considered; `None` where the draw carries none.
    #[inline(always)]
    pub fn sample(&self, p: Vec3A, u: [f32; 2], textures: &Textures) -> Option<LightSample> {
        match self {
            Self::Triangle(light) => light.sample(p, u, textures),
            other => other.sample_large(p, u, textures),
        }
    }

    /// [`sample`](Self::sample) of all lights but triangles. Outlined, so that those stay in registers.
    #[inline(never)]
    fn sample_large(&self, p: Vec3A, u: [f32; 2], textures: &Textures) -> Option<LightSample> {
        match self {
            Self::Triangle(light) => light.sample(p, u, textures),
            Self::Quadric(light) => light.sample(p, u, textures),
            Self::Point(light) => light.sample(p),
            Self::Spot(light) => light.sample(p),
            Self::Profile(light) => light.sample(p),
            Self::Directional(light) => light.sample(),
            Self::Sun(light) => light.sample(u),
            Self::Environment(light) => light.sample(u),
        }
    }

    /// Density over solid angle \[1/sr\] with which [`sample`](Self::sample) at `reference` draws the direction to
    /// the point `p` of this area light, whose geometric normal there is `ng` (either side); 0 for other lights.
    #[inline]
    pub fn pdf(&self, reference: Vec3A, p: Vec3A, ng: Vec3A) -> f32 {
        match self {
            Self::Triangle(light) => light.pdf(reference, p, ng),
            Self::Quadric(light) => light.pdf(reference, p, ng),
            Self::Point(_)
            | Self::Spot(_)
            | Self::Profile(_)
            | Self::Directional(_)
            | Self::Sun(_)
            | Self::Environment(_) => 0.0,
        }
    }

    /// Radiance that this area light emits at the point with these texture coordinates and vertex colour in the direction
    /// of cosine `cos` to its normal, negative to the back; 0 for other lights.
    #[inline]
    pub fn le(&self, uv: &[Vec2; 2], color: Vec4, cos: f32, textures: &Textures) -> Spectrum {
        match self {
            Self::Triangle(light) => light.emitter.le(uv, color, cos, textures),
            Self::Quadric(light) => light.emitter.le(uv, color, cos, textures),
            Self::Point(_)
            | Self::Spot(_)
            | Self::Profile(_)
            | Self::Directional(_)
            | Self::Sun(_)
            | Self::Environment(_) => Spectrum::ZERO,
        }
    }

    /// Whether its surface emits more in some places than in others.
    pub fn is_pictured(&self) -> bool {
        match self {
            Self::Triangle(light) => light.is_pictured(),
            Self::Quadric(light) => light.is_pictured(),
            _ => false,
        }
    }

    /// Finds the mean of what the surface shows, and its bright parts, in at most `lookups` look-ups.
    pub fn divide(&mut self, textures: &Textures, lookups: usize) {
        match self {
            Self::Triangle(light) => light.divide(textures, lookups),
            Self::Quadric(light) => light.divide(textures, lookups),
            _ => {}
        }
    }

    /// Radiant flux \[W\]; of light from infinity, what enters a sphere of `scene_radius`; of what surfaces show the mean,
    /// once [`divide`](Self::divide) has looked.
    pub fn power(&self, scene_radius: f32) -> Spectrum {
        match self {
            Self::Triangle(light) => light.power(),
            Self::Quadric(light) => light.power(),
            Self::Point(light) => light.power(),
            Self::Spot(light) => light.power(),
            Self::Profile(light) => light.power(),
            Self::Directional(light) => light.power(scene_radius),
            Self::Sun(light) => light.power(scene_radius),
            Self::Environment(light) => light.power(scene_radius),
        }
    }

    /// Where it stands and where it shines to, its flux having the luminance `flux` > 0; `None` for light from infinity.
    pub fn bounds(&self, flux: f64) -> Option<LightBounds> {
        match self {
            Self::Triangle(light) => Some(light.bounds(flux)),
            Self::Quadric(light) => Some(light.bounds(flux)),
            Self::Point(light) => Some(light.bounds(flux)),
            Self::Spot(light) => Some(light.bounds()),
            Self::Profile(light) => Some(light.bounds(flux)),
            Self::Directional(_) | Self::Sun(_) | Self::Environment(_) => None,
        }
    }

    /// Nearest intersection of `ray` with the surface of this area light alone: what the tests, and anything else that
    /// has one light and no scene, trace.
    pub fn intersect(&self, ray: &Ray) -> Option<(f32, Surface)> {
        self.primitive()?.meet(ray)
    }

    /// The surface of an area light.
    pub fn primitive(&self) -> Option<Primitive> {
        match self {
            Self::Triangle(light) => Some(light.primitive()),
            Self::Quadric(light) => Some(Primitive::Quadric(light.shape)),
            Self::Point(_)
            | Self::Spot(_)
            | Self::Profile(_)
            | Self::Directional(_)
            | Self::Sun(_)
            | Self::Environment(_) => None,
        }
    }

    /// Radiance from infinity along the unit vector `wi`; 0 of other lights.
    #[inline]
    pub fn le_from(&self, wi: Vec3A) -> Spectrum {
        match self {
            Self::Environment(light) => light.le(wi),
            Self::Sun(light) => light.le(wi),
            _ => Spectrum::ZERO,
        }
    }

    /// Radiance from infinity along the unit vector `wi`, and the density over solid angle with which
    /// [`sample`](Self::sample) draws it; 0 of other lights.
    #[inline]
    pub fn le_and_pdf_from(&self, wi: Vec3A) -> (Spectrum, f32) {
        match self {
            Self::Environment(light) => light.le_and_pdf(wi),
            Self::Sun(light) => (light.le(wi), light.pdf(wi)),
            _ => (Spectrum::ZERO, 0.0),
        }
    }

    /// Whether a ray that leaves the scene may meet it.
    #[inline]
    pub fn surrounds(&self) -> bool {
        matches!(self, Self::Environment(_) | Self::Sun(_))
    }

    /// True where light comes from one direction only, which no other sampling can meet.
    pub fn is_delta(&self) -> bool {
        matches!(self, Self::Point(_) | Self::Spot(_) | Self::Profile(_) | Self::Directional(_))
    }
}
