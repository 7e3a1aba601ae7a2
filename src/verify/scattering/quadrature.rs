//! Integrals over rectangles, cut where the integrand asks for it.

/// Nodes and weights of Gauss and Lobatto on \[−1, 1\], five of them (Abramowitz & Stegun 25.4.32): with the ends, so that
/// an edge of the integrand that cuts a sliver off a cell is seen. They stand a little inside, for the horizon is
/// on neither side.
const NODES: [(f64, f64); 5] = [
    (0.0, 32.0 / 45.0),
    (0.654_653_670_707_977_1, 49.0 / 90.0),
    (-0.654_653_670_707_977_1, 49.0 / 90.0),
    (0.999_999, 0.1),
    (-0.999_999, 0.1),
];

/// A rectangle: from and to, in either variable.
pub(super) type Rectangle = [[f64; 2]; 2];

/// An integral of several components, with what was seen of its error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Integral<const K: usize> {
    pub(super) value: [f64; K],
    /// Sum over the cells of the largest difference between a cell and its four parts.
    pub(super) error: f64,
    /// Rules of 25 nodes that were evaluated.
    pub(super) rules: u64,
}

impl<const K: usize> Default for Integral<K> {
    fn default() -> Self {
        Self { value: [0.0; K], error: 0.0, rules: 0 }
    }
}

/// When a cell is cut no further.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop {
    /// It agrees with its parts to this.
    pub(super) tolerance: f64,
    /// Its first component agrees with the number of `points` in it, each of which stands for this much: so no peak
    /// between the nodes stays unseen.
    pub(super) point: f64,
    /// It was cut so often.
    pub(super) depth: u32,
    /// So many rules were evaluated.
    pub(super) rules: u64,
}

/// Adds ∫∫ f(x, y) dx dy over a cell that contains these `points` to `total`; cells are cut in four until `stop` says
/// that it is enough. The points guide the cuts alone: the integral is that of f.
pub(super) fn integrate<const K: usize>(
    f: &impl Fn(f64, f64) -> [f64; K],
    cell: Rectangle,
    points: &mut [[f64; 2]],
    stop: Stop,
    total: &mut Integral<K>,
) {
    refine(f, cell, rule(f, cell), points, stop, total);
}

fn refine<const K: usize>(
    f: &impl Fn(f64, f64) -> [f64; K],
    [[x0, x1], [y0, y1]]: Rectangle,
    whole: [f64; K],
    points: &mut [[f64; 2]],
    stop: Stop,
    total: &mut Integral<K>,
) {
    let (x, y) = (0.5 * (x0 + x1), 0.5 * (y0 + y1));
    let quarters = [[[x0, x], [y0, y]], [[x, x1], [y0, y]], [[x0, x], [y, y1]], [[x, x1], [y, y1]]];
    let parts = quarters.map(|quarter| rule(f, quarter));
    total.rules += 4;
    let sum: [f64; K] = std::array::from_fn(|k| parts.iter().map(|part| part[k]).sum());
    let error = (0..K).map(|k| (sum[k] - whole[k]).abs()).fold(0.0, f64::max);
    let promised = sum[0] / stop.point;
    let expected = (points.len() as f64 - promised).abs() <= 3.0 * promised.max(0.0).sqrt() + 0.5;
    // What is no number stays so, however finely it is cut.
    let enough = stop.depth == 0 || total.rules > stop.rules || error.is_nan();
    if enough || (error <= stop.tolerance && expected) {
        total.value = std::array::from_fn(|k| total.value[k] + sum[k]);
        total.error += error;
        return;
    }
    let stop = Stop { depth: stop.depth - 1, ..stop };
    let (lower, upper) = split(points, |p| p[1] < y);
    let (ll, lr) = split(lower, |p| p[0] < x);
    let (ul, ur) = split(upper, |p| p[0] < x);
    for ((quarter, part), points) in quarters.into_iter().zip(parts).zip([ll, lr, ul, ur]) {
        refine(f, quarter, part, points, stop, total);
    }
}

/// Reorders: those that hold first.
pub(super) fn split<T>(items: &mut [T], holds: impl Fn(&T) -> bool) -> (&mut [T], &mut [T]) {
    let mut n = 0;
    for i in 0..items.len() {
        if holds(&items[i]) {
            items.swap(i, n);
            n += 1;
        }
    }
    items.split_at_mut(n)
}

fn rule<const K: usize>(f: &impl Fn(f64, f64) -> [f64; K], [[x0, x1], [y0, y1]]: Rectangle) -> [f64; K] {
    let (cx, hx, cy, hy) = (0.5 * (x0 + x1), 0.5 * (x1 - x0), 0.5 * (y0 + y1), 0.5 * (y1 - y0));
    let mut sum = [0.0; K];
    for a in NODES {
        for b in NODES {
            let value = f(cx + hx * a.0, cy + hy * b.0);
            sum = std::array::from_fn(|k| sum[k] + a.1 * b.1 * hx * hy * value[k]);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_and_edges_are_found() {
        // A Gaussian of width 0.05 beside the middle, and the area of a quarter disk.
        let peak = |x: f64, y: f64| (-((x - 0.3).powi(2) + (y - 0.3).powi(2)) / 5e-3).exp() / 5e-3;
        let disk = |x: f64, y: f64| f64::from(x * x + y * y < 1.0);
        let both = |x: f64, y: f64| [peak(x, y), disk(x, y)];
        let mut found = Integral::default();
        let stop = Stop { tolerance: 1e-7, point: 1.0, depth: 12, rules: 100_000 };
        integrate(&both, [[0.0, 1.0], [0.0, 1.0]], &mut [], stop, &mut found);
        let exact = [std::f64::consts::PI, 0.25 * std::f64::consts::PI];
        for k in 0..2 {
            assert!((found.value[k] - exact[k]).abs() < 1e-4, "{found:?}");
        }
        assert!(found.error < 1e-3, "{found:?}");
    }

    #[test]
    fn points_lead_to_what_nodes_miss() {
        let w = 1e-5;
        let peak = |x: f64, y: f64| [(-((x - 0.3).powi(2) + (y - 0.2).powi(2)) / (2.0 * w * w)).exp() / (w * w)];
        let mut points: Vec<[f64; 2]> = (0..100).map(|i| [0.3 + w * (f64::from(i) * 0.7).sin(), 0.2]).collect();
        let stop = Stop { tolerance: 1e-7, point: 0.01, depth: 24, rules: 100_000 };
        let [mut blind, mut led] = [Integral::default(); 2];
        integrate(&peak, [[0.0, 1.0], [0.0, 1.0]], &mut [], Stop { point: 1e9, ..stop }, &mut blind);
        integrate(&peak, [[0.0, 1.0], [0.0, 1.0]], &mut points, stop, &mut led);
        assert!(blind.value[0] < 0.1 && (led.value[0] - std::f64::consts::TAU).abs() < 1e-4, "{blind:?} {led:?}");
    }
}
