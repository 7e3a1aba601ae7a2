//! Materials: what the author wrote, compiled, and at a hit turned into lobes.
//!
//! One file a model: `classic` (mirror, dielectric, conductor, rough diffuse, Phong), `cook_torrance`, `metallic_roughness`
//! (glTF, with the film of `iridescence`), over which `layered` lays sheen and clear coat, and `specular_glossiness` (its
//! forerunner); `interior` is what lies behind a surface, `param` reads parameters and textures, `roughness` holds
//! microsurfaces. What does not vary over the surface is made into lobes once, at compile time.

mod classic;
mod cook_torrance;
mod interior;
mod iridescence;
mod layered;
mod metallic_roughness;
pub mod param;
mod roughness;
mod specular_glossiness;

use crate::bsdf::{Bsdf, BsdfAt, Lobe, Scratch};
use crate::desc::{self, Alpha, ColorParam, Emission, NormalMap, ScalarParam};
use crate::math::Frame;
use crate::shape::Surface;
use crate::spectrum::Spectrum;
use crate::texture::Textures;
use classic::{Conductor, Dielectric};
use cook_torrance::CookTorrance;
use glam::{Vec2, Vec3, Vec3A, Vec4};
pub use interior::interior;
use layered::{Layered, Lie};
use metallic_roughness::MetallicRoughness;
use param::Point;
use specular_glossiness::SpecularGlossiness;

/// A material ready for tracing.
#[derive(Clone, Debug)]
pub struct Material {
    scattering: Scattering,
    /// How it scatters at an interface to something other than vacuum; where it has an interior.
    between: Option<Scattering>,
    emission: Option<Emission>,
    normal_map: Option<NormalMap>,
    alpha: Alpha,
    is_sheet: bool,
}

#[derive(Clone, Debug)]
enum Scattering {
    /// Nothing.
    Absorb,
    /// Constant over the surface: no work at a hit, and never copied.
    Fixed(Box<Bsdf>),
    /// f = Σ weight · f_part.
    Sum(Vec<(f32, Part)>),
}

#[derive(Clone, Debug)]
enum Part {
    /// Constant over the surface: lobes with their layers.
    Fixed(Box<Bsdf>),
    Diffuse(ColorParam),
    Mirror(ColorParam),
    Dielectric(Dielectric),
    Conductor(Conductor),
    MetallicRoughness(Box<MetallicRoughness>),
    Layered(Box<Layered>),
    RoughDiffuse(ColorParam, ScalarParam),
    Phong(ColorParam, f32),
    CookTorrance(CookTorrance),
    SpecularGlossiness(Box<SpecularGlossiness>),
}

impl Part {
    /// It is the same everywhere, on a surface that has its normals bent or not.
    fn is_constant(&self, bent: bool) -> bool {
        match self {
            Self::Fixed(_) => true,
            Self::Diffuse(c) | Self::Mirror(c) => param::is_constant(c),
            Self::Dielectric(d) => d.is_constant(),
            Self::Conductor(c) => c.is_constant(),
            Self::MetallicRoughness(m) => m.is_constant(),
            // A coat keeps the normal of the shape.
            Self::Layered(m) => m.is_constant() && !bent,
            Self::RoughDiffuse(c, r) => param::is_constant(c) && r.texture.is_none(),
            Self::Phong(c, _) => param::is_constant(c),
            Self::CookTorrance(c) => c.is_constant(),
            Self::SpecularGlossiness(m) => m.is_constant(),
        }
    }

    /// Hands the lobes and their factors to `push`, of a model without layers.
    #[inline]
    fn lobes(&self, at: Point, mut push: impl FnMut(Lobe, f32)) {
        match self {
            Self::Diffuse(reflectance) => push(Lobe::lambert(param::share(reflectance, at)), 1.0),
            Self::Mirror(reflectance) => push(classic::mirror(param::share(reflectance, at)), 1.0),
            Self::Dielectric(d) => push(d.lobe(at), 1.0),
            Self::Conductor(c) => push(c.lobe(at), 1.0),
            Self::MetallicRoughness(m) => m.lobes(at, push),
            Self::RoughDiffuse(c, r) => push(classic::diffuse(param::share(c, at), param::scalar(r, at)), 1.0),
            Self::Phong(c, exponent) => push(classic::phong(param::share(c, at), *exponent), 1.0),
            Self::CookTorrance(c) => push(c.lobe(at), 1.0),
            Self::SpecularGlossiness(m) => m.lobes(at, push),
            Self::Fixed(_) | Self::Layered(_) => {}
        }
    }

    /// Adds what scatters at a hit, `weight` times.
    #[inline]
    fn put(&self, at: Point, lie: Lie, weight: f32, bsdf: &mut Bsdf) {
        match self {
            Self::Fixed(fixed) => {
                bsdf.add(fixed, weight);
            }
            Self::Layered(layered) => layered.put(at, lie, weight, bsdf),
            _ => self.lobes(at, |lobe, scale| {
                bsdf.push(lobe, weight * scale);
            }),
        }
    }

