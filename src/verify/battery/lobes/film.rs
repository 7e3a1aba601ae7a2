//! T5: thin films.

use super::fresnel::TOPIC;
use crate::bsdf::ThinFilm;
use crate::bsdf::fresnel::dielectric;
use crate::spectrum::observer;
use crate::verify::Task;
use glam::Vec4;
use std::f64::consts::TAU;

/// Index and thickness \[nm\] of films.
const FILMS: [(f32, f32); 4] = [(1.33, 120.0), (1.33, 400.0), (1.8, 250.0), (2.4, 900.0)];
/// Reflectances at normal incidence of what they lie on.
const BASES: [f32; 4] = [0.0, 0.04, 0.3, 0.9];
/// Of angles outside.
const COSINES: [f32; 4] = [1.0, 0.8, 0.4, 0.15];

pub(super) fn tasks() -> Vec<Task> {
    vec![
        Task::new(TOPIC, "thin films, one wavelength", |_, found| {
            let (mut worst, mut kept) = (0f64, 0f64);
            for (film, f0, cos) in cases() {
                for wavelength in [410.0f32, 550.0, 680.0] {
                    let [r, t] = amplitudes(film, f0.into(), cos.into(), wavelength.into());
                    kept = kept.max((r + t - 1.0).abs());
                    worst = worst.max((f64::from(film.monochromatic(cos, f0, wavelength)) - r).abs());
                }
            }
            found.checks.bound("R + T = 1 of the amplitudes", kept, 1e-12);
            found.checks.bound("R is that of the amplitudes", worst, 2e-5);
            for (eta, f0) in [(1.38f32, 0.0426f32), (2.3, 0.04), (1.22, 0.04)] {
                let quarter = ThinFilm { eta, thickness: 550.0 / (4.0 * eta) }.monochromatic(1.0, f0, 550.0);
                let n = index(f0.into());
                let n1 = f64::from(eta).powi(2);
                let off = (f64::from(quarter) - ((n - n1) / (n + n1)).powi(2)).abs();
                found.checks.bound(format!("n {eta}: λ/4, R = ((n₀n_s − n₁²)/(n₀n_s + n₁²))²"), off, 1e-5);
            }
        }),
        Task::new(TOPIC, "thin films, lanes", |_, found| {
            let mut worst = 0f64;
            for (film, f0, cos) in cases() {
                let mut exact = [0.0; 3];
                for (wavelength, weights) in observer::LANES.iter() {
                    let [r, _] = amplitudes(film, f0.into(), cos.into(), *wavelength);
                    exact = std::array::from_fn(|k| exact[k] + weights[k] * r);
                }
                let lanes = film.reflectance(cos, Vec4::splat(f0.sqrt())).to_rgb();
                worst = (0..3).map(|k| (f64::from(lanes[k]) - exact[k].clamp(0.0, 1.0)).abs()).fold(worst, f64::max);
            }
            found.checks.bound("R of a lane is the mean over its wavelengths", worst, 3e-4);
            let mut bare = 0f64;
            for f0 in [0.04f32, 0.3] {
                let n = index(f0.into()) as f32;
                for film in [ThinFilm { eta: 1.7, thickness: 0.0 }, ThinFilm { eta: n, thickness: 300.0 }] {
                    for cos in COSINES {
                        let r = film.reflectance(cos, Vec4::splat(f0.sqrt())).0;
                        bare = bare.max((r - Vec4::splat(dielectric(cos, n).0)).abs().max_element().into());
                    }
                }
            }
            found.checks.bound("without thickness or contrast, R is that of the interface", bare, 2e-5);
        }),
    ]
}

fn cases() -> impl Iterator<Item = (ThinFilm, f32, f32)> {
    let films = FILMS.into_iter().map(|(eta, thickness)| ThinFilm { eta, thickness });
    films.flat_map(|film| BASES.into_iter().flat_map(move |f0| COSINES.into_iter().map(move |cos| (film, f0, cos))))
}

/// Index that reflects `f0` at normal incidence.
fn index(f0: f64) -> f64 {
    (1.0 + f0.sqrt()) / (1.0 - f0.sqrt())
}

/// Unpolarised R and T by the amplitudes of both faces, in complex numbers, with tilted admittances n cos θ and n/cos θ
/// (Born & Wolf, section 1.6.4).
fn amplitudes(film: ThinFilm, f0: f64, cos: f64, wavelength: f64) -> [f64; 2] {
    let (n1, n2) = (f64::from(film.eta), index(f0));
    let within = |n: f64| (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
    let (c1, c2) = (within(n1), within(n2));
    let (sin, cosine) = (TAU * 2.0 * n1 * f64::from(film.thickness) * c1 / wavelength).sin_cos();
    let mut sum = [0.0; 2];
    for [y0, y1, y2] in [[cos, n1 * c1, n2 * c2], [1.0 / cos, n1 / c1, n2 / c2]] {
        let (r1, r2) = ((y0 - y1) / (y0 + y1), (y1 - y2) / (y1 + y2));
        let (t1, t2) = (2.0 * y0 / (y0 + y1), 2.0 * y1 / (y1 + y2));
        let below = (1.0 + r1 * r2 * cosine).powi(2) + (r1 * r2 * sin).powi(2);
        let above = (r1 + r2 * cosine).powi(2) + (r2 * sin).powi(2);
        sum[0] += 0.5 * above / below;
        sum[1] += 0.5 * (t1 * t2).powi(2) / below * y2 / y0;
    }
    sum
}
