//! Boxes → binary tree (obvhs) → eight-wide tree.

use super::Aabb;
use super::node::{LEAF, Node, STACK, WIDTH};
use arrayvec::ArrayVec;
use obvhs::aabb::Aabb as ObvhsAabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::ploc::SortPrecision;
use obvhs::{Boundable, BvhBuildParams};
use std::time::Duration;

/// Cost of visiting a leaf of up to eight primitives, relative to visiting a node. The optimum is flat from 0.7 to 3.
const LEAF_COST: f32 = 1.5;

/// How long a hierarchy may take to build, for how fast it is traced.
///
/// `cargo bench --bench rays`, in units of [`Default`](Self::Default): seconds of building a million triangles of rolling hills (1.07 s
/// on two cores of a Xeon), and geometric means of the rays that a core traces in a second, of camera rays, two bounces and
/// shadows:
///
/// | | seconds | hills | 10,000 spheres | hall with slanting columns |
/// | --- | --- | --- | --- | --- |
/// | `Preview` | 0.6 | 0.98 | 0.93 | 0.95 |
/// | `Default` | 1 | 1 | 1 | 1 |
/// | `Best` | 2.9 | 1.07 | 1.05 | 1.12 |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Clustered, hardly improved.
    Preview,
    /// A part of the nodes is inserted anew where it costs less.
    #[default]
    Default,
    /// All of them, and large triangles in several leaves each, by parts: long thin ones in a slant are met more rarely.
    Best,
}

impl Quality {
    /// All, and what each is called.
    pub const ALL: [(Self, &str); 3] = [(Self::Preview, "preview"), (Self::Default, "default"), (Self::Best, "best")];

    fn params(self) -> BvhBuildParams {
        let params = match self {
            Self::Preview => BvhBuildParams::fast_build(),
            Self::Default => BvhBuildParams::slow_build(),
            Self::Best => BvhBuildParams::very_slow_build(),
        };
        BvhBuildParams {
            max_prims_per_leaf: 1,
            post_collapse_reinsertion_batch_ratio_multiplier: 0.0,
            pre_split: false,
            // 21 bits an axis; the others take half as much memory again as all nodes of a level.
            sort_precision: SortPrecision::U64,
            ..params
        }
    }
}

/// A wide tree: node 0 is the root.
#[derive(Debug, Default)]
pub(super) struct WideTree {
    pub(super) nodes: Vec<Node>,
    primitives: Vec<u32>,
    /// Where each leaf's primitives end.
    ends: Vec<u32>,
}

impl WideTree {
    /// The primitives of each leaf.
    pub(super) fn leaves(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        let from = |i: usize| if i == 0 { 0 } else { self.ends[i - 1] as usize };
        (0..self.ends.len()).map(move |i| &self.primitives[from(i)..self.ends[i] as usize])
    }
}

impl Boundable for Aabb {
    fn aabb(&self) -> ObvhsAabb {
        ObvhsAabb::new(self.min.into(), self.max.into())
    }
}

/// Builds a wide tree over boxes, none of them empty, with at most `most` ≤ 8 of them in a leaf.
pub(super) fn build(boxes: Vec<Aabb>, quality: Quality, most: usize) -> WideTree {
    if boxes.is_empty() {
        return WideTree::default();
    }
    let params = quality.params();
    // Heaps of coincident boxes make trees deeper than obvhs, in debug builds, asserts.
    let built = std::panic::catch_unwind(|| build_bvh2(&boxes, params, &mut Duration::default()));
    let bvh2 = built.unwrap_or_else(|_| balanced(&boxes));
    drop(boxes);
    match collapse(&bvh2, most) {
        (tree, depth) if depth * (WIDTH - 1) + 1 < STACK => tree,
        _ => collapse(&balanced(&boxes_of(&bvh2)), most).0,
    }
}

/// The boxes that a binary tree of one primitive a leaf was built over.
fn boxes_of(bvh2: &Bvh2) -> Vec<Aabb> {
    let mut boxes = vec![Aabb::EMPTY; bvh2.primitive_indices.len()];
    for leaf in bvh2.nodes.iter().filter(|node| node.is_leaf()) {
        let own = Aabb { min: leaf.aabb().min.into(), max: leaf.aabb().max.into() };
        for &i in &bvh2.primitive_indices[leaf.first_index as usize..][..leaf.prim_count as usize] {
            boxes[i as usize] = own;
        }
    }
    boxes
}

