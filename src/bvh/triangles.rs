//! Triangles in a hierarchy.

use super::Aabb;
use super::build::{Quality, build};
use super::fragments::split;
use super::kernel::{self, Found, Isa, ShadowRay};
use super::node::{NONE, Node, TriangleLeaf, WIDTH};
use super::obstacle::{LeafPassages, Obstacle, Passages, Passing};
use crate::math::Ray;
use crate::shape::triangle_normal;
use arrayvec::ArrayVec;
use glam::{Vec3, Vec3A};

/// Where a ray met a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TriangleHit {
    /// Ray parameter.
    pub t: f32,
    /// Barycentric coordinate of the second vertex.
    pub u: f32,
    /// Barycentric coordinate of the third vertex.
    pub v: f32,
    /// Which triangle.
    pub triangle: u32,
    /// Where the tree holds it.
    pub slot: TriangleRef,
}

/// A reference to a triangle of a tree: the leaf and the lane that hold it. A ray that leaves the triangle excludes it, for it
/// cannot meet it again, which rounding alone would not tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleRef(u32);

impl TriangleRef {
    /// No triangle of the tree.
    pub const NONE: Self = Self(NONE);

    #[inline]
    pub(super) fn new(leaf: u32, lane: u32) -> Self {
        Self(leaf * WIDTH as u32 + lane)
    }

    #[inline]
    pub(super) fn bits(self) -> u32 {
        self.0
    }

    #[inline]
    pub(super) fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    /// Leaf and lane.
    #[inline]
    pub(super) fn place(self) -> (usize, usize) {
        (self.0 as usize / WIDTH, self.0 as usize % WIDTH)
    }
}

impl Default for TriangleRef {
    fn default() -> Self {
        Self::NONE
    }
}

/// Triangles that rays can ask two questions.
#[derive(Debug)]
pub struct TriangleBvh {
    nodes: Vec<Node>,
    leaves: Vec<TriangleLeaf>,
    /// Triangle of each lane of each leaf.
    ids: Vec<[u32; WIDTH]>,
    /// What light may pass in each leaf; empty where that is nothing.
    passages: Vec<LeafPassages>,
    bounds: Aabb,
    isa: Isa,
}

impl TriangleBvh {
    /// Builds over `indices` into `positions` (in range, finite). Triangles without area have no normal and are never
    /// hit.
    pub fn build(positions: &[Vec3], indices: &[[u32; 3]], quality: Quality) -> Self {
        let corners = |t: &[u32; 3]| t.map(|i| positions[i as usize]);
        let has_area = |t: &u32| triangle_normal(corners(&indices[*t as usize])).is_some();
        let kept: Vec<u32> = (0..indices.len() as u32).filter(has_area).collect();
        let boxes: Vec<Aabb> = kept.iter().map(|&t| Aabb::of(corners(&indices[t as usize]))).collect();
        let bounds = boxes.iter().fold(Aabb::EMPTY, |a, b| a.union(*b));
        let (boxes, owners) = if quality == Quality::Best {
            let triangles: Vec<[Vec3; 3]> = kept.iter().map(|&t| corners(&indices[t as usize])).collect();
            let (parts, owners) = split(&triangles, &boxes);
            (parts, owners.into_iter().map(|i| kept[i as usize]).collect())
        } else {
            (boxes, kept)
        };
        let tree = build(boxes, quality, WIDTH);
        let mut leaves = kernel::with_capacity(tree.leaves().len());
        let mut ids = kernel::with_capacity(tree.leaves().len());
        for parts in tree.leaves() {
            // Parts of one triangle may have come together again.
            let mut own: ArrayVec<u32, WIDTH> = ArrayVec::new();
            for id in parts.iter().map(|&i| owners[i as usize]) {
                if !own.contains(&id) {
                    own.push(id);
                }
            }
            let (mut leaf, mut lanes) = (TriangleLeaf::EMPTY, [NONE; WIDTH]);
            for (lane, id) in own.into_iter().enumerate() {
                lanes[lane] = id;
                for (i, p) in corners(&indices[id as usize]).into_iter().enumerate() {
                    for axis in 0..3 {
                        leaf.v[i][axis][lane] = p[axis];
                    }
                }
            }
            leaves.push(leaf);
            ids.push(lanes);
        }
        let mut nodes = kernel::with_capacity(tree.nodes.len());
        nodes.extend_from_slice(&tree.nodes);
        Self { leaves, ids, passages: Vec::new(), bounds, nodes, isa: Isa::in_use() }
    }

