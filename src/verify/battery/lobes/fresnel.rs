//! T5: Fresnel, Snell, the critical angle, Brewster's angle, metals.

use crate::bsdf::fresnel::{conductor, dielectric, refract};
use crate::verify::{Task, Topic};
use glam::{Vec3, Vec4};

/// F = (|r_s|² + |r_p|²)/2, r_s = (cos θi − √(n² − sin²θi))/(cos θi + √…), r_p = (n² cos θi − √…)/(n² cos θi + √…).
pub(super) const TOPIC: Topic = Topic {
    id: "T5",
    title: "Fresnel's reflectance, Snell's law, critical angle sin θ = 1/n, Brewster's angle tan θ = n, complex indices",
    source: "Born & Wolf, sections 1.5 and 14.2",
};

/// Indices of the far side over the near one.
const ETAS: [f32; 7] = [1.5, 1.0 / 1.5, 1.33, 2.4, 1.0 / 2.4, 1.0003, 1.02];

pub(super) fn tasks() -> Vec<Task> {
    vec![
        Task::new(TOPIC, "dielectrics", |_, found| {
            for eta in ETAS {
                let (mut f_off, mut snell_off, mut back_off) = (0f64, 0f64, 0f64);
                for i in 1..=1000 {
                    let cos = i as f32 / 1000.0;
                    let (f, cos_t) = dielectric(cos, eta);
                    f_off = f_off.max((f64::from(f) - exact(cos.into(), [eta.into(), 0.0])).abs());
                    if f < 1.0 {
                        // η sin θt = sin θi by the squares, which a cosine near 1 keeps; and the way back.
                        let sin2 = |c: f32| 1.0 - f64::from(c) * f64::from(c);
                        snell_off = snell_off.max((sin2(cos) - f64::from(eta * eta) * sin2(cos_t)).abs());
                        if cos_t > 0.05 && cos > 0.05 {
                            back_off = back_off.max(f64::from((dielectric(cos_t, 1.0 / eta).0 - f).abs()));
                        }
                    }
                }
                found.checks.bound(format!("η {eta:.4}: F over the angle"), f_off, 2e-6);
                found.checks.bound(format!("η {eta:.4}: sin θi = η sin θt"), snell_off, 3e-6);
                found.checks.bound(format!("η {eta:.4}: F of the way back"), back_off, 1e-4);
            }
            found.checks.bound(
                "F at normal incidence on 1.5 = 0.04",
                f64::from((dielectric(1.0, 1.5).0 - 0.04).abs()),
                1e-7,
            );
            found.checks.holds("F at grazing incidence = 1", dielectric(0.0, 1.5).0 == 1.0);
        }),
        Task::new(TOPIC, "critical angle", |_, found| {
            for n in [1.33f32, 1.5, 2.4] {
                let critical = (1.0 - 1.0 / (f64::from(n) * f64::from(n))).sqrt() as f32;
                let (beyond, before) = (dielectric(critical * 0.9999, 1.0 / n), dielectric(critical * 1.0001, 1.0 / n));
                found.checks.holds(format!("n {n}: all is reflected beyond it"), beyond == (1.0, 0.0));
                found.checks.holds(format!("n {n}: some is refracted before it"), before.0 < 1.0 && before.1 > 0.0);
            }
        }),
        Task::new(TOPIC, "Brewster's angle", |_, found| {
            for n in [1.33f64, 1.5, 2.4] {
                // R_p = 0 and R_s = ((n² − 1)/(n² + 1))²; reflected and refracted rays are at right angles.
                let cos = 1.0 / (1.0 + n * n).sqrt();
                let half = 0.5 * ((n * n - 1.0) / (n * n + 1.0)).powi(2);
                let (f, cos_t) = dielectric(cos as f32, n as f32);
                found.checks.bound(format!("n {n}: F"), (f64::from(f) - half).abs() / half, 1e-5);
                let right = (f64::from(cos_t) - (1.0 - cos * cos).sqrt()).abs();
                found.checks.bound(format!("n {n}: right angle"), right, 1e-6);
            }
        }),
        Task::new(TOPIC, "refracted rays", |_, found| {
            let m = Vec3::new(0.2, -0.3, 0.9).normalize();
            for eta in [1.5, 1.0 / 1.5] {
                let mut worst = 0f32;
                for wo in [Vec3::new(0.1, 0.2, 0.97), Vec3::new(0.4, 0.1, 0.9), m] {
                    let wo = wo.normalize();
                    let cos = wo.dot(m);
                    let (_, cos_t) = dielectric(cos, eta);
                    let wi = refract(wo, m, cos, cos_t, eta);
                    // wo × m = −η wi × m, on the other side.
                    let snell = (wo.cross(m) + wi.cross(m) * eta).length();
                    worst = worst.max(snell).max((wi.dot(m) + cos_t).abs()).max((wi.length() - 1.0).abs());
                }
                found.checks.bound(format!("η {eta:.3}: Snell's law of vectors"), worst.into(), 1e-6);
            }
        }),
        Task::new(TOPIC, "metals", |_, found| {
            for (eta, k) in [(0.18, 3.42), (1.33, 1.87), (2.9, 3.0), (0.05, 4.0), (1.5, 0.0), (1.0, 1e-3)] {
                let mut worst = 0f64;
                let of = |cos: f32| f64::from(conductor(cos, Vec4::splat(eta), Vec4::splat(k)).0.x);
                for i in 0..=1000 {
                    let cos = i as f32 / 1000.0;
                    worst = worst.max((of(cos) - exact(cos.into(), [eta.into(), k.into()])).abs());
                }
                found.checks.bound(format!("η {eta} k {k}: F over the angle"), worst, 5e-6);
                let normal = ((eta - 1.0f32).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k);
                found.checks.bound(
                    format!("η {eta} k {k}: normal incidence"),
                    (of(1.0) - f64::from(normal)).abs(),
                    1e-6,
                );
            }
        }),
    ]
}

/// Unpolarised reflectance of an index, in complex arithmetic (Born & Wolf, section 1.5.2).
fn exact(cos: f64, n: [f64; 2]) -> f64 {
    type C = [f64; 2];
    let mul = |a: C, b: C| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
    let add = |a: C, b: C| [a[0] + b[0], a[1] + b[1]];
    let sub = |a: C, b: C| [a[0] - b[0], a[1] - b[1]];
    let norm2 = |a: C| a[0] * a[0] + a[1] * a[1];
    let sqrt = |a: C| {
        let r = norm2(a).sqrt();
        [((r + a[0]) / 2.0).max(0.0).sqrt(), ((r - a[0]) / 2.0).max(0.0).sqrt().copysign(a[1])]
    };
    let n2 = mul(n, n);
    let root = sqrt(sub(n2, [1.0 - cos * cos, 0.0]));
    let c = [cos, 0.0];
    let ratio = |a: C, b: C| norm2(a) / norm2(b);
    let s = ratio(sub(c, root), add(c, root));
    let p = ratio(sub(mul(n2, c), root), add(mul(n2, c), root));
    0.5 * (s + p)
}
