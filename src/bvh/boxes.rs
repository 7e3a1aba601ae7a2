//! Anything with a box in a hierarchy: instances, quadrics.

use super::Aabb;
use super::build::{Quality, build};
use super::kernel::{self, Entry, Isa, Slabs, Stack};
use super::node::{LEAF, Node};
use crate::math::Ray;

/// Boxes whose contents are asked by a closure.
#[derive(Debug)]
pub struct BoxBvh {
    nodes: Vec<Node>,
    /// Content of each leaf.
    leaves: Vec<u32>,
    bounds: Aabb,
    isa: Isa,
}

impl BoxBvh {
    /// Builds over boxes, none of them empty.
    pub fn build(boxes: Vec<Aabb>, quality: Quality) -> Self {
        // What is in a box costs more to ask than the box.
        let bounds = boxes.iter().fold(Aabb::EMPTY, |a, b| a.union(*b));
        let tree = build(boxes, quality, 1);
        let leaves = tree.leaves().map(|ids| ids[0]).collect();
        Self { nodes: tree.nodes, leaves, bounds, isa: Isa::in_use() }
    }

    /// Asks `hit(id, t_max)` of the contents of every box that the ray may meet before `t_max`, near ones first. `hit` returns
    /// the new end where the content was met before that; boxes beyond it are not asked. Stops early where `hit` returns an
    /// end of 0 or less. True where anything was met.
    #[inline(always)]
    pub fn traverse(&self, ray: &Ray, mut t_max: f32, mut hit: impl FnMut(u32, f32) -> Option<f32>) -> bool {
        if self.nodes.is_empty() {
            return false;
        }
        let slabs = Slabs::new(ray);
        let (mut stack, mut size) = (Stack::new(), 0);
        stack.push(&mut size, Entry::new(0.0, 0));
        let mut found = false;
        while let Some(next) = stack.pop(&mut size) {
            if next.near() > t_max {
                continue;
            }
            let child = next.child();
            if child & LEAF != 0 {
                if let Some(t) = hit(self.leaves[(child & !LEAF) as usize], t_max) {
                    found = true;
                    t_max = t;
                    if t <= 0.0 {
                        return true;
                    }
                }
                continue;
            }
            let first = size;
            let node = &self.nodes[child as usize];
            let (mut met, near) = kernel::enter(self.isa, node, &slabs, t_max);
            while met != 0 {
                let lane = met.trailing_zeros() as usize & 7;
                met &= met - 1;
                stack.insert(first, &mut size, Entry::new(near[lane], node.child[lane]));
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
        size_of_val(&self.nodes[..]) + size_of_val(&self.leaves[..])
    }
}
