//! Surfaces in space: meshes, instances of meshes, quadrics.

use super::instance::Prototype;
use super::object::{Hit, Object, PrimitiveRef, WORLD};
use crate::bvh::{Aabb, BoxBvh, Obstacle, Passages, Passing, Quality, TriangleBvh, TriangleHit, TriangleRef};
use crate::desc::Mesh;
use crate::math::Ray;
use crate::shape::{
    Derivatives, PrimitiveHit, Surface, TriangleAttributes, flat_surface, triangle_derivatives, triangle_normal,
    with_attributes,
};
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
    pub needs_uv: bool,
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

/// All surfaces.
#[derive(Debug)]
pub struct Geometry {
    parts: Vec<Part>,
    /// Of every triangle of `world`.
    origin: Vec<Origin>,
    world: TriangleBvh,
    prototypes: Vec<Prototype>,
    objects: Vec<Object>,
    /// Of the objects.
    tree: BoxBvh,
}

impl Geometry {
    /// Builds the hierarchies.
    pub fn new(parts: Vec<Part>, prototypes: Vec<Prototype>, objects: Vec<Object>, quality: Quality) -> Self {
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

        // Everything else in another.
        let boxes = objects.iter().map(|object| object.bounds(&prototypes)).collect();
        Self { parts, origin, world, prototypes, objects, tree: BoxBvh::build(boxes, quality) }
    }

    /// Nearest hit in (0, `ray.t_max`).
    #[inline(always)]
    pub fn nearest(&self, ray: &Ray, excluded: PrimitiveRef) -> Option<Hit> {
        let of_world = |TriangleHit { t, u, v, slot, .. }| {
            let primitive = PrimitiveRef { object: WORLD, slot };
            Hit { t, u, v, primitive }
        };
        let nearest = self.world.nearest(ray, excluded.of(WORLD));
        if self.objects.is_empty() {
            return nearest.map(of_world);
        }
        let nearest = nearest.map(of_world);
        let t_max = nearest.map_or(ray.t_max, |hit| hit.t);
        self.nearest_object(ray, t_max, excluded).or(nearest)
    }

    /// Nearest hit of the objects in (0, `t_max`).
    #[inline(never)]
    fn nearest_object(&self, ray: &Ray, t_max: f32, excluded: PrimitiveRef) -> Option<Hit> {
        let mut nearest = None;
        self.tree.traverse(ray, t_max, |index, t_max| {
            let hit = self.objects[index as usize].nearest(index, &self.prototypes, ray, t_max, excluded)?;
            nearest = Some(hit);
            Some(hit.t)
        });
        nearest
    }

    /// What is hit in (0, `ray.t_max`) on the way from one primitive to a point of another.
    #[inline(always)]
    pub fn obstacle(&self, ray: &Ray, from: PrimitiveRef, to: PrimitiveRef, passing: Passing) -> Obstacle {
        let met = self.world.obstacle(ray, [from.of(WORLD), to.of(WORLD)], passing);
        if met == Obstacle::Opaque || self.objects.is_empty() {
            return met;
        }
        met.max(self.obstacle_of_objects(ray, from, to, passing))
    }

    /// What of the objects is hit in (0, `ray.t_max`).
    #[inline(never)]
    fn obstacle_of_objects(&self, ray: &Ray, from: PrimitiveRef, to: PrimitiveRef, passing: Passing) -> Obstacle {
        let mut met = Obstacle::None;
        self.tree.traverse(ray, ray.t_max, |index, t_max| {
            let object = &self.objects[index as usize];
            if !object.is_between(index, &self.prototypes, ray, t_max, [from, to]) {
                return None;
            }
            let passed = passing.passes(object.owner().passages);
            met = if passed { Obstacle::Passable } else { Obstacle::Opaque };
            (!passed).then_some(0.0)
        });
        met
    }

    /// Whether a hit of `ray`, which leads to a point of `target` at its end, is that point.
    pub fn is_end(&self, ray: &Ray, hit: &Hit, target: PrimitiveRef) -> bool {
        hit.primitive == target
            && match self.objects.get(target.object as usize) {
                Some(Object::Primitive(primitive, _)) => !primitive.hides_own_point(ray, ray.t_max),
                // A line meets a triangle once.
                _ => target.is_triangle(),
            }
    }

