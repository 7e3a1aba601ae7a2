//! Building the light tree.

use super::node::Node;
use super::{LightBounds, LightTree};
use glam::Vec3;

/// Bins per axis when a split is looked for.
const BINS: usize = 12;

/// From this depth lists are halved, so that no path is longer than a trail has bits: 40 + log₂ of the most lights.
const HALVE_FROM: u32 = 40;

/// A light: its number, its bounds, where it counts.
struct Item {
    light: u32,
    bounds: LightBounds,
    center: Vec3,
}

/// A node whose content is known and whose children are not.
struct Open {
    node: usize,
    from: usize,
    to: usize,
    trail: u64,
    depth: u32,
    bounds: LightBounds,
}

/// Splits from the root down, each where the children's summed cost is least of all bins and axes (Conty Estevez & Kulla
/// 2018, section 4.4: the surface area heuristic with intensity and orientation).
pub(super) fn build(lights: &[Option<LightBounds>], scale: f64) -> Option<LightTree> {
    let listed = lights.iter().enumerate().filter_map(|(i, b)| b.map(|bounds| (i as u32, bounds)));
    let mut items: Vec<Item> = listed.map(|(light, bounds)| Item { light, center: bounds.center(), bounds }).collect();
    let whole = union(&items)?;
    let mut trails = vec![None; lights.len()];
    let mut nodes = Vec::with_capacity(2 * items.len());
    let placeholder = Node::new(&whole, scale, 0, true);
    nodes.push(placeholder);
    let mut open = vec![Open { node: 0, from: 0, to: items.len(), trail: 0, depth: 0, bounds: whole }];
    while let Some(Open { node, from, to, trail, depth, bounds }) = open.pop() {
        let list = &mut items[from..to];
        if let [item] = list {
            nodes[node] = Node::new(&bounds, scale, item.light, true);
            trails[item.light as usize] = Some(trail);
            continue;
        }
        let middle = if depth < HALVE_FROM { best_split(list, &bounds) } else { None };
        let middle = middle.unwrap_or_else(|| halve(list));
        let (left, right) = list.split_at(middle);
        // Neither half is empty.
        let (Some(left), Some(right)) = (union(left), union(right)) else { return None };
        let first = nodes.len();
        nodes.extend([placeholder; 2]);
        nodes[node] = Node::new(&bounds, scale, first as u32, false);
        let split = from + middle;
        let child = |node, from, to, bit: u64, bounds| {
            let trail = trail | bit.checked_shl(depth).unwrap_or(0);
            Open { node, from, to, trail, depth: depth + 1, bounds }
        };
        open.push(child(first + 1, split, to, 1, right));
        open.push(child(first, from, split, 0, left));
    }
    Some(LightTree { nodes, trails })
}

fn union(items: &[Item]) -> Option<LightBounds> {
    items.iter().map(|item| item.bounds).reduce(|a, b| a.union(&b))
}

/// Orders the items into two lists at the best of the splits between bins; `None` where all centres coincide.
fn best_split(items: &mut [Item], bounds: &LightBounds) -> Option<usize> {
    let low = items.iter().fold(Vec3::INFINITY, |low, item| low.min(item.center));
    let high = items.iter().fold(Vec3::NEG_INFINITY, |high, item| high.max(item.center));
    let extent = bounds.max - bounds.min;
    let mut best: Option<(f64, usize, usize)> = None;
    for axis in 0..3 {
        if high[axis] <= low[axis] {
            continue;
        }
        let mut bins: [Option<LightBounds>; BINS] = [None; BINS];
        for item in items.iter() {
            let bin = &mut bins[bin(item.center[axis], low[axis], high[axis])];
            *bin = Some(bin.map_or(item.bounds, |b| b.union(&item.bounds)));
        }
        // Costs of all bins from one on, from above; then the lists below.
        let mut above = [0.0; BINS];
        let mut sum: Option<LightBounds> = None;
        for i in (1..BINS).rev() {
            sum = merged(sum, bins[i]);
            above[i] = sum.map_or(f64::INFINITY, |b| b.cost());
        }
        // Thin boxes are to be split along their length.
        let regular = f64::from(extent.max_element() / extent[axis].max(f32::MIN_POSITIVE));
        let mut sum = None;
        for i in 1..BINS {
            sum = merged(sum, bins[i - 1]);
            let Some(below) = sum else { continue };
            let cost = regular * (below.cost() + above[i]);
            if cost.is_finite() && best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, i));
            }
        }
    }
    let (_, axis, split) = best?;
    let middle = partition(items, |item| bin(item.center[axis], low[axis], high[axis]) < split);
    (0 < middle && middle < items.len()).then_some(middle)
}

fn merged(a: Option<LightBounds>, b: Option<LightBounds>) -> Option<LightBounds> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.union(&b)),
        (a, b) => a.or(b),
    }
}

fn bin(x: f32, low: f32, high: f32) -> usize {
    let at = (x * 0.5 - low * 0.5) / (high * 0.5 - low * 0.5) * BINS as f32;
    (at as usize).min(BINS - 1)
}

/// Two halves along the widest axis of the centres.
fn halve(items: &mut [Item]) -> usize {
    let low = items.iter().fold(Vec3::INFINITY, |low, item| low.min(item.center));
    let high = items.iter().fold(Vec3::NEG_INFINITY, |high, item| high.max(item.center));
    let axis = (high - low).max_position();
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| a.center[axis].total_cmp(&b.center[axis]));
    middle
}

/// Moves what fulfils the condition to the front; how many that is.
fn partition(items: &mut [Item], fulfils: impl Fn(&Item) -> bool) -> usize {
    let mut front = 0;
    for i in 0..items.len() {
        if fulfils(&items[i]) {
            items.swap(front, i);
            front += 1;
        }
    }
    front
}
