//! A tree over the lights that have a place: thousands of them, one chosen by what it can send to a point.
//!
//! Conty Estevez & Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting" (without the splitting);
//! PBRT 4th ed., section 12.6.3. A binary tree bounds lights by a box, a cone of directions and an intensity. The choice
//! goes down from the root, at each node to a child with probability in proportion to a bound on what it sends to the
//! receiver; the probability of a given light is found by going down the same way, along the trail of bits that leads to
//! it. Where a bound is 0 nothing can arrive.

mod bounds;
mod build;
mod node;

pub use bounds::LightBounds;

use super::LightSampleContext;
use node::Node;

/// The tree.
#[derive(Clone, Debug)]
pub struct LightTree {
    /// The root, then pairs of siblings.
    nodes: Vec<Node>,
    /// The way to each light, the first turn in the lowest bit, 1 for the second child; `None` where it is not in the
    /// tree.
    trails: Vec<Option<u64>>,
}

impl LightTree {
    /// Of the lights that have bounds, numbered as in the list; `None` where none has. Intensities are multiplied by
    /// `scale`, which brings them into the range of f32.
    pub fn new(lights: &[Option<LightBounds>], scale: f64) -> Option<Self> {
        build::build(lights, scale)
    }

    /// Bound on what the receiver gets from all lights together: intensity/d², scaled.
    #[inline]
    pub fn importance(&self, receiver: &LightSampleContext) -> f32 {
        Node::importances([&self.nodes[0]; 2], receiver)[0]
    }

    /// Chooses a light at `u` in \[0, 1), with its probability; `None` where the way ends at nodes that send nothing.
    /// Each turn uses up a part of `u`, which must have as many random bits as the least probability takes.
    #[inline]
    pub fn choose(&self, receiver: &LightSampleContext, mut u: f64) -> Option<(u32, f32)> {
        let (mut node, mut probability) = (&self.nodes[0], 1.0);
        while !node.leaf {
            let first = self.first(node, receiver)?;
            let share = f64::from(first);
            if u < share {
                u /= share;
                probability *= first;
                node = &self.nodes[node.next as usize];
            } else {
                u = (u - share) / (1.0 - share);
                probability *= 1.0 - first;
                node = &self.nodes[node.next as usize + 1];
            }
        }
        Some((node.next, probability))
    }

    /// Probability with which [`choose`](Self::choose) gives the light.
    #[inline]
    pub fn probability(&self, receiver: &LightSampleContext, light: u32) -> f32 {
        let Some(mut trail) = self.trails[light as usize] else { return 0.0 };
        let (mut node, mut probability) = (&self.nodes[0], 1.0);
        while !node.leaf {
            let Some(first) = self.first(node, receiver) else { return 0.0 };
            let second = trail & 1 == 1;
            probability *= if second { 1.0 - first } else { first };
            node = &self.nodes[node.next as usize + usize::from(second)];
            trail >>= 1;
        }
        probability
    }

    /// Probability of the first child of an inner node; `None` where neither sends anything.
    #[inline]
    fn first(&self, node: &Node, receiver: &LightSampleContext) -> Option<f32> {
        let children = &self.nodes[node.next as usize..][..2];
        let [a, b] = Node::importances([&children[0], &children[1]], receiver);
        let sum = a + b;
        (sum > 0.0).then(|| a / sum)
    }
}
