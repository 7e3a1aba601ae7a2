//! Surfaces in space: meshes, instances of meshes, quadrics.

use super::instance::{Instance, Prototype};
use crate::bvh::{Aabb, BoxBvh, Obstacle, Passages, Passing, Quality, Slot, TriangleBvh, TriangleHit};
use crate::desc::Mesh;
use crate::math::Ray;
use crate::shape::{PlacedQuadric, Surface, TriangleAttributes, flat_surface, triangle_normal, with_attributes};
use glam::{Vec3, Vec4};
use std::sync::Arc;

/// Whose a surface is.
#[derive(Clone, Copy, Debug)]
pub struct Owner {
    /// Which material.
    pub material: u32,
    /// Place in the scene's list of emitters; of a mesh, that of its first triangle.
    pub emitter: Option<u32>,
    /// The material looks at texture coordinates, tangents or vertex colours.
    pub charted: bool,
    /// Why a shadow ray may pass: the bits of [`Passages`] are those of [`passing`].
    pub passages: Passages,
}

/// What a shadow ray may pass: holes, smooth thin sheets where it looks through them, surfaces of interiors within others.
#[inline]
pub(super) fn passing(sheets: bool, interiors: bool) -> Passing {
    Passing::of([true, sheets, interiors, false])
}

/// A mesh that stands once, in world space.
#[derive(Debug)]
pub struct Part {
    /// World-space geometry.
    pub mesh: Arc<Mesh>,
    /// Whose it is.
    pub owner: Owner,
    /// The front is the side from which the vertices run clockwise.
    pub flip: bool,
    /// Nothing counts but the positions.
    pub plain: bool,
}

/// Where a triangle of the world tree came from.
#[derive(Clone, Copy, Debug)]
struct Origin {
    part: u32,
    triangle: u32,
    /// Normal of its front.
    ng: Vec3,
}

/// Where a ray met the geometry.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Ray parameter.
    pub t: f32,
    /// The triangle of the world mesh, of the prototype, or nothing for a quadric.
    triangle: TriangleHit,
    /// Instance, or quadric behind all instances, or [`WORLD`].
    object: u32,
}

/// Object of a hit on geometry that stands once.
const WORLD: u32 = u32::MAX;

/// A primitive that a ray leaves and cannot meet again, or that it leads to: whose, and where its tree holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Departure {
    object: u32,
    slot: Slot,
}

impl Departure {
    /// Of rays that leave no primitive.
    pub const NOWHERE: Self = Self { object: WORLD, slot: Slot::NONE };

    /// It is a triangle, of the world or of an instance.
    #[inline]
    pub fn is_triangle(self) -> bool {
        self.slot != Slot::NONE
    }

    #[inline]
    fn from(self, object: u32) -> Slot {
        if self.object == object { self.slot } else { Slot::NONE }
    }
}

impl Hit {
    /// Of the rays that leave the surface here.
    #[inline]
    pub fn departure(&self) -> Departure {
        Departure { object: self.object, slot: self.triangle.slot }
    }
}

/// All surfaces.
#[derive(Debug)]
pub struct Geometry {
    parts: Vec<Part>,
    /// Of every triangle of `world`.
    origin: Vec<Origin>,
    world: TriangleBvh,
    prototypes: Vec<Prototype>,
    instances: Vec<Instance>,
    quadrics: Vec<(PlacedQuadric, Owner)>,
    objects: BoxBvh,
}

impl Geometry {
    /// Builds the hierarchies.
    pub fn new(
        parts: Vec<Part>,
        prototypes: Vec<Prototype>,
        instances: Vec<Instance>,
        quadrics: Vec<(PlacedQuadric, Owner)>,
        quality: Quality,
    ) -> Self {
        // All parts in one tree.
        let world = match parts.as_slice() {
            [part] => TriangleBvh::build(&part.mesh.positions, &part.mesh.indices, quality),
            _ => {
                let (mut positions, mut indices) = (Vec::new(), Vec::new());
                for part in &parts {
                    let base = positions.len() as u32;
                    positions.extend(&part.mesh.positions);
                    indices.extend(part.mesh.indices.iter().map(|t| t.map(|i| i + base)));
                }
                TriangleBvh::build(&positions, &indices, quality)
            }
        };
        // After the tree, whose construction takes the most memory.
        let mut origin = Vec::with_capacity(parts.iter().map(|part| part.mesh.indices.len()).sum());
        for (p, part) in parts.iter().enumerate() {
            origin.extend(part.mesh.indices.iter().enumerate().map(|(triangle, index)| {
                let front = triangle_normal(index.map(|i| part.mesh.positions[i as usize])).unwrap_or(Vec3::Z);
                Origin { part: p as u32, triangle: triangle as u32, ng: if part.flip { -front } else { front } }
            }));
        }

        let passages = |triangle: u32| parts[origin[triangle as usize].part as usize].owner.passages;
        let opaque = parts.iter().all(|part| part.owner.passages == 0);
        let world = if opaque { world } else { world.with_passages(passages) };

        // Instances and quadrics in another.
        let boxes = instances.iter().map(|i| i.bounds(&prototypes[i.prototype as usize]));
        let boxes = boxes.chain(quadrics.iter().map(|(q, _)| {
            let (min, max) = q.bounds();
            Aabb { min, max }
        }));
        let objects = BoxBvh::build(boxes.collect(), quality);
        Self { parts, origin, world, prototypes, instances, quadrics, objects }
    }