    /// What does not vary, made into lobes.
    fn fixed(self, bent: bool) -> Self {
        if !self.is_constant(bent) {
            return self;
        }
        let mut bsdf = Bsdf::new();
        param::nowhere(|at| match &self {
            Self::Layered(layered) => layered.fixed(at, &mut bsdf),
            _ => self.lobes(at, |lobe, scale| {
                bsdf.push(lobe, scale);
            }),
        });
        Self::Fixed(Box::new(bsdf))
    }
}

impl Material {
    /// Resolves tables and constants. Its lobes find room where [`most_lobes`] says so.
    pub fn compile(m: &desc::Material) -> Self {
        let mut parts = Vec::new();
        flatten(&m.model, 1.0, &mut parts);
        parts.sort_by(|a, b| b.0.total_cmp(&a.0));
        let between = interior(m).map(|_| Scattering::Sum(parts.clone()));
        let bent = m.normal_map.is_some();
        for (_, part) in &mut parts {
            *part = std::mem::replace(part, Part::Fixed(Box::default())).fixed(bent);
        }
        let mut fixed = Bsdf::new();
        let all = parts.iter().all(|(weight, part)| match part {
            Part::Fixed(lobes) => fixed.add(lobes, *weight),
            _ => false,
        });
        let scattering = match parts.as_slice() {
            [] => Scattering::Absorb,
            _ if all => Scattering::Fixed(Box::new(fixed)),
            _ => Scattering::Sum(parts),
        };
        Self {
            scattering,
            between,
            emission: m.emission,
            normal_map: m.normal_map,
            alpha: m.alpha,
            is_sheet: is_sheet(&m.model),
        }
    }

    /// What scatters at a hit, seen from `wo` in the local shading frame.
    #[inline]
    pub fn bsdf<'a>(&'a self, s: &Surface, wo: Vec3, textures: &Textures, scratch: &'a mut Scratch) -> BsdfAt<'a> {
        self.bsdf_between(s, wo, textures, None, scratch)
    }

    /// What scatters at a hit, seen from `wo`, where the index of what the surface encloses over what is before it is `eta`,
    /// not the material's own.
    #[inline]
    pub fn bsdf_between<'a>(
        &'a self,
        s: &Surface,
        wo: Vec3,
        textures: &Textures,
        eta: Option<f32>,
        scratch: &'a mut Scratch,
    ) -> BsdfAt<'a> {
        let Scratch { bsdf, toward } = scratch;
        self.lobes(s, textures, eta, bsdf).towards(wo, toward)
    }

    /// Lobes at a hit, bound to no direction: the material's own, or those that vary over the surface, put into `scratch`.
    #[inline]
    pub fn lobes<'a>(&'a self, s: &Surface, textures: &Textures, eta: Option<f32>, scratch: &'a mut Bsdf) -> &'a Bsdf {
        let scattering = match (&self.between, eta) {
            (Some(between), Some(_)) => between,
            _ => &self.scattering,
        };
        match scattering {
            Scattering::Fixed(bsdf) => bsdf,
            Scattering::Absorb => {
                scratch.clear();
                scratch
            }
            Scattering::Sum(parts) => {
                let at = Point { uv: &s.uv, color: s.color, textures, eta };
                sum(parts, at, Lie { surface: s, normal_map: self.normal_map.as_ref() }, scratch)
            }
        }
    }

    /// Radiance \[W·sr⁻¹·m⁻²\] emitted at the cosine `cos` to the geometric normal, negative to the back.
    #[inline]
    pub fn emission(&self, uv: &[Vec2; 2], color: Vec4, cos: f32, textures: &Textures) -> Spectrum {
        match &self.emission {
            None => Spectrum::ZERO,
            Some(emission) => param::emitted(emission, cos, Point { uv, color, textures, eta: None }),
        }
    }

    /// It may emit.
    pub fn is_emissive(&self) -> bool {
        self.emission.is_some_and(|e| e.radiance.factor.iter().any(|&x| x > 0.0))
    }

    /// Probability that the surface is there: 1 where opaque, 0 or 1 for masks, coverage × vertex alpha in between.
    #[inline]
    pub fn coverage(&self, uv: &[Vec2; 2], color: Vec4, textures: &Textures) -> f32 {
        textures.coverage(&self.alpha, uv, color)
    }

    /// It looks at texture coordinates, tangents or vertex colours: something varies over the surface, or has a direction.
    pub fn needs_uv(&self) -> bool {
        let part = |part: &Part| match part {
            Part::Fixed(lobes) => lobes.is_anisotropic(),
            _ => true,
        };
        let scatters = match &self.scattering {
            Scattering::Absorb => false,
            Scattering::Fixed(bsdf) => bsdf.is_anisotropic(),
            Scattering::Sum(parts) => parts.iter().any(|(_, p)| part(p)),
        };
        let emits = self
            .emission
            .is_some_and(|e| !param::is_constant(&e.radiance) || e.coat.is_some_and(|coat| coat.texture.is_some()));
        scatters || emits || self.normal_map.is_some() || self.has_holes()
    }

    /// It may be looked through ([`Bsdf::straight`]): some of it is a smooth thin sheet.
    #[inline]
    pub fn is_sheet(&self) -> bool {
        self.is_sheet
    }

    /// Coverage may be less than 1.
    #[inline]
    pub fn has_holes(&self) -> bool {
        self.alpha != Alpha::Opaque
    }

    /// Normal of the normal map, world space, unit, in the hemisphere of `ng`. `None` without a map, or where the
    /// surface has no tangent to turn it by.
    #[inline]
    pub fn shading_normal(&self, s: &Surface, textures: &Textures) -> Option<Vec3A> {
        self.normal_map.as_ref().and_then(|map| tangent_space_normal(map, s, textures))
    }
}