    /// The primitive of each emitter, as owners number them: the ends of shadow rays.
    pub(super) fn emitters(&self, count: usize) -> Vec<PrimitiveRef> {
        let mut found = vec![PrimitiveRef::NONE; count];
        let mut put = |owner: &Owner, object: u32, slots: &[TriangleRef]| {
            let Some(first) = owner.emitter else { return };
            for (to, &slot) in found[first as usize..].iter_mut().zip(slots) {
                *to = PrimitiveRef { object, slot };
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
        let mut known: Vec<Option<Vec<TriangleRef>>> = vec![None; self.prototypes.len()];
        for (i, object) in self.objects.iter().enumerate().filter(|(_, o)| o.owner().emitter.is_some()) {
            match object {
                Object::Instance(instance) => {
                    let prototype = &self.prototypes[instance.prototype as usize];
                    let slots = known[instance.prototype as usize]
                        .get_or_insert_with(|| prototype.bvh.slots(prototype.mesh.indices.len()));
                    put(&instance.owner, i as u32, slots);
                }
                Object::Primitive(_, owner) => put(owner, i as u32, &[TriangleRef::NONE]),
            }
        }
        found
    }

    /// The surface at a hit on a triangle of the world that carries nothing but its positions, and whose it is (with the
    /// emitter of this very triangle). `None` of all others, which are apart so that these need not pass through memory for
    /// their sake.
    #[inline(always)]
    pub fn plain_surface(&self, hit: &Hit) -> Option<(Surface, Owner)> {
        let Hit { u, v, primitive: PrimitiveRef { object, slot }, .. } = *hit;
        if object != WORLD {
            return None;
        }
        let Origin { part, triangle, ng } = self.origin[self.world.triangle(slot) as usize];
        let part = &self.parts[part as usize];
        if !part.plain {
            return None;
        }
        Some((flat_surface(self.world.vertices(slot), u, v, ng.into()), part.owner.of_triangle(triangle)))
    }

    /// The surface at any hit of `ray`, and whose it is.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> (Surface, Owner) {
        let Hit { u, v, primitive: PrimitiveRef { object, slot }, .. } = *hit;
        if let Some(object) = self.objects.get(object as usize) {
            return object.surface(&self.prototypes, ray, hit);
        }
        let Origin { part, triangle, ng } = self.origin[self.world.triangle(slot) as usize];
        let part = &self.parts[part as usize];
        let flat = flat_surface(self.world.vertices(slot), u, v, ng.into());
        let (p, attributes) = corners(&part.mesh, triangle, part.owner.needs_uv);
        let surface = with_attributes(flat, p, u, v, &attributes, part.flip);
        (surface, part.owner.of_triangle(triangle))
    }

    /// ∂p/∂u and ∂p/∂v at a hit of `ray`, in world space; `None` where the surface has no texture coordinates.
    pub fn derivatives(&self, ray: &Ray, hit: &Hit) -> Option<Derivatives> {
        let Hit { t, u, v, primitive: PrimitiveRef { object, slot } } = *hit;
        let of_mesh = |mesh: &Mesh, triangle: u32, map: &dyn Fn(Vec3) -> Vec3| {
            let (p, attributes) = corners(mesh, triangle, true);
            triangle_derivatives(p.map(map), attributes.uv[0]?)
        };
        match self.objects.get(object as usize) {
            None => {
                let Origin { part, triangle, .. } = self.origin[self.world.triangle(slot) as usize];
                of_mesh(&self.parts[part as usize].mesh, triangle, &|p| p)
            }
            Some(Object::Instance(instance)) => {
                let Prototype { mesh, bvh } = &self.prototypes[instance.prototype as usize];
                of_mesh(mesh, bvh.triangle(slot), &|p| instance.transform.to_world.transform_point3(p))
            }
            Some(Object::Primitive(primitive, _)) => primitive.derivatives(ray, &PrimitiveHit { t, u, v }),
        }
    }

    /// Box about everything.
    pub fn bounds(&self) -> Aabb {
        self.world.bounds().union(self.tree.bounds())
    }

    /// Triangles stored, triangles as placed, instances, primitives that stand alone.
    pub fn counts(&self) -> [usize; 4] {
        let prototypes: usize = self.prototypes.iter().map(|p| p.mesh.indices.len()).sum();
        let (mut placed, mut instances) = (0, 0);
        for object in &self.objects {
            if let Object::Instance(instance) = object {
                placed += self.prototypes[instance.prototype as usize].mesh.indices.len();
                instances += 1;
            }
        }
        let triangles = self.origin.len();
        [triangles + prototypes, triangles + placed, instances, self.objects.len() - instances]
    }

    /// Bytes of meshes and of hierarchies.
    pub fn memory(&self) -> [usize; 2] {
        let meshes = self.parts.iter().map(|p| &*p.mesh).chain(self.prototypes.iter().map(|p| &*p.mesh));
        let trees = self.prototypes.iter().map(|p| p.bvh.memory()).sum::<usize>();
        [
            meshes.map(mesh_bytes).sum::<usize>() + size_of_val(&self.origin[..]),
            self.world.memory() + self.tree.memory() + trees,
        ]
    }
}

impl Owner {
    #[inline(always)]
    pub(super) fn of_triangle(self, triangle: u32) -> Self {
        Self { emitter: self.emitter.map(|first| first + triangle), ..self }
    }
}

/// Vertices of a triangle and what they carry; all but the normals only where it is to be `needs_uv`.
#[inline]
pub(super) fn corners(mesh: &Mesh, triangle: u32, needs_uv: bool) -> ([Vec3; 3], TriangleAttributes) {
    let index = mesh.indices[triangle as usize];
    fn pick<T: Copy>(list: &[T], index: [u32; 3]) -> Option<[T; 3]> {
        (!list.is_empty()).then(|| index.map(|i| list[i as usize]))
    }
    let attributes = TriangleAttributes {
        normals: pick(&mesh.normals, index),
        tangents: if needs_uv { pick(&mesh.tangents, index) } else { None },
        uv: if needs_uv { [pick(&mesh.uv[0], index), pick(&mesh.uv[1], index)] } else { [None; 2] },
        colors: if needs_uv { pick(&mesh.colors, index) } else { None },
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