    /// Nearest hit in (0, `ray.t_max`).
    #[inline(always)]
    pub fn nearest(&self, ray: &Ray, leaving: Departure) -> Option<Hit> {
        let nearest = self.world.nearest(ray, leaving.from(WORLD));
        let nearest = nearest.map(|triangle| Hit { t: triangle.t, triangle, object: WORLD });
        if self.objects.is_empty() {
            return nearest;
        }
        let t_max = nearest.map_or(ray.t_max, |hit| hit.t);
        self.nearest_object(ray, t_max, leaving).or(nearest)
    }

    /// Nearest hit of instances and quadrics in (0, `t_max`).
    #[inline(never)]
    fn nearest_object(&self, ray: &Ray, t_max: f32, leaving: Departure) -> Option<Hit> {
        let mut nearest = None;
        self.objects.traverse(ray, t_max, |object, t_max| {
            let hit = self.object(object, ray, t_max, leaving)?;
            nearest = Some(hit);
            Some(hit.t)
        });
        nearest
    }

    /// What is hit in (0, `ray.t_max`) on the way from one primitive to a point of another.
    #[inline(always)]
    pub fn obstacle(&self, ray: &Ray, from: Departure, to: Departure, passing: Passing) -> Obstacle {
        let met = self.world.obstacle(ray, [from.from(WORLD), to.from(WORLD)], passing);
        if met == Obstacle::Opaque || self.objects.is_empty() {
            return met;
        }
        met.max(self.obstacle_of_objects(ray, from, to, passing))
    }

    /// What of the instances and quadrics is hit in (0, `ray.t_max`).
    #[inline(never)]
    fn obstacle_of_objects(&self, ray: &Ray, from: Departure, to: Departure, passing: Passing) -> Obstacle {
        let mut met = Obstacle::None;
        self.objects.traverse(ray, ray.t_max, |object, t_max| {
            let (hit, owner) = match self.instances.get(object as usize) {
                Some(instance) => {
                    let prototype = &self.prototypes[instance.prototype as usize];
                    let hit = instance.occluded(prototype, ray, t_max, [from.from(object), to.from(object)]);
                    (hit, &instance.owner)
                }
                None => {
                    let (quadric, owner) = &self.quadrics[object as usize - self.instances.len()];
                    let hit = match object == to.object {
                        true => quadric.hides_own_point(ray, t_max),
                        false => quadric.intersect_before(ray, t_max).is_some(),
                    };
                    (hit, owner)
                }
            };
            let passed = hit && passing.passes(owner.passages);
            met = met.max(if passed { Obstacle::Passable } else { Obstacle::None });
            (hit && !passed).then(|| {
                met = Obstacle::Opaque;
                0.0
            })
        });
        met
    }

    /// The primitive of each emitter, as owners number them: the ends of shadow rays.
    pub(super) fn emitters(&self, count: usize) -> Vec<Departure> {
        let mut found = vec![Departure::NOWHERE; count];
        let mut put = |owner: &Owner, object: u32, slots: &[Slot]| {
            let Some(first) = owner.emitter else { return };
            for (to, &slot) in found[first as usize..].iter_mut().zip(slots) {
                *to = Departure { object, slot };
            }
        };
        if self.parts.iter().any(|part| part.owner.emitter.is_some()) {
            let slots = self.world.slots(self.origin.len());
            let mut first = 0;
            for part in &self.parts {
                let next = first + part.mesh.indices.len();
                put(&part.owner, WORLD, &slots[first..next]);
                first = next;
            }
        }
        let mut known: Vec<Option<Vec<Slot>>> = vec![None; self.prototypes.len()];
        for (i, instance) in self.instances.iter().enumerate().filter(|(_, i)| i.owner.emitter.is_some()) {
            let prototype = &self.prototypes[instance.prototype as usize];
            let slots = known[instance.prototype as usize]
                .get_or_insert_with(|| prototype.bvh.slots(prototype.mesh.indices.len()));
            put(&instance.owner, i as u32, slots);
        }
        for (i, (_, owner)) in self.quadrics.iter().enumerate() {
            put(owner, (self.instances.len() + i) as u32, &[Slot::NONE]);
        }
        found
    }

