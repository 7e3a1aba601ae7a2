//! Integrals over rectangles, cut where the integrand asks for it.

/// Nodes and weights of Gauss and Legendre on \[−1, 1\], five of them (Abramowitz & Stegun 25.4.29).
const NODES: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// A rectangle: from and to, in either variable.
pub(super) type Rectangle = [[f64; 2]; 2];

/// An integral of several components, with what was seen of its error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Integral<const K: usize> {
    pub(super) value: [f64; K],
    /// Sum over the cells of the largest difference between a cell and its four parts.
    pub(super) error: f64,
}

/// ∫∫ f(x, y) dx dy: a cell is cut in four until it agrees with its parts to `tolerance`, or `depth` cuts are made.
pub(super) fn integrate<const K: usize>(
    f: &impl Fn(f64, f64) -> [f64; K],
    cell: Rectangle,
    tolerance: f64,
    depth: u32,
) -> Integral<K> {
    let mut total = Integral { value: [0.0; K], error: 0.0 };
    refine(f, cell, gauss(f, cell), tolerance, depth, &mut total);
    total
}

fn refine<const K: usize>(
    f: &impl Fn(f64, f64) -> [f64; K],
    [[x0, x1], [y0, y1]]: Rectangle,
    whole: [f64; K],
    tolerance: f64,
    depth: u32,
    total: &mut Integral<K>,
) {
    let (x, y) = (0.5 * (x0 + x1), 0.5 * (y0 + y1));
    let quarters = [[[x0, x], [y0, y]], [[x, x1], [y0, y]], [[x0, x], [y, y1]], [[x, x1], [y, y1]]];
    let parts = quarters.map(|quarter| gauss(f, quarter));
    let sum: [f64; K] = std::array::from_fn(|k| parts.iter().map(|part| part[k]).sum());
    let error = (0..K).map(|k| (sum[k] - whole[k]).abs()).fold(0.0, f64::max);
    // What is no number stays so, however finely it is cut.
    if error <= tolerance || depth == 0 || error.is_nan() {
        total.value = std::array::from_fn(|k| total.value[k] + sum[k]);
        total.error += error;
        return;
    }
    for (quarter, part) in quarters.into_iter().zip(parts) {
        refine(f, quarter, part, tolerance, depth - 1, total);
    }
}

fn gauss<const K: usize>(f: &impl Fn(f64, f64) -> [f64; K], [[x0, x1], [y0, y1]]: Rectangle) -> [f64; K] {
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
        // A Gaussian of width 1e-3 beside the middle, and the area of a quarter disk.
        let peak = |x: f64, y: f64| (-(x - 0.3).powi(2) / 2e-6 - (y - 0.3).powi(2) / 2e-6).exp() / 2e-6;
        let disk = |x: f64, y: f64| f64::from(x * x + y * y < 1.0);
        let both = |x: f64, y: f64| [peak(x, y), disk(x, y)];
        let found = integrate(&both, [[0.0, 1.0], [0.0, 1.0]], 1e-7, 12);
        let exact = [std::f64::consts::PI, 0.25 * std::f64::consts::PI];
        for k in 0..2 {
            assert!((found.value[k] - exact[k]).abs() < 1e-4, "{found:?}");
        }
        assert!(found.error < 1e-3, "{found:?}");
    }
}
