//! What is traced: geometry behind two questions, materials, textures and lights, compiled from a description.

mod bent;
mod compile;
mod geometry;
mod info;
mod instance;
mod media;
mod object;
mod shading;

pub use geometry::Geometry;
pub use info::Info;
pub use media::{Media, MediaAbout, MediumInterface};
pub use object::{Hit, PrimitiveRef};
pub use shading::{CosineEval, DirectionSample, Shading};

use crate::bsdf::Scratch;
use crate::bvh::Obstacle;
use crate::desc;
use crate::light::{LightSample, Lights};
use crate::material::Material;
use crate::math::{Ray, offset_origin};
use crate::medium::MediumStack;
use crate::shape::Surface;
use crate::spectrum::Spectrum;
use crate::texture::Textures;
use geometry::{Owner, passing};
use glam::Vec3A;

/// A compiled scene.
#[derive(Debug)]
pub struct Scene {
    /// Surfaces.
    pub geometry: Geometry,
    /// Materials; [`Vertex::material`] indexes them.
    pub materials: Vec<Material>,
    /// Textures of the materials and lights.
    pub textures: Textures,
    /// Lights; [`Vertex::light`] indexes them.
    pub lights: Lights,
    /// Light of each emissive triangle and quadric; none where a triangle has no area in the world.
    emitters: Vec<Option<u32>>,
    /// Primitive of each light; [`PrimitiveRef::NONE`] of those that have none.
    primitives: Vec<PrimitiveRef>,
    /// Cameras as written: the resolution decides how they become rays.
    pub cameras: Vec<desc::Camera>,
    /// What the materials enclose.
    pub media: Media,
    /// Some material has holes, so that a ray must look at what it meets.
    has_holes: bool,
    info: Info,
}

/// How much of a light is seen.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Share of its light that arrives.
    pub share: Spectrum,
    /// Thin sheets that the way leads through, each a transmission of its own.
    pub sheets: u32,
}

impl Seen {
    const NOTHING: Self = Self { share: Spectrum::ZERO, sheets: 0 };
    const ALL: Self = Self { share: Spectrum::ONE, sheets: 0 };
}

/// Where a ray met a surface.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// The point and its frame, world space.
    pub surface: Surface,
    /// Towards where the ray came from, unit, world space.
    pub wo: Vec3A,
    /// Which material.
    pub material: u32,
    /// Which light, where the surface emits.
    pub light: Option<u32>,
    /// The ray came from the side of the geometric normal.
    pub front: bool,
    /// Of the rays that leave it.
    pub primitive: PrimitiveRef,
}

impl Vertex {
    /// None yet.
    pub const NOWHERE: Self = Self {
        surface: Surface::NOWHERE,
        wo: Vec3A::ZERO,
        material: 0,
        light: None,
        front: false,
        primitive: PrimitiveRef::NONE,
    };
}

impl Scene {
    /// The nearest surface along a ray of unit direction, whatever lies inside what. Where a material has holes the ray passes with probability
    /// 1 − coverage; `u` gives the numbers in [0, 1) that decide.
    #[inline]
    pub fn intersect(&self, ray: &Ray, u: &mut impl FnMut() -> f32) -> Option<Vertex> {
        self.intersect_from(ray, PrimitiveRef::NONE, &mut MediumStack::default(), u)
    }

    /// The nearest surface along a ray that leaves the primitive `excluded` and begins in `media`, which become those before
    /// the surface: the ray passes boundaries that lie hidden inside a medium of higher priority.
    #[inline]
    pub fn intersect_from(
        &self,
        ray: &Ray,
        excluded: PrimitiveRef,
        media: &mut MediumStack,
        u: &mut impl FnMut() -> f32,
    ) -> Option<Vertex> {
        let mut vertex = Vertex::NOWHERE;
        self.intersect_into(ray, excluded, media, u, &mut vertex).then_some(vertex)
    }

    /// Like [`Self::intersect_from`], with the vertex written where the caller holds it, so that paths do not copy it.
    #[inline(always)]
    pub fn intersect_into(
        &self,
        ray: &Ray,
        excluded: PrimitiveRef,
        media: &mut MediumStack,
        u: &mut impl FnMut() -> f32,
        vertex: &mut Vertex,
    ) -> bool {
        let Some(hit) = self.geometry.nearest(ray, excluded) else { return false };
        match self.geometry.plain_surface(&hit) {
            Some((surface, owner)) => *vertex = self.vertex_of(ray, &hit, surface, owner),
            None => self.put_vertex(ray, &hit, vertex),
        }
        let is_seen = !self.has_holes || !self.materials[vertex.material as usize].has_holes();
        (is_seen && media.is_empty()) || self.pass(ray, media, u, vertex)
    }

    /// Goes on from a vertex that may not be seen to the first that is.
    #[inline(never)]
    fn pass(&self, ray: &Ray, media: &mut MediumStack, u: &mut impl FnMut() -> f32, vertex: &mut Vertex) -> bool {
        let mut ray = *ray;
        loop {
            match self.media.hidden(media, vertex) {
                Some(across) => *media = across,
                None => {
                    let coverage = self.coverage(vertex);
                    if coverage >= 1.0 || u() < coverage {
                        return true;
                    }
                }
            }
            ray = self.beyond(&ray, vertex);
            let Some(hit) = self.geometry.nearest(&ray, vertex.primitive) else { return false };
            self.put_vertex(&ray, &hit, vertex);
        }
    }