/// Binary tree by median splits: worse to traverse, but never deeper than log₂ n, whatever the geometry.
fn balanced(boxes: &[Aabb]) -> Bvh2 {
    let mut tree = Bvh2 { primitive_indices: (0..boxes.len() as u32).collect(), ..Bvh2::default() };
    tree.nodes.push(Bvh2Node::default());
    let mut todo = vec![(0usize, 0usize, boxes.len())];
    while let Some((node, lo, hi)) = todo.pop() {
        let ids = &mut tree.primitive_indices[lo..hi];
        let bounds = ids.iter().fold(Aabb::EMPTY, |b, &i| b.union(boxes[i as usize]));
        let aabb = ObvhsAabb::new(bounds.min.into(), bounds.max.into());
        if hi - lo == 1 {
            tree.nodes[node] = Bvh2Node::new(aabb, 1, lo as u32);
            continue;
        }
        let axis = (bounds.max - bounds.min).max_position();
        let centre = |i: u32| boxes[i as usize].min[axis] * 0.5 + boxes[i as usize].max[axis] * 0.5;
        let mid = (hi - lo) / 2;
        ids.select_nth_unstable_by(mid, |&a, &b| centre(a).total_cmp(&centre(b)));
        let first = tree.nodes.len();
        tree.nodes[node] = Bvh2Node::new(aabb, 0, first as u32);
        tree.nodes.extend([Bvh2Node::default(), Bvh2Node::default()]);
        todo.extend([(first, lo, lo + mid), (first + 1, lo + mid, hi)]);
    }
    tree
}

/// What the dynamic program decides at a binary node: how to split `i + 1` roots between its two children (0: keep it
/// whole), and whether it is a leaf.
#[derive(Clone, Default)]
struct Plan {
    split: [u8; WIDTH],
    leaf: bool,
}

/// What it knows of the node until its parent is decided: the least cost of its subtree as a forest of at most `i + 1` wide
/// children, and how many primitives are in it.
struct Known {
    cost: [f32; WIDTH - 1],
    primitives: u32,
}

/// Collapses a binary tree to the eight-wide tree of least SAH cost (Ylitie et al. 2017, section 3), and says its
/// depth.
fn collapse(bvh2: &Bvh2, most: usize) -> (WideTree, usize) {
    let order = preorder(bvh2);
    let best = plan(bvh2, &order, most);
    let mut tree = WideTree { nodes: vec![Node::EMPTY], ..WideTree::default() };
    let mut depth = 0;
    let mut todo = vec![(0usize, 0u32, 1usize)];
    while let Some((wide, binary, level)) = todo.pop() {
        depth = depth.max(level);
        // The children of a wide node: the forest of eight roots; a root that is a leaf stands alone.
        let mut children = Vec::with_capacity(WIDTH);
        if best[binary as usize].leaf {
            children.push(binary);
        } else {
            roots_of_children(bvh2, &best, binary, WIDTH, &mut children);
        }
        for (lane, &child) in children.iter().enumerate() {
            let node = &bvh2.nodes[child as usize];
            for axis in 0..3 {
                tree.nodes[wide].planes[2 * axis][lane] = node.aabb().min[axis];
                tree.nodes[wide].planes[2 * axis + 1][lane] = node.aabb().max[axis];
            }
            tree.nodes[wide].child[lane] = if best[child as usize].leaf {
                put_primitives_of(bvh2, child, &mut tree.primitives);
                tree.ends.push(tree.primitives.len() as u32);
                (tree.ends.len() - 1) as u32 | LEAF
            } else {
                let index = tree.nodes.len();
                tree.nodes.push(Node::EMPTY);
                todo.push((index, child, level + 1));
                index as u32
            };
        }
    }
    (tree, depth)
}

fn preorder(bvh2: &Bvh2) -> Vec<u32> {
    let mut order = Vec::with_capacity(bvh2.nodes.len());
    let mut todo = vec![0u32];
    while let Some(i) = todo.pop() {
        order.push(i);
        let node = &bvh2.nodes[i as usize];
        if !node.is_leaf() {
            todo.extend([node.first_index, node.first_index + 1]);
        }
    }
    order
}

/// Fills the dynamic program from the leaves up.
fn plan(bvh2: &Bvh2, preorder: &[u32], most: usize) -> Vec<Plan> {
    let mut plans = vec![Plan::default(); bvh2.nodes.len()];
    // Backwards a node comes right behind its subtrees, the second child's last.
    let mut known: Vec<Known> = Vec::new();
    for &i in preorder.iter().rev() {
        let node = &bvh2.nodes[i as usize];
        let area = node.aabb().half_area();
        let own = &mut plans[i as usize];
        let (right, left) = if node.is_leaf() { (None, None) } else { (known.pop(), known.pop()) };
        let (Some(left), Some(right)) = (left, right) else {
            own.leaf = true;
            known.push(Known { cost: [area * LEAF_COST; WIDTH - 1], primitives: node.prim_count });
            continue;
        };
        // Distribute j roots over the two children, for every j.
        let mut distributed = [f32::INFINITY; WIDTH + 1];
        for j in 2..=WIDTH {
            own.split[j - 1] = 1;
            for k in 1..j {
                let cost = left.cost[(k - 1).min(WIDTH - 2)] + right.cost[(j - k - 1).min(WIDTH - 2)];
                if cost < distributed[j] {
                    distributed[j] = cost;
                    own.split[j - 1] = k as u8;
                }
            }
        }
        // As one root: a leaf, or a node with eight roots below it.
        let primitives = left.primitives + right.primitives;
        let as_leaf = if primitives as usize <= most { area * LEAF_COST } else { f32::INFINITY };
        let as_node = distributed[WIDTH] + area;
        own.leaf = primitives as usize <= most && (as_leaf <= as_node || as_node.is_nan());
        let mut cost = [0.0; WIDTH - 1];
        cost[0] = as_leaf.min(as_node);
        // As up to j roots.
        for j in 2..WIDTH {
            cost[j - 1] = cost[j - 2].min(distributed[j]);
            if distributed[j] >= cost[j - 2] {
                own.split[j - 1] = 0;
            }
        }
        known.push(Known { cost, primitives });
    }
    plans
}

