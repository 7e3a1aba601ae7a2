//! Means over the hemisphere of energies that depend on height and azimuth.

use super::interface::Energy;
use super::quadrature::gauss_legendre;
use crate::bsdf::ggx::Ggx;
use glam::{DVec3, Vec3};
use std::f64::consts::FRAC_PI_2;

/// Cosine-weighted mean of energies over the hemisphere.
pub(super) fn over_hemisphere(ggx: Ggx, energy: impl Fn(Vec3) -> Energy) -> [f64; 3] {
    // In the scale of the abscissa, and of the azimuth where roughness is least and where it is greatest.
    let rule = gauss_legendre::<4>();
    const PANELS: usize = 12;
    let (a, b) = (f64::from(ggx.ax), f64::from(ggx.ay));
    let mut sum = [0.0; 3];
    for panel in 0..PANELS {
        for (x, w) in rule {
            // Half of the nodes by the raw azimuth φ, half by the stretched one ψ, balanced by their densities.
            let t = (panel as f64 + x) / PANELS as f64 * FRAC_PI_2;
            for phi in [t, (t.sin() / b).atan2(t.cos() / a)] {
                let (sin, cos) = phi.sin_cos();
                let alpha = (a * cos).hypot(b * sin);
                // dψ/dφ = αx αy/αφ².
                let share = w / PANELS as f64 / (1.0 + a * b / (alpha * alpha));
                let end = (1.0 / alpha).asinh();
                for panel in 0..2 * PANELS {
                    for (x, w) in rule {
                        let t = (panel as f64 + x) / (2 * PANELS) as f64 * end;
                        let mu = (alpha * t.sinh()).min(1.0);
                        let weight = share * 2.0 * mu * alpha * t.cosh() * w * end / (2 * PANELS) as f64;
                        let r = (1.0 - mu * mu).sqrt();
                        let e = energy(DVec3::new(r * cos, r * sin, mu).as_vec3());
                        for (sum, e) in sum.iter_mut().zip([e.loss, e.parts[0], e.parts[1]]) {
                            *sum += weight * f64::from(e);
                        }
                    }
                }
            }
        }
    }
    sum
}
