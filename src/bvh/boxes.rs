//! Anything with a box in a hierarchy: instances, quadrics.

use super::Aabb;
use super::build::build;
use super::kernel::{KernelRay, Stack};
use super::node::{LEAF, Node, WIDTH};
use crate::math::Ray;

/// Boxes whose contents are asked by a closure.
#[derive(Debug)]
pub struct BoxBvh {
    nodes: Vec<Node>,
    leaves: Vec<Vec<u32>>,
    bounds: Aabb,
}

impl BoxBvh {
    /// Builds over boxes, none of them empty.
    pub fn build(boxes: &[Aabb]) -> Self {
        let tree = build(boxes);
        let bounds = boxes.iter().fold(Aabb::EMPTY, |a, b| a.union(*b));
        Self { nodes: tree.nodes, leaves: tree.leaves, bounds }
    }

    /// Asks `hit(id, ray)` of the contents of every box that the ray may meet, near ones first. `hit` returns the
    /// new end of the ray where the content was met before `ray.t_max`; boxes beyond it are not asked. Stops early
    /// where `hit` returns an end of 0 or less. True where anything was met.
    #[inline]
    pub fn traverse(&self, ray: &Ray, mut hit: impl FnMut(u32, &Ray) -> Option<f32>) -> bool {
        if self.nodes.is_empty() {
            return false;
        }
        let mut ray = *ray;
        let kernel = KernelRay::new(&ray);
        let mut stack = Stack::new();
        let mut found = false;
        while let Some((near, child)) = stack.pop() {
            if near > ray.t_max {
                continue;
            }
            if child & LEAF != 0 {
                for &id in &self.leaves[(child & !LEAF) as usize] {
                    if let Some(t) = hit(id, &ray) {
                        found = true;
                        ray.t_max = t;
                        if t <= 0.0 {
                            return true;
                        }
                    }
                }
                continue;
            }
            let first = stack.len();
            let node = &self.nodes[child as usize];
            for lane in 0..WIDTH {
                if let Some(near) = enters(node, lane, &kernel, ray.t_max) {
                    stack.insert(first, (near, node.child[lane]));
                }
            }
        }
        found
    }

    /// Holds nothing.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Box about everything.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Bytes of nodes and leaves.
    pub fn memory(&self) -> usize {
        size_of_val(&self.nodes[..]) + self.leaves.iter().map(|l| size_of_val(l) + size_of_val(&l[..])).sum::<usize>()
    }
}

/// Where the ray enters a lane's box, if it meets it before `t_max` (slabs as in the kernels).
#[inline]
fn enters(node: &Node, lane: usize, ray: &KernelRay, t_max: f32) -> Option<f32> {
    let (mut near, mut far) = (0f32, t_max);
    for axis in 0..3 {
        let slab = |plane: usize| (node.planes[plane][lane] - ray.o[axis]) * ray.d_inv[axis];
        let (a, b) = (slab(ray.near[axis]), slab(ray.near[axis] ^ 1) * (1.0 + 4e-7));
        near = if a > near { a } else { near };
        far = if b < far { b } else { far };
    }
    (near <= far).then_some(near)
}
