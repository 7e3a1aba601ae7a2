//! Curves through keyframes (glTF 2.0, appendix C).

use glam::DVec4;
use serde::Deserialize;

/// What a curve is between its keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub(super) enum Interpolation {
    /// The value of the last key.
    Step,
    /// The segment, or the arc, between two keys.
    #[default]
    Linear,
    /// A cubic through two keys with the slopes that they state.
    CubicSpline,
}

impl Interpolation {
    /// Values of a key: a cubic has slopes before and behind it.
    pub(super) fn values(self) -> usize {
        if self == Self::CubicSpline { 3 } else { 1 }
    }
}

/// Keys and what is between them. There is at least one; times increase.
pub(super) struct Curve<'a> {
    pub times: &'a [f32],
    /// All numbers of all keys; a key of a cubic is its in-tangent, its value, and its out-tangent.
    pub values: &'a [f32],
    /// Numbers of a value.
    pub lanes: usize,
    pub interpolation: Interpolation,
}

/// Where a time lies between two keys.
struct Segment {
    /// The key before it; the next one is behind it.
    key: usize,
    /// Part of the way, in [0, 1).
    u: f64,
    /// Length \[s\].
    length: f64,
}

impl Curve<'_> {
    /// The value at time `t`; before the first key and behind the last one, theirs.
    pub(super) fn at(&self, t: f64) -> Vec<f64> {
        let Segment { key, u, length } = match self.segment(t) {
            Ok(segment) => segment,
            Err(key) => return self.value(key).to_vec(),
        };
        let (a, b) = (self.value(key), self.value(key + 1));
        let pairs = a.iter().zip(&b);
        match self.interpolation {
            Interpolation::Step => a,
            Interpolation::Linear => pairs.map(|(a, b)| (1.0 - u) * a + u * b).collect(),
            Interpolation::CubicSpline => {
                // (2u³−3u²+1) vₖ + L(u³−2u²+u) bₖ + (−2u³+3u²) vₖ₊₁ + L(u³−u²) aₖ₊₁
                let (u2, u3) = (u * u, u * u * u);
                let (out, into) = (self.numbers(3 * key + 2), self.numbers(3 * (key + 1)));
                let slopes = out.iter().zip(&into);
                let spline = |((v, w), (b, a)): ((&f64, &f64), (&f64, &f64))| {
                    (2.0 * u3 - 3.0 * u2 + 1.0) * v
                        + length * (u3 - 2.0 * u2 + u) * b
                        + (3.0 * u2 - 2.0 * u3) * w
                        + length * (u3 - u2) * a
                };
                pairs.zip(slopes).map(spline).collect()
            }
        }
    }

    /// The unit quaternion at time `t`, along the shorter arc between keys.
    pub(super) fn rotation(&self, t: f64) -> [f64; 4] {
        let quaternion = |v: Vec<f64>| DVec4::from_slice(&v);
        let q = match (self.interpolation, self.segment(t)) {
            (Interpolation::Linear, Ok(Segment { key, u, .. })) => {
                slerp(quaternion(self.value(key)), quaternion(self.value(key + 1)), u)
            }
            _ => quaternion(self.at(t)),
        };
        q.normalize_or(q).to_array()
    }

    /// The keys about `t`, or the one that counts alone.
    fn segment(&self, t: f64) -> Result<Segment, usize> {
        let next = self.times.partition_point(|key| f64::from(*key) <= t);
        if next == 0 || next == self.times.len() {
            return Err(next.saturating_sub(1));
        }
        let [start, end] = [next - 1, next].map(|key| f64::from(self.times[key]));
        Ok(Segment { key: next - 1, u: (t - start) / (end - start), length: end - start })
    }

    fn value(&self, key: usize) -> Vec<f64> {
        let values = self.interpolation.values();
        self.numbers(key * values + values / 2)
    }

    /// The numbers of tangent or value `n`.
    fn numbers(&self, n: usize) -> Vec<f64> {
        self.values[n * self.lanes..][..self.lanes].iter().map(|x| f64::from(*x)).collect()
    }
}

/// sin(α(1−u))/sin α · q + sin(αu)/sin α · (±r) with cos α = |q·r|.
fn slerp(q: DVec4, r: DVec4, u: f64) -> DVec4 {
    let (q, r) = (q.normalize_or(q), r.normalize_or(r));
    let cosine = q.dot(r);
    let r = if cosine < 0.0 { -r } else { r };
    // The angle from the chord stays exact where the cosine is close to 1.
    let angle = 2.0 * (0.5 * (q - r).length()).min(1.0).asin();
    if angle.sin() < 1e-9 {
        return q.lerp(r, u);
    }
    ((angle * (1.0 - u)).sin() * q + (angle * u).sin() * r) / angle.sin()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arcs_are_walked_evenly() {
        let turn = |angle: f64| DVec4::new(0.0, (0.5 * angle).sin(), 0.0, (0.5 * angle).cos());
        for end in [1e-10, 1e-3, 1.0, 3.1] {
            for u in [0.0, 0.25, 0.5, 1.0] {
                assert!(slerp(turn(0.0), turn(end), u).abs_diff_eq(turn(u * end), 1e-12), "{end} {u}");
                assert!(slerp(turn(0.0), -turn(end), u).abs_diff_eq(turn(u * end), 1e-12), "−{end} {u}");
            }
        }
    }

    #[test]
    fn cubics_have_the_slopes_of_their_keys() {
        // t³ on [0, 2]: slopes 0 and 12.
        let curve = Curve {
            times: &[0.0, 2.0],
            values: &[9.0, 0.0, 0.0, 12.0, 8.0, 9.0],
            lanes: 1,
            interpolation: Interpolation::CubicSpline,
        };
        for t in [0.0, 0.3, 1.0, 1.7] {
            assert!((curve.at(t)[0] - t.powi(3)).abs() < 1e-12, "{t}");
        }
        assert_eq!([curve.at(-1.0), curve.at(2.0), curve.at(5.0)], [[0.0], [8.0], [8.0]]);
    }
}
