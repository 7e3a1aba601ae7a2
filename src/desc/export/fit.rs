//! Indices of refraction with a given reflectance, for targets that know Fresnel's formulas and not Schlick's; and what
//! microfacets that scatter once lack.

use crate::bsdf::{self, Coat, DielectricEnergy, EnergyTable, Interface, Micro, RoughReflection};
use crate::spectrum::Spectrum;

/// Index of a dielectric that reflects `f0` at normal incidence: n = (1 + √F₀)/(1 − √F₀).
pub(super) fn index(f0: f32) -> f32 {
    let root = f0.clamp(0.0, 0.99).sqrt();
    (1.0 + root) / (1.0 - root)
}

/// η and κ of a metal that reflects `f0` at normal incidence and, over the hemisphere, as much as Schlick's approximation:
/// F₀ + (1 − F₀)/21. One number runs through the metals of this F₀, from κ = 0 to the least η (Gulbrandsen 2014, "Artist
/// Friendly Metallic Fresnel"), and the mean with it.
pub(super) fn metal(f0: f32) -> [f32; 2] {
    let r = f64::from(f0).clamp(1e-4, 0.9999);
    let (most, least) = ((1.0 + r.sqrt()) / (1.0 - r.sqrt()), (1.0 - r) / (1.0 + r));
    let at = |g: f64| {
        let n = most + (least - most) * g;
        let k2 = (r * (n + 1.0).powi(2) - (n - 1.0).powi(2)) / (1.0 - r);
        [n, k2.max(0.0).sqrt()]
    };
    // The mean grows with κ.
    let wanted = r + (1.0 - r) / 21.0;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if mean(at(middle)) < wanted { low = middle } else { high = middle }
    }
    at(0.5 * (low + high)).map(|x| x as f32)
}

/// All over what is scattered once, of the interface of a dielectric: the mean of both its sides.
pub(super) fn glass_again(alpha: f32, eta: f32) -> f32 {
    let loss = DielectricEnergy::isotropic(alpha, eta).mean_loss();
    1.0 / (1.0 - 0.5 * (loss[0] + loss[1])).max(0.1)
}

/// Reflectance of η − iκ at normal incidence.
pub(super) fn normal_reflectance(eta: f32, k: f32) -> f32 {
    let k2 = k * k;
    ((eta - 1.0).powi(2) + k2) / ((eta + 1.0).powi(2) + k2)
}

/// A GGX surface of Schlick's reflectance, whose albedo counts all scattering.
pub(super) fn rough(alpha: f32, f0: [f32; 3]) -> Coat {
    let micro = Micro::of([alpha; 2], EnergyTable::isotropic(Interface::Mirror));
    RoughReflection::new(micro, bsdf::Fresnel::schlick(Spectrum::from_rgb(f0), 1.0)).coat()
}

/// Mean albedo of all scattering over that of single scattering, per lane.
pub(super) fn scattered_again(alpha: f32, f0: [f32; 3]) -> [f32; 3] {
    let all = rough(alpha, f0);
    let [all, once] = [Spectrum::ONE - all.transmitted_average(), all.once_average()].map(|s| s.0);
    let ratio = all / once.max(glam::Vec4::splat(1e-6));
    [ratio.x, ratio.y, ratio.z].map(|x| x.max(1.0))
}

/// 2 ∫ F μ dμ of a metal.
fn mean([n, k]: [f64; 2]) -> f64 {
    const N: u32 = 256;
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(N);
    (0..N).map(|i| reflectance(at(i).powi(2), n, k) * 4.0 * at(i).powi(3) / f64::from(N)).sum()
}

/// Unpolarised reflectance (Born & Wolf, section 14.2).
fn reflectance(cos: f64, n: f64, k: f64) -> f64 {
    let (c2, s2) = (cos * cos, 1.0 - cos * cos);
    let t0 = n * n - k * k - s2;
    let a2b2 = (t0 * t0 + 4.0 * n * n * k * k).sqrt();
    let a = (0.5 * (a2b2 + t0)).max(0.0).sqrt();
    let (t1, t2) = (a2b2 + c2, 2.0 * cos * a);
    let (t3, t4) = (c2 * a2b2 + s2 * s2, t2 * s2);
    0.5 * (t1 - t2) / (t1 + t2) * (1.0 + (t3 - t4) / (t3 + t4))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metals_reflect_as_schlick_at_normal_incidence_and_in_the_mean() {
        for f0 in [0.3, 0.5, 0.9, 0.98] {
            let [n, k] = metal(f0).map(f64::from);
            let f0 = f64::from(f0);
            assert!((reflectance(1.0, n, k) - f0).abs() < 1e-4, "{f0}: {n} {k}");
            assert!((mean([n, k]) - (f0 + (1.0 - f0) / 21.0)).abs() < 1e-4, "{f0}: {n} {k}");
        }
        assert!((index(0.04) - 1.5).abs() < 1e-6 && (normal_reflectance(1.5, 0.0) - 0.04).abs() < 1e-6);
    }

    #[test]
    fn rough_metals_lose_light_that_white_ones_get_back() {
        assert!(scattered_again(0.01, [0.9; 3])[0] < 1.001);
        let [white, grey, _] = scattered_again(0.7, [1.0, 0.3, 0.0]);
        assert!(white > 1.15 && grey > 1.0 && grey < white, "{white} {grey}");
    }
}