    /// How much of what light number `index` sends arrives at `vertex`, on its side where the media are `media`: nothing
    /// or all, or between where the way leads through holes and at most `most_sheets` smooth thin sheets, which do not bend it.
    #[inline(always)]
    pub fn visibility(
        &self,
        vertex: &Vertex,
        index: u32,
        light: &LightSample,
        media: &MediumStack,
        most_sheets: u32,
    ) -> Seen {
        let target = self.primitives[index as usize];
        // A triangle does not light itself.
        if target.is_triangle() && target == vertex.primitive {
            return Seen::NOTHING;
        }
        let ray = shadow_ray(&vertex.surface, light);
        let passing = passing(most_sheets > 0, !media.is_empty());
        match self.geometry.obstacle(&ray, vertex.primitive, target, passing) {
            Obstacle::None => Seen::ALL,
            Obstacle::Opaque => Seen::NOTHING,
            Obstacle::Passable => self.seen_through(ray, vertex.primitive, target, media, most_sheets),
        }
    }

    /// What is left of light behind all that it may pass on its way.
    #[inline(never)]
    fn seen_through(
        &self,
        mut ray: Ray,
        mut excluded: PrimitiveRef,
        target: PrimitiveRef,
        media: &MediumStack,
        most_sheets: u32,
    ) -> Seen {
        let (mut seen, mut media) = (Seen::ALL, media.clone());
        while let Some(hit) = self.geometry.nearest(&ray, excluded) {
            if self.geometry.is_end(&ray, &hit, target) {
                break;
            }
            let vertex = self.vertex(&ray, &hit);
            match self.media.hidden(&media, &vertex) {
                None => {
                    let coverage = self.coverage(&vertex);
                    let holes = Spectrum::splat(1.0 - coverage);
                    let through = if most_sheets > 0 && coverage > 0.0 { self.through(&vertex) } else { None };
                    seen.sheets += u32::from(through.is_some());
                    seen.share *= through.map_or(holes, |through| holes + through * coverage);
                    if seen.sheets > most_sheets || seen.share.is_black() {
                        return Seen::NOTHING;
                    }
                }
                Some(across) => media = across,
            }
            (ray, excluded) = (self.beyond(&ray, &vertex), vertex.primitive);
            if ray.t_max <= 0.0 {
                break;
            }
        }
        seen
    }

    /// Share of light that passes a vertex of a smooth thin sheet; `None` where there is no such thing.
    #[inline(never)]
    fn through(&self, vertex: &Vertex) -> Option<Spectrum> {
        if !self.materials[vertex.material as usize].is_sheet() {
            return None;
        }
        let mut scratch = Scratch::new();
        let interface = MediumInterface::VACUUM;
        let shading = self.shade(vertex, &interface, None, || [0.5; 2], &mut scratch);
        shading.bsdf.bsdf().straight(shading.wo)
    }

    /// Frame, lobes and local `wo` at a vertex between the media of `interface`, of `lane` where the path has chosen
    /// one; `leak` gives the numbers of [`Shading::leak`] where the normal is bent, `scratch` holds lobes that vary over the surface.
    #[inline(always)]
    pub fn shade<'a>(
        &'a self,
        vertex: &'a Vertex,
        interface: &'a MediumInterface,
        lane: Option<usize>,
        leak: impl FnOnce() -> [f32; 2],
        scratch: &'a mut Scratch,
    ) -> Shading<'a> {
        let eta = self.media.eta(interface, lane);
        let material = &self.materials[vertex.material as usize];
        Shading::between(material, vertex, &self.textures, interface, eta, leak, scratch)
    }

    /// Le towards where the ray came from.
    #[inline]
    pub fn emission(&self, vertex: &Vertex) -> Spectrum {
        let s = &vertex.surface;
        self.materials[vertex.material as usize].emission(&s.uv, s.color, vertex.wo.dot(s.ng), &self.textures)
    }

    /// Counts and sizes for people.
    pub fn info(&self) -> &Info {
        &self.info
    }

    fn vertex(&self, ray: &Ray, hit: &Hit) -> Vertex {
        let (surface, owner) = self.geometry.surface(ray, hit);
        self.vertex_of(ray, hit, surface, owner)
    }

    #[inline(never)]
    fn put_vertex(&self, ray: &Ray, hit: &Hit, vertex: &mut Vertex) {
        *vertex = self.vertex(ray, hit);
    }

    #[inline(always)]
    fn vertex_of(&self, ray: &Ray, hit: &Hit, surface: Surface, owner: Owner) -> Vertex {
        let wo = -ray.d;
        let light = owner.emitter.and_then(|emitter| self.emitters[emitter as usize]);
        let front = wo.dot(surface.ng) > 0.0;
        Vertex { surface, wo, material: owner.material, light, front, primitive: hit.primitive }
    }

    fn coverage(&self, vertex: &Vertex) -> f32 {
        let material = &self.materials[vertex.material as usize];
        if !material.has_holes() {
            return 1.0;
        }
        material.coverage(&vertex.surface.uv, vertex.surface.color, &self.textures)
    }

    /// The rest of the ray behind a vertex.
    fn beyond(&self, ray: &Ray, vertex: &Vertex) -> Ray {
        let s = &vertex.surface;
        let o = offset_origin(s.p, s.p_error, s.ng, ray.d);
        let passed = (o - ray.o).dot(ray.d) / ray.d.length_squared();
        Ray { o, d: ray.d, t_max: ray.t_max - passed }
    }
}

/// From off a surface to just before the point of a light: aimed at that point from where it begins, so that it ends there
/// however far the origin was moved.
#[inline]
fn shadow_ray(s: &Surface, light: &LightSample) -> Ray {
    let o = offset_origin(s.p, s.p_error, s.ng, light.wi);
    if light.distance == f32::INFINITY {
        return Ray::new(o, light.wi);
    }
    let to = light.p - o;
    let distance = to.length();
    Ray { o, d: to / distance, t_max: (distance - light.margin).max(0.0) }
}
