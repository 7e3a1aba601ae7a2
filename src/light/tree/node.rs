//! A node of the light tree, and what it may send to a point.

use super::LightBounds;
use crate::light::{Facing, LightSampleContext};
use crate::math::sqr;
use glam::{BVec4A, Vec3A, Vec4};

/// Bounds as the traversal reads them: the sphere about the box, the cone, the intensity, 48 bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Middle of the sphere that holds the box, and its squared radius.
    sphere: Vec4,
    /// Axis of the cone, and the cosine beyond its spread where the emission ends.
    cone: Vec4,
    /// Sine and cosine of the spread.
    spread: [f32; 2],
    /// Relative to all lights.
    intensity: f32,
    both: bool,
    /// Index of the first of two children, or of a light.
    pub(super) next: u32,
    pub(super) leaf: bool,
}

impl Node {
    /// `scale` makes the intensity relative.
    pub(super) fn new(bounds: &LightBounds, scale: f64, next: u32, leaf: bool) -> Self {
        let (center, radius) = (bounds.center(), (bounds.max * 0.5 - bounds.min * 0.5).length());
        // What rounding takes from the sphere, the centre's included, is given back.
        let rounding = 4.0 * f32::EPSILON * (radius + center.length());
        Self {
            sphere: center.extend(if radius > 0.0 { sqr(radius + rounding) } else { 0.0 }),
            cone: bounds.axis.as_vec3().extend(bounds.fade.cos() as f32),
            spread: [bounds.spread.sin() as f32, bounds.spread.cos() as f32],
            intensity: (bounds.intensity * scale) as f32,
            both: bounds.both,
            next,
            leaf,
        }
    }

    /// About what arrives at the receiver from each of two nodes, intensity × ⟨1/d²⟩ × cos at the light × cos at the receiver; 0
    /// only where nothing can arrive (Conty Estevez & Kulla 2018, section 4.2; PBRT 4th ed., section 12.6.3).
    ///
    /// θ' = max(0, θ_w − θₒ − θ_b) is the least angle between the direction to the receiver and the axis of a light in the
    /// node, with θ_b the half-angle of the node's sphere: nothing arrives where θ' ≥ θₑ, nor where θᵢ' = max(0, θᵢ − θ_b),
    /// the least angle to the receiver's normal, is a right one. Within the sphere all angles are possible. The cosines
    /// are means of these bounds and of what holds at the sphere's middle: that has half the error of the bounds alone.
    ///
    /// Both at once, in lanes of a register: roots and quotients are most of the work.
    #[inline]
    pub(super) fn importances([a, b]: [&Self; 2], receiver: &LightSampleContext) -> [f32; 2] {
        /// Keeps sums finite.
        const MOST: f32 = 1e30;
        /// Least cosine at the light, for the penumbra of a spot may be wider than a right angle.
        const FAINT: f32 = 1e-3;
        let lanes = |a: f32, b: f32| Vec4::new(a, b, a, b);
        let [to_a, to_b] = [a, b].map(|node| Vec3A::from_vec4(node.sphere) - receiver.p);
        let (radius2, d2) = (lanes(a.sphere.w, b.sphere.w), lanes(to_a.length_squared(), to_b.length_squared()));
        // The mean of 1/d² over a ball is 3/r² from its middle and 1/d² from afar.
        let spread2 = (d2 + radius2 * (1.0 / 3.0)).max(Vec4::splat(f32::MIN_POSITIVE));
        let near = (lanes(a.intensity, b.intensity) / spread2).min(Vec4::splat(MOST));
        // Of no meaning within the sphere.
        let (d_inv, sin2_b) = (d2.sqrt().recip(), radius2 / d2);
        let ball = Angle { sin: sin2_b.sqrt(), cos: root(1.0 - sin2_b) };

        let cos_w = lanes(-to_a.dot(Vec3A::from_vec4(a.cone)), -to_b.dot(Vec3A::from_vec4(b.cone))) * d_inv;
        let both = BVec4A::new(a.both, b.both, false, false);
        let spread = Angle { sin: lanes(a.spread[0], b.spread[0]), cos: lanes(a.spread[1], b.spread[1]) };
        let middle = Angle::of_cos(Vec4::select(both, cos_w.abs(), cos_w)).less(spread);
        let bound = middle.less(ball).cos;
        let dark = bound.cmple(lanes(a.cone.w, b.cone.w));
        let emitted = 0.5 * (bound + middle.cos.max(Vec4::ZERO)).max(Vec4::splat(FAINT));

        let cosines = |n: Vec3A| lanes(n.dot(to_a), n.dot(to_b)) * d_inv;
        let received = match receiver.facing {
            Facing::All => Vec4::ONE,
            Facing::Half(n) => ball.mean_cosine(cosines(n)),
            Facing::Both(n) => ball.mean_cosine(cosines(n).abs()),
        };
        let outside = Vec4::select(dark, Vec4::ZERO, near * emitted * received);
        let [a, b, ..] = Vec4::select(d2.cmple(radius2), near, outside).to_array();
        [a, b]
    }
}

/// √max(0, x).
#[inline]
fn root(x: Vec4) -> Vec4 {
    x.max(Vec4::ZERO).sqrt()
}

/// Angles in \[0, π\] by their sines and cosines.
#[derive(Clone, Copy, Debug)]
struct Angle {
    sin: Vec4,
    cos: Vec4,
}

impl Angle {
    #[inline]
    fn of_cos(cos: Vec4) -> Self {
        Self { sin: root(1.0 - cos * cos), cos }
    }

    /// max(0, self − other).
    #[inline]
    fn less(self, other: Self) -> Self {
        let none = self.cos.cmpgt(other.cos);
        Self {
            sin: Vec4::select(none, Vec4::ZERO, self.sin * other.cos - self.cos * other.sin),
            cos: Vec4::select(none, Vec4::ONE, self.cos * other.cos + self.sin * other.sin),
        }
    }

    /// Mean of the cosine of a direction and of the greatest within this angle of it; 0 where none is positive.
    #[inline]
    fn mean_cosine(self, cos: Vec4) -> Vec4 {
        let bound = Self::of_cos(cos).less(self).cos;
        Vec4::select(bound.cmpgt(Vec4::ZERO), 0.5 * (bound + cos.max(Vec4::ZERO)), Vec4::ZERO)
    }
}