    /// Says why shadow rays may pass each triangle: for the reasons that `of` gives.
    #[must_use]
    pub fn with_passages(mut self, of: impl Fn(u32) -> Passages) -> Self {
        let leaf = |ids: &[u32; WIDTH]| {
            let mut leaf = LeafPassages::default();
            let held = ids.iter().enumerate().filter(|(_, id)| **id != NONE);
            held.for_each(|(lane, &id)| leaf.put(lane, of(id)));
            leaf
        };
        self.passages = self.ids.iter().map(leaf).collect();
        self
    }

    /// Has the tree traversed by another kernel; `None` where this CPU does not run it.
    pub fn with_isa(mut self, isa: Isa) -> Option<Self> {
        self.isa = isa;
        isa.is_available().then_some(self)
    }

    /// The nearest hit in (0, `ray.t_max`) of a ray that leaves `excluded`.
    #[inline(always)]
    pub fn nearest(&self, ray: &Ray, excluded: TriangleRef) -> Option<TriangleHit> {
        let mut found = Found::NOTHING;
        if self.nodes.is_empty() || !kernel::nearest(self.isa, &self.nodes, &self.leaves, ray, excluded, &mut found) {
            return None;
        }
        let ([t, u, v], slot) = found.parts();
        let (leaf, lane) = slot.place();
        Some(TriangleHit { t, u, v, triangle: self.ids[leaf][lane], slot })
    }

    /// Whether anything is hit in (0, `ray.t_max`) by a ray that leaves `excluded`.
    #[inline(always)]
    pub fn occluded(&self, ray: &Ray, excluded: TriangleRef) -> bool {
        self.obstacle(ray, [excluded, TriangleRef::NONE], Passing::NOTHING) != Obstacle::None
    }

    /// What is hit in (0, `ray.t_max`) by a ray that meets neither the triangle that it leaves nor the one that it leads to,
    /// and passes some of the others: opaque ones are asked for first.
    #[inline(always)]
    pub fn obstacle(&self, ray: &Ray, excluded: [TriangleRef; 2], passing: Passing) -> Obstacle {
        if self.nodes.is_empty() {
            return Obstacle::None;
        }
        let shadow = ShadowRay { ray, excluded, passing, passages: &self.passages };
        kernel::obstacle(self.isa, &self.nodes, &self.leaves, &shadow)
    }

    /// A slot of each of `count` triangles; [`TriangleRef::NONE`] of those that the tree does not hold.
    pub fn slots(&self, count: usize) -> Vec<TriangleRef> {
        let mut slots = vec![TriangleRef::NONE; count];
        for (leaf, ids) in self.ids.iter().enumerate() {
            for (lane, &id) in ids.iter().enumerate().filter(|(_, id)| **id != NONE) {
                slots[id as usize] = TriangleRef::new(leaf as u32, lane as u32);
            }
        }
        slots
    }

    /// The triangle at a slot of this tree.
    #[inline]
    pub fn triangle(&self, slot: TriangleRef) -> u32 {
        let (leaf, lane) = slot.place();
        self.ids[leaf][lane]
    }

    /// Vertices of the triangle at a slot of this tree: after a hit from the leaf that has just been looked at.
    #[inline]
    pub fn vertices(&self, slot: TriangleRef) -> [Vec3A; 3] {
        let (leaf, lane) = slot.place();
        self.leaves[leaf].triangle(lane).map(Vec3A::from)
    }

    /// Box about all triangles.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Bytes of nodes and leaves.
    pub fn memory(&self) -> usize {
        size_of_val(&self.nodes[..])
            + size_of_val(&self.leaves[..])
            + size_of_val(&self.ids[..])
            + size_of_val(&self.passages[..])
    }
}
