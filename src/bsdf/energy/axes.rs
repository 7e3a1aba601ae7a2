//! Where directions and roughnesses stand among the nodes of the tables.

use super::interface::Interface;
use crate::bsdf::ggx::Ggx;
use crate::math::sqr;
use glam::Vec3;
use std::f32::consts::FRAC_2_PI;

/// ln of half of [`crate::bsdf::ggx::MIN_ALPHA`]: the least α in the tables.
const LOG_MIN: f32 = -9.903_487;

/// Where μ stands in the grid at a roughness: steps in proportion to μ where μ > α, ever finer ones towards the horizon,
/// and likewise about the critical angle, where features are as wide as α.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    inverse_alpha: f32,
    /// 1/asinh(1/α).
    scale: f32,
    /// Cosine of the critical angle, 0 without.
    critical: f32,
    /// From the horizon to the critical angle, and one over the way from there to the normal.
    below: f32,
    critical_scale: f32,
}

impl Axis {
    #[inline]
    pub(super) fn new(interface: Interface, alpha: f32) -> Self {
        match interface.critical() {
            0.0 => Self {
                inverse_alpha: 1.0 / alpha,
                scale: 1.0 / asinh(1.0 / alpha),
                critical: 0.0,
                below: 0.0,
                critical_scale: 0.0,
            },
            critical => Self::critical(critical, alpha),
        }
    }

    /// Crowded about the critical angle too, whose cosine may be 0.
    #[inline]
    pub(super) fn critical(critical: f32, alpha: f32) -> Self {
        let inverse_alpha = 1.0 / alpha;
        let below = asinh(critical * inverse_alpha);
        let critical_scale = 1.0 / (asinh((1.0 - critical) * inverse_alpha) + below);
        Self { inverse_alpha, scale: 1.0 / asinh(inverse_alpha), critical, below, critical_scale }
    }

    /// In \[0, 1\].
    #[inline]
    pub(super) fn at(&self, mu: f32) -> f32 {
        let x = self.without_critical(mu);
        if self.critical_scale == 0.0 {
            return x;
        }
        0.5 * (x + (asinh((mu - self.critical) * self.inverse_alpha) + self.below) * self.critical_scale)
    }

    /// In \[0, 1\], as if there were no critical angle.
    #[inline]
    pub(super) fn without_critical(&self, mu: f32) -> f32 {
        (asinh(mu * self.inverse_alpha) * self.scale).sqrt()
    }
}

/// [`Axis::at`] where no more is asked of the axis.
#[inline]
pub(super) fn abscissa(interface: Interface, mu: f32, alpha: f32) -> f32 {
    Axis::new(interface, alpha).at(mu)
}

/// Inverse hyperbolic sine; fast, and odd to the last bit.
#[inline]
pub(super) fn asinh(t: f32) -> f32 {
    let a = t.abs();
    (a + (a * a + 1.0).sqrt()).ln().copysign(t)
}

/// Where a growing function takes the value `x` in \[0, 1\].
pub(super) fn invert(x: f32, of: impl Fn(f32) -> f32) -> f32 {
    let (mut low, mut high) = (0.0f32, 1.0f32);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if of(middle) < x { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// ln α, scaled to \[0, 1\].
#[inline]
pub(super) fn log_alpha(alpha: f32) -> f32 {
    1.0 - alpha.ln() / LOG_MIN
}

pub(super) fn alpha_of(t: f32) -> f32 {
    ((1.0 - t) * LOG_MIN).exp()
}

/// The roughness that a direction's azimuth meets, and the place of the azimuth among the nodes in \[0, 1\]: the mean of
/// itself and of its stretched image, for energies change with both.
#[inline]
pub(super) fn azimuth(ggx: Ggx, w: Vec3) -> (f32, f32) {
    let (x, y, r) = (ggx.ax * w.x.abs(), ggx.ay * w.y.abs(), w.x.hypot(w.y));
    if r < 1e-12 {
        return (ggx.ax, 0.0);
    }
    let place = y.atan2(x) + w.y.abs().atan2(w.x.abs());
    (x.hypot(y) / r, place * (0.5 * FRAC_2_PI))
}

/// Rough shape of the loss.
#[inline]
pub(super) fn shape(mu: f32, alpha: f32) -> f32 {
    sqr(alpha) / (sqr(mu) + sqr(alpha))
}