    /// Nearest hit of one instance or quadric in (0, `t_max`).
    #[inline]
    fn object(&self, object: u32, ray: &Ray, t_max: f32, leaving: Departure) -> Option<Hit> {
        match self.instances.get(object as usize) {
            Some(instance) => {
                let prototype = &self.prototypes[instance.prototype as usize];
                let triangle = instance.nearest(prototype, ray, t_max, leaving.from(object))?;
                Some(Hit { t: triangle.t, triangle, object })
            }
            None => {
                let t = self.quadrics[object as usize - self.instances.len()].0.intersect_before(ray, t_max)?;
                Some(Hit { t, triangle: TriangleHit::default(), object })
            }
        }
    }

    /// The surface at a hit on a triangle of the world that carries nothing but its positions, and whose it is (with the
    /// emitter of this very triangle). `None` of all others, which are apart so that these need not pass through memory for
    /// their sake.
    #[inline(always)]
    pub fn plain_surface(&self, hit: &Hit) -> Option<(Surface, Owner)> {
        if hit.object != WORLD {
            return None;
        }
        let TriangleHit { u, v, triangle, .. } = hit.triangle;
        let Origin { part, triangle, ng } = self.origin[triangle as usize];
        let part = &self.parts[part as usize];
        if !part.plain {
            return None;
        }
        Some((flat_surface(self.world.vertices(&hit.triangle), u, v, ng.into()), part.owner.of_triangle(triangle)))
    }

    /// The surface at any hit of `ray`, and whose it is.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> (Surface, Owner) {
        let TriangleHit { u, v, triangle, .. } = hit.triangle;
        if hit.object == WORLD {
            let Origin { part, triangle, ng } = self.origin[triangle as usize];
            let part = &self.parts[part as usize];
            let flat = flat_surface(self.world.vertices(&hit.triangle), u, v, ng.into());
            let (p, attributes) = corners(&part.mesh, triangle, part.owner.charted);
            let surface = with_attributes(flat, p, u, v, &attributes, part.flip);
            return (surface, part.owner.of_triangle(triangle));
        }
        match self.instances.get(hit.object as usize) {
            Some(instance) => {
                let mesh = &self.prototypes[instance.prototype as usize].mesh;
                (instance.surface(mesh, triangle, u, v), instance.owner.of_triangle(triangle))
            }
            None => {
                let (quadric, owner) = &self.quadrics[hit.object as usize - self.instances.len()];
                (quadric.surface(ray, hit.t, owner.charted), *owner)
            }
        }
    }

    /// Box about everything.
    pub fn bounds(&self) -> Aabb {
        self.world.bounds().union(self.objects.bounds())
    }

    /// Triangles stored, triangles as placed, instances, quadrics.
    pub fn counts(&self) -> [usize; 4] {
        let placed = |i: &Instance| self.prototypes[i.prototype as usize].mesh.indices.len();
        let prototypes: usize = self.prototypes.iter().map(|p| p.mesh.indices.len()).sum();
        let instanced: usize = self.instances.iter().map(placed).sum();
        [self.origin.len() + prototypes, self.origin.len() + instanced, self.instances.len(), self.quadrics.len()]
    }

    /// Bytes of meshes and of hierarchies.
    pub fn memory(&self) -> [usize; 2] {
        let meshes = self.parts.iter().map(|p| &*p.mesh).chain(self.prototypes.iter().map(|p| &*p.mesh));
        let trees = self.prototypes.iter().map(|p| p.bvh.memory()).sum::<usize>();
        [
            meshes.map(mesh_bytes).sum::<usize>() + size_of_val(&self.origin[..]),
            self.world.memory() + self.objects.memory() + trees,
        ]
    }
}

impl Owner {
    #[inline(always)]
    fn of_triangle(self, triangle: u32) -> Self {
        Self { emitter: self.emitter.map(|first| first + triangle), ..self }
    }
}

/// Vertices of a triangle and what they carry; all but the normals only where it is to be `charted`.
#[inline]
pub(super) fn corners(mesh: &Mesh, triangle: u32, charted: bool) -> ([Vec3; 3], TriangleAttributes) {
    let index = mesh.indices[triangle as usize];
    fn pick<T: Copy>(list: &[T], index: [u32; 3]) -> Option<[T; 3]> {
        (!list.is_empty()).then(|| index.map(|i| list[i as usize]))
    }
    let attributes = TriangleAttributes {
        normals: pick(&mesh.normals, index),
        tangents: if charted { pick(&mesh.tangents, index) } else { None },
        uv: if charted { [pick(&mesh.uv[0], index), pick(&mesh.uv[1], index)] } else { [None; 2] },
        colors: if charted { pick(&mesh.colors, index) } else { None },
    };
    (index.map(|i| mesh.positions[i as usize]), attributes)
}

fn mesh_bytes(mesh: &Mesh) -> usize {
    size_of_val(&mesh.positions[..])
        + size_of_val(&mesh.indices[..])
        + size_of_val(&mesh.normals[..])
        + size_of_val::<[Vec4]>(&mesh.tangents)
        + mesh.uv.iter().map(|uv| size_of_val(&uv[..])).sum::<usize>()
        + size_of_val(&mesh.colors[..])
}