/// The at most `j` roots that stand for the two children of `binary`.
fn roots_of_children(bvh2: &Bvh2, best: &[Plan], binary: u32, j: usize, out: &mut Vec<u32>) {
    let k = best[binary as usize].split[j - 1].max(1) as usize;
    let first = bvh2.nodes[binary as usize].first_index;
    roots(bvh2, best, first, k, out);
    roots(bvh2, best, first + 1, j - k, out);
}

/// The at most `j` < 8 roots that stand for the subtree of `binary`.
fn roots(bvh2: &Bvh2, best: &[Plan], binary: u32, mut j: usize, out: &mut Vec<u32>) {
    if bvh2.nodes[binary as usize].is_leaf() {
        return out.push(binary);
    }
    while j > 1 && best[binary as usize].split[j - 1] == 0 {
        j -= 1;
    }
    if j == 1 { out.push(binary) } else { roots_of_children(bvh2, best, binary, j, out) }
}

/// Appends what is below `root`.
fn put_primitives_of(bvh2: &Bvh2, root: u32, out: &mut Vec<u32>) {
    let mut todo = ArrayVec::<u32, { WIDTH + 1 }>::new();
    todo.push(root);
    while let Some(i) = todo.pop() {
        let node = &bvh2.nodes[i as usize];
        if node.is_leaf() {
            let range = node.first_index as usize..(node.first_index + node.prim_count) as usize;
            out.extend(&bvh2.primitive_indices[range]);
        } else {
            todo.extend([node.first_index, node.first_index + 1]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn line(n: usize) -> Vec<Aabb> {
        // Sizes that grow geometrically make the deepest trees.
        (0..n)
            .map(|i| {
                let x = 1.5f32.powi((i % 150) as i32) * if i % 2 == 0 { 1.0 } else { -1.0 };
                Aabb { min: Vec3::new(x, 0.0, 0.0), max: Vec3::new(x + x.abs() * 0.1, 1.0, 1.0) }
            })
            .collect()
    }

    fn check(tree: &WideTree, boxes: &[Aabb]) {
        let mut seen = vec![0; boxes.len()];
        let leaves: Vec<&[u32]> = tree.leaves().collect();
        let mut todo = vec![0u32];
        while let Some(n) = todo.pop() {
            let node = &tree.nodes[n as usize];
            for lane in 0..WIDTH {
                match node.child[lane] {
                    super::super::node::NONE => {}
                    leaf if leaf & LEAF != 0 => {
                        let ids = leaves[(leaf & !LEAF) as usize];
                        assert!(!ids.is_empty() && ids.len() <= WIDTH);
                        for &i in ids {
                            seen[i as usize] += 1;
                            for axis in 0..3 {
                                assert!(node.planes[2 * axis][lane] <= boxes[i as usize].min[axis]);
                                assert!(node.planes[2 * axis + 1][lane] >= boxes[i as usize].max[axis]);
                            }
                        }
                    }
                    inner => todo.push(inner),
                }
            }
        }
        assert!(seen.iter().all(|&n| n == 1), "every primitive stands in exactly one leaf");
    }

    #[test]
    fn every_primitive_is_in_one_leaf_inside_its_box() {
        for n in [1, 2, 7, 8, 9, 63, 1000] {
            for (quality, _) in Quality::ALL {
                check(&build(line(n), quality, WIDTH), &line(n));
                let single = build(line(n), quality, 1);
                assert!(single.leaves().all(|ids| ids.len() == 1));
                check(&single, &line(n));
            }
            check(&collapse(&balanced(&line(n)), WIDTH).0, &line(n));
        }
    }

    #[test]
    fn boxes_are_found_again_in_the_tree() {
        let boxes = line(99);
        let bvh2 = build_bvh2(&boxes, Quality::Default.params(), &mut Duration::default());
        assert_eq!(boxes_of(&bvh2), boxes);
    }

    #[test]
    fn balanced_trees_are_shallow() {
        let (_, depth) = collapse(&balanced(&line(5000)), WIDTH);
        assert!(depth * (WIDTH - 1) + 1 < STACK, "depth {depth}");
    }

    #[test]
    fn coincident_and_enormous_boxes_survive() {
        let same = vec![Aabb { min: Vec3::ONE, max: Vec3::ONE }; 300];
        check(&build(same.clone(), Quality::Default, WIDTH), &same);
        let huge = vec![Aabb { min: Vec3::splat(-3e38), max: Vec3::splat(3e38) }; 20];
        check(&build(huge.clone(), Quality::Default, WIDTH), &huge);
    }
}