#[inline(never)]
fn tangent_space_normal(map: &NormalMap, s: &Surface, textures: &Textures) -> Option<Vec3A> {
    if s.tangent == Vec3A::ZERO {
        return None;
    }
    let rgb = textures.lookup(&map.texture, &s.uv).truncate();
    let local = (rgb * 2.0 - Vec3::ONE) * Vec3::new(map.scale, map.scale, 1.0);
    let n = Frame::from_z_tangent(s.ns, s.tangent, s.handedness).to_world(local).try_normalize()?;
    // What points into the surface is lifted just above it.
    const LEAST: f32 = 0.01;
    let height = n.dot(s.ng);
    if height >= LEAST { Some(n) } else { (n + s.ng * (LEAST - height)).try_normalize() }
}

#[inline(never)]
fn sum<'a>(parts: &[(f32, Part)], at: Point, lie: Lie, scratch: &'a mut Bsdf) -> &'a Bsdf {
    scratch.clear();
    for (weight, part) in parts {
        part.put(at, lie, *weight, scratch);
    }
    scratch
}

/// Most lobes and layers that a model makes at a hit. A scene whose materials make more than [`crate::bsdf::MAX_LOBES`] or
/// [`crate::bsdf::MAX_LAYERS`] does not compile.
pub fn most_lobes(model: &desc::Model) -> [usize; 2] {
    match model {
        desc::Model::Absorb => [0; 2],
        desc::Model::Mix(parts) => parts.iter().filter(|(weight, _)| *weight > 0.0).fold([0; 2], |sum, (_, model)| {
            let part = most_lobes(model);
            [0, 1].map(|k| sum[k].saturating_add(part[k]))
        }),
        desc::Model::MetallicRoughness(m) => {
            let count = |all: [bool; 2]| all.into_iter().map(usize::from).sum::<usize>();
            let layers = count([m.layers.sheen.is_some(), m.layers.clearcoat.is_some()]);
            [2 + layers + count([m.transmission.is_some(), m.diffuse_transmission.is_some()]), layers]
        }
        desc::Model::SpecularGlossiness(_) => [2, 0],
        _ => [1, 0],
    }
}

/// Somewhere it may be a smooth thin sheet.
fn is_sheet(model: &desc::Model) -> bool {
    match model {
        desc::Model::MetallicRoughness(m) => {
            let smooth = m.roughness.texture.is_some() || m.roughness.factor.powi(2) < crate::bsdf::MIN_ALPHA;
            smooth && m.transmission.as_ref().is_some_and(|t| t.thin && t.factor.factor > 0.0)
        }
        desc::Model::Mix(parts) => parts.iter().any(|(_, part)| is_sheet(part)),
        _ => false,
    }
}

/// Appends the parts of a model, `weight` times, mixtures taken apart.
fn flatten(model: &desc::Model, weight: f32, parts: &mut Vec<(f32, Part)>) {
    let part = match model {
        desc::Model::Absorb => return,
        desc::Model::Mix(mixed) => {
            mixed.iter().for_each(|(w, model)| flatten(model, weight * w, parts));
            return;
        }
        desc::Model::Diffuse { reflectance } => Part::Diffuse(*reflectance),
        desc::Model::Mirror { reflectance } => Part::Mirror(*reflectance),
        desc::Model::Dielectric { ior, roughness, tint } => Part::Dielectric(Dielectric::new(*ior, *roughness, *tint)),
        desc::Model::Conductor { fresnel, roughness } => Part::Conductor(Conductor::new(fresnel, *roughness)),
        desc::Model::MetallicRoughness(m) if m.layers.is_empty() => {
            Part::MetallicRoughness(Box::new(MetallicRoughness::new(m)))
        }
        desc::Model::MetallicRoughness(m) => Part::Layered(Box::new(Layered::new(m))),
        desc::Model::RoughDiffuse { reflectance, roughness } => Part::RoughDiffuse(*reflectance, *roughness),
        desc::Model::CookTorrance { fresnel, roughness } => Part::CookTorrance(CookTorrance::new(fresnel, *roughness)),
        desc::Model::Phong { reflectance, exponent } => Part::Phong(*reflectance, *exponent),
        desc::Model::SpecularGlossiness(m) => Part::SpecularGlossiness(Box::new(SpecularGlossiness::new(m))),
    };
    if weight > 0.0 {
        parts.push((weight, part));
    }
}
