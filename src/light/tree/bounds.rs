//! Where lights stand, where they shine to, and how strongly.

use glam::{DQuat, DVec3, Vec3, Vec3A};
use std::f64::consts::{FRAC_PI_2, PI};

/// What encloses one light or many: nothing of their intensity leaves the box's points in other directions than those
/// within `spread + fade` of the axis.
#[derive(Clone, Copy, Debug)]
pub struct LightBounds {
    /// Lowest corner \[m\].
    pub min: Vec3,
    /// Highest corner \[m\].
    pub max: Vec3,
    /// Mean direction of emission, unit.
    pub axis: DVec3,
    /// θₒ: greatest angle between the axis and the axis of a light in it \[rad\].
    pub spread: f64,
    /// θₑ: greatest angle between a light's own axis and a direction that it emits to \[rad\].
    pub fade: f64,
    /// Luminance of the greatest intensity that a light sends along its axis, summed over the lights \[W/sr\].
    pub intensity: f64,
    /// Emits about the axis and about its opposite.
    pub both: bool,
}

impl LightBounds {
    /// All around from a point or a round body in the box.
    pub fn round(min: impl Into<Vec3>, max: impl Into<Vec3>, intensity: f64) -> Self {
        let (min, max) = (min.into(), max.into());
        Self { min, max, axis: DVec3::Z, spread: PI, fade: FRAC_PI_2, intensity, both: false }
    }

    /// A plane surface in the box: cosine about its normal, and about the opposite where it emits to both sides.
    pub fn flat(min: impl Into<Vec3>, max: impl Into<Vec3>, normal: Vec3A, intensity: f64, both: bool) -> Self {
        let (min, max) = (min.into(), max.into());
        Self { min, max, axis: normal.as_dvec3(), spread: 0.0, fade: FRAC_PI_2, intensity, both }
    }

    /// Middle of the box.
    pub fn center(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// Both: the box around the boxes, the least cone around the cones (Conty Estevez & Kulla 2018, algorithm 1).
    pub fn union(&self, other: &Self) -> Self {
        // The axis of what emits to both sides may as well point the other way.
        let turned = self.both && other.both && self.axis.dot(other.axis) < 0.0;
        let other_axis = if turned { -other.axis } else { other.axis };
        let (axis, spread) = cone_union((self.axis, self.spread), (other_axis, other.spread));
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
            axis,
            spread,
            fade: self.fade.max(other.fade),
            intensity: self.intensity + other.intensity,
            both: self.both || other.both,
        }
    }

    /// What a node of these bounds may cost: intensity × surface × solid angle (ibid., equation 1),
    /// M_Ω = 2π(1 − cos θₒ) + (π/2)(2θ_w sin θₒ − cos(θₒ − 2θ_w) − 2θₒ sin θₒ + cos θₒ) with θ_w = min(θₒ + θₑ, π).
    pub fn cost(&self) -> f64 {
        let (o, w) = (self.spread, (self.spread + self.fade).min(PI));
        let (sin, cos) = o.sin_cos();
        let around = 2.0 * PI * (1.0 - cos) + FRAC_PI_2 * (2.0 * w * sin - (o - 2.0 * w).cos() - 2.0 * o * sin + cos);
        let [x, y, z] = (self.max.as_dvec3() - self.min.as_dvec3()).to_array();
        self.intensity * (x * y + y * z + z * x) * around * if self.both { 2.0 } else { 1.0 }
    }
}

/// The least cone around two cones (axis, half-angle).
fn cone_union(a: (DVec3, f64), b: (DVec3, f64)) -> (DVec3, f64) {
    let (a, b) = if a.1 >= b.1 { (a, b) } else { (b, a) };
    let between = a.0.cross(b.0).length().atan2(a.0.dot(b.0));
    if (between + b.1).min(PI) <= a.1 {
        return a;
    }
    let spread = 0.5 * (a.1 + between + b.1);
    let normal = a.0.cross(b.0).try_normalize();
    match normal {
        Some(normal) if spread < PI => ((DQuat::from_axis_angle(normal, spread - a.1) * a.0).normalize(), spread),
        // Opposite axes, or all directions anyway.
        _ => (a.0, PI),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn direction() -> impl Strategy<Value = DVec3> {
        (-1.0..1.0, -1.0..1.0, -1.0..1.0)
            .prop_filter_map("a direction", |(x, y, z)| DVec3::new(x, y, z).try_normalize())
    }

    proptest! {
        /// Every direction of either cone is in the union, and no direction needs a wider one than half of both and
        /// what is between.
        #[test]
        fn unions_hold_both_cones(a in direction(), b in direction(), ta in 0.0..PI, tb in 0.0..PI, w in direction(), s in 0.0..1.0f64) {
            let (axis, spread) = cone_union((a, ta), (b, tb));
            for (own, half) in [(a, ta), (b, tb)] {
                let turn = own.cross(w).try_normalize().unwrap_or(own.any_orthonormal_vector());
                let edge = DQuat::from_axis_angle(turn, half * s) * own;
                prop_assert!(axis.angle_between(edge) <= spread + 1e-7, "{axis} {spread} {edge}");
            }
            prop_assert!(spread <= PI);
        }
    }
}
