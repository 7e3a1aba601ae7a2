//! Directions for the multiply scattered lobe.
//!
//! loss(i) cos θi falls off as 1/μ² beyond μ = α: where α is small, a cosine density would find the horizon, from which most
//! of the energy comes, too seldom. This one is
//!
//! ```text
//! p(i) = μ / (μ² + α²) / (π ln(1 + 1/α²)),    μ² = α² ((1 + 1/α²)^u − 1)
//! ```
//!
//! and loss/p stays bounded for every α.

use super::at::EnergyAt;
use crate::math::sqr;
use crate::warp::uniform_disk;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// ln(1 + 1/α²).
#[inline]
pub(super) fn log(alpha: f32) -> f32 {
    (1.0 / sqr(alpha)).ln_1p()
}

#[inline]
pub(super) fn sample(alpha: f32, log: f32, u: [f32; 2]) -> Vec3 {
    let d = uniform_disk(u);
    let r2 = d.length_squared();
    // A disk's r² is uniform; the pole takes its middle, where u = 1.
    let mu2 = (sqr(alpha) * ((1.0 - r2) * log).exp_m1()).clamp(0.0, 1.0);
    let azimuth = d / r2.sqrt().max(1e-20);
    (azimuth * (1.0 - mu2).sqrt()).extend(mu2.sqrt())
}

#[inline]
pub(super) fn pdf(alpha: f32, log: f32, mu: f32) -> f32 {
    mu * FRAC_1_PI / ((mu * mu + sqr(alpha)) * log)
}

impl EnergyAt {
    /// Draws a direction of the multiply scattered part above the horizon.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> Vec3 {
        sample(self.ggx.ax.max(self.ggx.ay), self.log, u)
    }

    /// Its density \[1/sr\] at the cosine `mu` ≥ 0.
    #[inline]
    pub fn pdf(&self, mu: f32) -> f32 {
        pdf(self.ggx.ax.max(self.ggx.ay), self.log, mu)
    }
}
