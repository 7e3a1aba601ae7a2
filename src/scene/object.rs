//! What a leaf of the tree of objects holds, and references to the primitives of a scene.

use super::geometry::Owner;
use super::instance::{Instance, Prototype};
use crate::bvh::{Aabb, TriangleRef};
use crate::math::Ray;
use crate::shape::{Primitive, PrimitiveHit, Surface};

/// What stands in a place of its own.
#[derive(Debug)]
pub enum Object {
    /// A mesh under a map: triangles in a tree of their own.
    Instance(Instance),
    /// A shape that answers rays for itself, and whose it is.
    Primitive(Primitive, Owner),
}

/// Which primitive of a scene: the object that it belongs to and, of a triangle, where that object's tree holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimitiveRef {
    pub(super) object: u32,
    pub(super) slot: TriangleRef,
}

/// Object of the triangles that stand once, in world space.
pub(super) const WORLD: u32 = u32::MAX;

impl PrimitiveRef {
    /// None: of rays that leave no primitive, of lights that have none.
    pub const NONE: Self = Self { object: WORLD, slot: TriangleRef::NONE };

    /// It is a triangle, of the world or of an instance.
    #[inline]
    pub fn is_triangle(self) -> bool {
        self.slot != TriangleRef::NONE
    }

    /// Where the tree of this object holds it.
    #[inline]
    pub(super) fn of(self, object: u32) -> TriangleRef {
        if self.object == object { self.slot } else { TriangleRef::NONE }
    }
}

/// Where a ray met the geometry.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Ray parameter.
    pub t: f32,
    /// Where on the primitive, as [`PrimitiveHit::u`].
    pub u: f32,
    /// As [`PrimitiveHit::v`].
    pub v: f32,
    /// Which primitive.
    pub primitive: PrimitiveRef,
}

impl Hit {
    /// Of a primitive's own hit.
    #[inline]
    pub(super) fn of(PrimitiveHit { t, u, v }: PrimitiveHit, primitive: PrimitiveRef) -> Self {
        Self { t, u, v, primitive }
    }
}

impl Object {
    /// Whose it is.
    #[inline]
    pub(super) fn owner(&self) -> &Owner {
        match self {
            Self::Instance(instance) => &instance.owner,
            Self::Primitive(_, owner) => owner,
        }
    }

    pub(super) fn owner_mut(&mut self) -> &mut Owner {
        match self {
            Self::Instance(instance) => &mut instance.owner,
            Self::Primitive(_, owner) => owner,
        }
    }

    pub(super) fn bounds(&self, prototypes: &[Prototype]) -> Aabb {
        match self {
            Self::Instance(instance) => instance.bounds(&prototypes[instance.prototype as usize]),
            Self::Primitive(primitive, _) => {
                let (min, max) = primitive.bounds();
                Aabb { min, max }
            }
        }
    }

    /// Nearest hit in (0, `t_max`) of a ray that does not meet `excluded` of this object, which is number `index`.
    #[inline]
    pub(super) fn nearest(
        &self,
        index: u32,
        prototypes: &[Prototype],
        ray: &Ray,
        t_max: f32,
        excluded: PrimitiveRef,
    ) -> Option<Hit> {
        match self {
            Self::Instance(instance) => {
                let prototype = &prototypes[instance.prototype as usize];
                let hit = instance.nearest(prototype, ray, t_max, excluded.of(index))?;
                Some(Hit { t: hit.t, u: hit.u, v: hit.v, primitive: PrimitiveRef { object: index, slot: hit.slot } })
            }
            Self::Primitive(primitive, _) => {
                let hit = primitive.intersect(ray, t_max)?;
                Some(Hit::of(hit, PrimitiveRef { object: index, slot: TriangleRef::NONE }))
            }
        }
    }

    /// Whether it stands in (0, `t_max`) on the way from one primitive to a point of another.
    #[inline]
    pub(super) fn is_between(
        &self,
        index: u32,
        prototypes: &[Prototype],
        ray: &Ray,
        t_max: f32,
        [from, to]: [PrimitiveRef; 2],
    ) -> bool {
        match self {
            Self::Instance(instance) => {
                let prototype = &prototypes[instance.prototype as usize];
                instance.occluded(prototype, ray, t_max, [from.of(index), to.of(index)])
            }
            Self::Primitive(primitive, _) if to.object == index => primitive.hides_own_point(ray, t_max),
            Self::Primitive(primitive, _) => primitive.intersect(ray, t_max).is_some(),
        }
    }

    /// The surface at a hit of `ray` on it, and whose it is.
    pub(super) fn surface(&self, prototypes: &[Prototype], ray: &Ray, hit: &Hit) -> (Surface, Owner) {
        let Hit { t, u, v, primitive } = *hit;
        match self {
            Self::Instance(instance) => {
                let Prototype { mesh, bvh } = &prototypes[instance.prototype as usize];
                let triangle = bvh.triangle(primitive.slot);
                (instance.surface(mesh, triangle, u, v), instance.owner.of_triangle(triangle))
            }
            Self::Primitive(primitive, owner) => {
                (primitive.surface(ray, &PrimitiveHit { t, u, v }, owner.needs_uv), *owner)
            }
        }
    }
}
