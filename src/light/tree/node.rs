//! A node of the light tree, and what it may send to a point.

use super::LightBounds;
use crate::light::{Facing, Receiver};
use crate::math::{safe_sqrt, sqr};
use glam::{Vec3A, Vec4};

/// Bounds as the traversal reads them: the sphere about the box, the cone, the intensity, 48 bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Middle of the sphere that holds the box, and its squared radius.
    sphere: Vec4,
    /// Axis of the cone, and the cosine beyond its spread where the emission ends.
    cone: Vec4,
    spread: Angle,
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
            spread: Angle { sin: bounds.spread.sin() as f32, cos: bounds.spread.cos() as f32 },
            intensity: (bounds.intensity * scale) as f32,
            both: bounds.both,
            next,
            leaf,
        }
    }

    /// About what arrives at the receiver, intensity × ⟨1/d²⟩ × cos at the light × cos at the receiver; 0 only where
    /// nothing can arrive (Conty Estevez & Kulla 2018, section 4.2; PBRT 4th ed., section 12.6.3).
    ///
    /// θ' = max(0, θ_w − θₒ − θ_b) is the least angle between the direction to the receiver and the axis of a light in the
    /// node, with θ_b the half-angle of the node's sphere: nothing arrives where θ' ≥ θₑ, nor where θᵢ' = max(0, θᵢ − θ_b),
    /// the least angle to the receiver's normal, is a right one. Within the sphere all angles are possible. The cosines
    /// are means of these bounds and of what holds at the sphere's middle: that has half the error of the bounds alone.
    #[inline]
    pub(super) fn importance(&self, receiver: &Receiver) -> f32 {
        /// Keeps sums finite.
        const MOST: f32 = 1e30;
        /// Least cosine at the light, for the penumbra of a spot may be wider than a right angle.
        const FAINT: f32 = 1e-3;
        let radius2 = self.sphere.w;
        let to = Vec3A::from_vec4(self.sphere) - receiver.p;
        let d2 = to.length_squared();
        // The mean of 1/d² over a ball is 3/r² from its middle and 1/d² from afar.
        let near = self.intensity / (d2 + radius2 * (1.0 / 3.0)).max(f32::MIN_POSITIVE);
        if d2 <= radius2 {
            return near.min(MOST);
        }
        let wi = to / d2.sqrt();
        let sin2_b = radius2 / d2;
        let b = Angle { sin: sin2_b.sqrt(), cos: safe_sqrt(1.0 - sin2_b) };

        let cos_w = -wi.dot(Vec3A::from_vec4(self.cone));
        let middle = Angle::of_cos(if self.both { cos_w.abs() } else { cos_w }).less(self.spread);
        let bound = middle.less(b).cos;
        if bound <= self.cone.w {
            return 0.0;
        }
        let emitted = 0.5 * (bound + middle.cos.max(0.0)).max(FAINT);

        let cosine = |cos: f32| match Angle::of_cos(cos).less(b).cos {
            bound if bound > 0.0 => 0.5 * (bound + cos.max(0.0)),
            _ => 0.0,
        };
        let received = match receiver.facing {
            Facing::All => 1.0,
            Facing::Half(n) => cosine(n.dot(wi)),
            Facing::Both(n) => cosine(n.dot(wi).abs()),
        };
        (near * emitted * received).min(MOST)
    }
}

/// An angle in \[0, π\] by its sine and cosine.
#[derive(Clone, Copy, Debug)]
struct Angle {
    sin: f32,
    cos: f32,
}

impl Angle {
    #[inline]
    fn of_cos(cos: f32) -> Self {
        Self { sin: safe_sqrt(1.0 - cos * cos), cos }
    }

    /// max(0, self − other).
    #[inline]
    fn less(self, other: Self) -> Self {
        if self.cos > other.cos {
            return Self { sin: 0.0, cos: 1.0 };
        }
        Self { sin: self.sin * other.cos - self.cos * other.sin, cos: self.cos * other.cos + self.sin * other.sin }
    }
}
