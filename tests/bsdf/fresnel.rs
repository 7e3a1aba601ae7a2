//! T5: Fresnel, Snell, critical and Brewster angle, metals.

use radianza::bsdf::fresnel::{conductor, dielectric, refract};
use radianza::glam::{Vec3, Vec4};

/// Unpolarised reflectance with a complex index, in complex arithmetic (Born & Wolf, section 1.5.2).
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

#[test]
fn dielectrics_follow_fresnel() {
    for eta in [1.5, 1.0 / 1.5, 1.33, 2.4, 1.0 / 2.4, 1.0003] {
        for i in 1..=1000 {
            let cos = i as f32 / 1000.0;
            let (f, cos_t) = dielectric(cos, eta);
            let reference = exact(f64::from(cos), [f64::from(eta), 0.0]);
            assert!((f64::from(f) - reference).abs() < 2e-6, "η {eta} cos {cos}: {f} {reference}");
            if f < 1.0 {
                // Snell, and the same reflectance from the other side.
                let (sin_i, sin_t) = ((1.0 - cos * cos).sqrt(), (1.0 - cos_t * cos_t).max(0.0).sqrt());
                assert!(
                    (sin_i - eta * sin_t).abs() < 1e-5 * eta.max(1.0) + 1e-4 * (1.0 - cos_t).min(1e-2),
                    "η {eta} cos {cos}"
                );
                let near_edge = cos < 0.05 || cos_t < 0.05;
                assert!(near_edge || (dielectric(cos_t, 1.0 / eta).0 - f).abs() < 1e-4, "η {eta} cos {cos}");
            }
        }
    }
    assert!((dielectric(1.0, 1.5).0 - 0.04).abs() < 1e-7);
    assert_eq!(dielectric(0.0, 1.5).0, 1.0);
}

#[test]
fn critical_angle_is_sharp() {
    for n in [1.33f32, 1.5, 2.4] {
        let critical = (1.0 - 1.0 / (f64::from(n) * f64::from(n))).sqrt() as f32;
        assert_eq!(dielectric(critical * 0.9999, 1.0 / n), (1.0, 0.0));
        let (f, cos_t) = dielectric(critical * 1.0001, 1.0 / n);
        assert!(f < 1.0 && cos_t > 0.0, "{f}");
    }
}

#[test]
fn brewster_reflects_one_polarisation() {
    for n in [1.33f64, 1.5, 2.4] {
        // tan θ_B = n, where R_p = 0 and R_s = ((n² − 1)/(n² + 1))².
        let cos = 1.0 / (1.0 + n * n).sqrt();
        let expected = 0.5 * ((n * n - 1.0) / (n * n + 1.0)).powi(2);
        let (f, cos_t) = dielectric(cos as f32, n as f32);
        assert!((f64::from(f) - expected).abs() < 1e-6, "{f} {expected}");
        // Reflected and refracted rays are at right angles.
        assert!((f64::from(cos_t) - (1.0 - cos * cos).sqrt()).abs() < 1e-6);
    }
}

#[test]
fn refracted_rays_obey_snell() {
    let m = Vec3::new(0.2, -0.3, 0.9).normalize();
    for eta in [1.5, 1.0 / 1.5] {
        for wo in [Vec3::new(0.1, 0.2, 0.97), Vec3::new(0.4, 0.1, 0.9), m] {
            let wo = wo.normalize();
            let cos = wo.dot(m);
            let (f, cos_t) = dielectric(cos, eta);
            assert!(f < 1.0);
            let wi = refract(wo, m, cos, cos_t, eta);
            // n_o × (wo × m) = −n_i × (wi × m), and on the other side.
            assert!((wo.cross(m) + wi.cross(m) * eta).length() < 1e-6);
            assert!((wi.dot(m) + cos_t).abs() < 1e-6 && (wi.length() - 1.0).abs() < 1e-6);
        }
    }
}

#[test]
fn metals_follow_complex_fresnel() {
    for (eta, k) in [(0.18, 3.42), (1.33, 1.87), (2.9, 3.0), (0.05, 4.0), (1.5, 0.0), (1.0, 1e-3)] {
        for i in 0..=1000 {
            let cos = i as f32 / 1000.0;
            let f = conductor(cos, Vec4::splat(eta), Vec4::splat(k)).0.x;
            let reference = exact(f64::from(cos), [f64::from(eta), f64::from(k)]);
            assert!((f64::from(f) - reference).abs() < 5e-6, "η {eta} k {k} cos {cos}: {f} {reference}");
        }
        let normal = ((eta - 1.0f32).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k);
        assert!((conductor(1.0, Vec4::splat(eta), Vec4::splat(k)).0.x - normal).abs() < 1e-6);
    }
}
