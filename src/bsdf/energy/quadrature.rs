//! Means over visible normals by deterministic quadrature, in f64.

use glam::DVec3;
use std::f64::consts::PI;

/// Gauss–Legendre nodes and weights on \[0, 1\], by Newton's method on Pₙ (Abramowitz & Stegun 25.4.29).
pub(in crate::bsdf) fn gauss_legendre<const N: usize>() -> [(f64, f64); N] {
    std::array::from_fn(|i| {
        let n = N as f64;
        let mut x = (PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..50 {
            let (mut p, mut before) = (x, 1.0);
            for k in 2..=N {
                let k = k as f64;
                (p, before) = (((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k, p);
            }
            slope = n * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
    })
}

/// Nodes of a mean over visible normals: along a ray from `o`, and in the angle of the ray, a panel each.
#[derive(Clone, Debug)]
pub(super) struct Rule {
    along: Vec<(f64, f64)>,
    across: Vec<(f64, f64)>,
    across_bends: Vec<(f64, f64)>,
}

impl Rule {
    /// With this many nodes a panel.
    pub(super) fn new<const ALONG: usize, const ACROSS: usize>() -> Self {
        // x → x²(3 − 2x) flattens both ends of a panel, so that square-root edges cost no accuracy.
        let flat = |(x, w): (f64, f64)| (x * x * (3.0 - 2.0 * x), w * 6.0 * x * (1.0 - x));
        Self {
            along: gauss_legendre::<ALONG>().map(flat).to_vec(),
            across: gauss_legendre::<ACROSS>().to_vec(),
            across_bends: gauss_legendre::<ACROSS>().map(flat).to_vec(),
        }
    }

    /// ∫ g(m) D_o(m) dm for GGX of roughness `a`, o.z > 0. `edges` are functions of m whose zeros are kinks of `g`.
    ///
    /// Stretched to unit roughness, D is constant and the visible normals fill the part of the hemisphere about `o`
    /// above the horizon, uniformly in projection along `o` (Heitz 2018, "Sampling the GGX Distribution of Visible
    /// Normals"). In polar coordinates about `o` it is star-shaped, and so are the sets of normals that reflect to one
    /// side (disks of slopes): rays from `o` meet each kink once. They are cut there and at the scales of steep
    /// normals, 1 − v = α² and α.
    pub(super) fn visible_mean<const K: usize, const C: usize>(
        &self,
        o: DVec3,
        a: [f64; 2],
        edges: impl Fn(DVec3) -> [f64; K],
        g: impl Fn(DVec3) -> [f64; C],
    ) -> [f64; C] {
        let s = DVec3::new(a[0] * o.x, a[1] * o.y, o.z).normalize();
        let sin = s.truncate().length();
        let across = if sin > 0.0 { DVec3::new(-s.y, s.x, 0.0) / sin } else { DVec3::Y };
        let up = s.cross(across);
        let scale = (a[0] * a[1]).sqrt();
        // t in [−1, 1] → the ray at (1 + t³)π/2 from upwards: crowded where the boundary of the domain bends.
        let ray = |t: f64, side: f64| {
            let (sin, cos) = (0.5 * PI * (1.0 + t * t * t)).sin_cos();
            let ray = up * cos + across * (side * sin);
            let end = if ray.z >= 0.0 { 1.0 } else { s.z * s.z / (s.z * s.z + ray.z * ray.z) };
            (ray, end)
        };
        // v: 0 at the end of the ray, 1 at o; sin² of the angle to o is end (1 − v).
        let normal = |(ray, end): (DVec3, f64), v: f64| {
            let m = s * (1.0 - end + end * v).max(0.0).sqrt() + ray * (end * (1.0 - v)).sqrt();
            DVec3::new(a[0] * m.x, a[1] * m.y, m.z.max(0.0)).normalize_or(DVec3::Z)
        };
        let mut sum = [0.0; C];
        // Half of the rays suffice where both sides of the plane of o are alike.
        let sides: &[f64] = if a[0] == a[1] { &[1.0] } else { &[1.0, -1.0] };
        for &side in sides {
            let crossed = |t: f64| {
                let ray = ray(t, side);
                sign_changes(|v| edges(normal(ray, v)), scale)
            };
            for pair in bends(crossed).windows(2) {
                let bent = pair.iter().any(|t| t.fract() != 0.0);
                for &(x, w) in if bent { &self.across_bends } else { &self.across } {
                    let t = pair[0] + (pair[1] - pair[0]) * x;
                    let (ray, end) = ray(t, side);
                    let share = w * (pair[1] - pair[0]) * 3.0 * t * t * end / (1.0 + s.z) / sides.len() as f64;
                    let mut cuts = vec![0.0, scale * scale, scale, 1.0];
                    crossings(|v| edges(normal((ray, end), v)), scale, &mut cuts);
                    cuts.sort_by(f64::total_cmp);
                    for pair in cuts.windows(2).filter(|p| p[1] - p[0] > 1e-14) {
                        let width = pair[1] - pair[0];
                        for &(x, w) in &self.along {
                            let value = g(normal((ray, end), pair[0] + width * x));
                            sum = std::array::from_fn(|k| sum[k] + value[k] * w * width * share);
                        }
                    }
                }
            }
        }
        sum
    }
}

/// Points along a ray at which edges are looked for, half of them below the scale α of steep normals.
const STEPS: usize = 6;

fn step(i: usize, scale: f64) -> f64 {
    let (t, low) = (i as f64 / STEPS as f64, scale.min(0.5));
    if t <= 1.0 { low * t * t * t } else { low + (1.0 - low) * (t - 1.0) }
}

/// How often each component of `f` changes its sign along a ray.
fn sign_changes<const K: usize>(f: impl Fn(f64) -> [f64; K], scale: f64) -> [usize; K] {
    let mut count = [0; K];
    let mut before = f(0.0);
    for i in 1..=2 * STEPS {
        let now = f(step(i, scale));
        for k in 0..K {
            count[k] += usize::from((before[k] < 0.0) != (now[k] < 0.0));
        }
        before = now;
    }
    count
}

/// −1, 0, 1 and the points between at which `of` changes, in order.
fn bends<T: PartialEq>(of: impl Fn(f64) -> T) -> Vec<f64> {
    const N: i32 = 10;
    let mut points = vec![-1.0];
    for i in -N..N {
        let (mut a, mut b) = (f64::from(i) / f64::from(N), f64::from(i + 1) / f64::from(N));
        let (at_a, at_b) = (of(a), of(b));
        if at_a != at_b {
            for _ in 0..14 {
                let c = 0.5 * (a + b);
                if of(c) == at_a { a = c } else { b = c }
            }
            points.push(0.5 * (a + b));
        }
        if i == -1 {
            points.push(0.0);
        }
    }
    points.push(1.0);
    points
}

/// Appends the zeros of every component of `f` on \[0, 1\]: sign changes between fixed points, then the Illinois form of
/// regula falsi.
fn crossings<const K: usize>(f: impl Fn(f64) -> [f64; K], scale: f64, zeros: &mut Vec<f64>) {
    let (mut v0, mut f0) = (0.0, f(0.0));
    for i in 1..=2 * STEPS {
        let v1 = step(i, scale);
        let f1 = f(v1);
        for k in 0..K {
            if (f0[k] < 0.0) == (f1[k] < 0.0) {
                continue;
            }
            let (mut a, mut fa, mut b, mut fb) = (v0, f0[k], v1, f1[k]);
            for _ in 0..40 {
                if (b - a).abs() <= 1e-13 * v1 {
                    break;
                }
                let c = (a * fb - b * fa) / (fb - fa);
                let fc = f(c)[k];
                if fc == 0.0 {
                    (a, b) = (c, c);
                } else if (fc < 0.0) == (fb < 0.0) {
                    (b, fb) = (c, fc);
                    fa *= 0.5;
                } else {
                    (a, fa, b, fb) = (b, fb, c, fc);
                }
            }
            zeros.push(b);
        }
        (v0, f0) = (v1, f1);
    }
}
