//! The family, for tests and verification: every map, over the unit square.

use super::{
    Table1, Table2, UNIFORM_DISK_PDF, UNIFORM_HEMISPHERE_PDF, UNIFORM_SPHERE_PDF, cosine_hemisphere,
    cosine_hemisphere_inverse, cosine_hemisphere_pdf, one_minus_cos_of_sin2, uniform_cone, uniform_cone_inverse,
    uniform_cone_pdf, uniform_disk, uniform_disk_inverse, uniform_hemisphere, uniform_hemisphere_inverse,
    uniform_sphere, uniform_sphere_inverse, uniform_triangle, uniform_triangle_inverse,
};
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::{PI, TAU};

/// A map with a name.
#[derive(Clone, Debug)]
pub struct Specimen {
    /// Name for reports.
    pub name: String,
    /// The map.
    pub warp: Warp,
}

/// Any of the maps. What they map to is itself laid out over the unit square, by a chart that keeps the ratios of
/// areas, so that one test serves all.
#[derive(Clone, Debug)]
pub enum Warp {
    /// [`uniform_disk`].
    Disk,
    /// [`uniform_triangle`].
    Triangle,
    /// [`cosine_hemisphere`].
    CosineHemisphere,
    /// [`uniform_hemisphere`].
    Hemisphere,
    /// [`uniform_sphere`].
    Sphere,
    /// [`uniform_cone`] with this 1 − cos θmax.
    Cone(f32),
    /// [`Table1`]: its place, and what comes of the second number as it is.
    Table1(Table1),
    /// [`Table2`].
    Table2(Table2),
}

/// Every map, the tables and cones with several parameters.
pub fn specimens() -> Vec<Specimen> {
    let mut all: Vec<Specimen> = [
        ("disk", Warp::Disk),
        ("triangle", Warp::Triangle),
        ("cosine hemisphere", Warp::CosineHemisphere),
        ("uniform hemisphere", Warp::Hemisphere),
        ("uniform sphere", Warp::Sphere),
    ]
    .map(|(name, warp)| Specimen { name: name.into(), warp })
    .into();
    for one_minus_cos in [1e-14f32, 1e-8, 1e-4, 0.3, 1.0, 1.7] {
        all.push(Specimen { name: format!("cone of 1 − cos {one_minus_cos:e}"), warp: Warp::Cone(one_minus_cos) });
    }
    // Weights with gaps, over six decades.
    let weight = |i: usize| {
        if i % 7 == 3 { 0.0 } else { (((i * 31) % 101) as f32 + 0.1).powi(1 + 2 * i.is_multiple_of(5) as i32) }
    };
    let weights: Vec<f32> = (0..32 * 16).map(weight).collect();
    let tables = [
        ("table of 32", Table1::new(&weights[..32]).map(Warp::Table1)),
        ("table of 32 × 16", Table2::new(&weights, [32, 16]).map(Warp::Table2)),
        ("table of 1 × 8", Table2::new(&weights[..8], [1, 8]).map(Warp::Table2)),
    ];
    all.extend(tables.into_iter().filter_map(|(name, warp)| Some(Specimen { name: name.into(), warp: warp? })));
    all
}

impl Warp {
    /// Where `u` comes to on the chart. Rounding may carry it out of the unit square by some ulp.
    pub fn place(&self, u: [f32; 2]) -> [f64; 2] {
        match self {
            Self::Disk => polar(uniform_disk(u)),
            Self::Triangle => {
                // b₁ is uniform over what b₀ leaves, whose length is √ of the share of area beyond b₀.
                let [_, b1, b2] = uniform_triangle(u).map(f64::from);
                [(b1 + b2).powi(2), if b1 + b2 > 0.0 { b1 / (b1 + b2) } else { 0.0 }]
            }
            Self::CosineHemisphere => cap(cosine_hemisphere(u), 1.0),
            Self::Hemisphere => cap(uniform_hemisphere(u), 1.0),
            Self::Sphere => cap(uniform_sphere(u), 2.0),
            Self::Cone(k) => cap(uniform_cone(u, *k), *k),
            Self::Table1(table) => [f64::from(table.sample(u[0]).x), f64::from(u[1])],
            Self::Table2(table) => table.sample(u).p.map(f64::from),
        }
    }

    /// Density that the map states at a place of the chart, over the chart's unit square.
    pub fn density(&self, place: [f64; 2]) -> f64 {
        match self {
            Self::Disk => PI * f64::from(UNIFORM_DISK_PDF),
            Self::Triangle => 1.0,
            Self::CosineHemisphere => TAU * f64::from(cosine_hemisphere_pdf(direction(place, 1.0).z as f32)),
            Self::Hemisphere => TAU * f64::from(UNIFORM_HEMISPHERE_PDF),
            Self::Sphere => 2.0 * TAU * f64::from(UNIFORM_SPHERE_PDF),
            Self::Cone(k) => TAU * f64::from(*k) * f64::from(uniform_cone_pdf(*k)),
            Self::Table1(table) => f64::from(table.pdf(place[0] as f32)),
            Self::Table2(table) => f64::from(table.pdf(place.map(|x| x as f32))),
        }
    }

    /// The map and back.
    pub fn round_trip(&self, u: [f32; 2]) -> [f32; 2] {
        match self {
            Self::Disk => uniform_disk_inverse(uniform_disk(u)),
            Self::Triangle => {
                let [b0, b1, _] = uniform_triangle(u);
                uniform_triangle_inverse([b0, b1])
            }
            Self::CosineHemisphere => cosine_hemisphere_inverse(cosine_hemisphere(u)),
            Self::Hemisphere => uniform_hemisphere_inverse(uniform_hemisphere(u)),
            Self::Sphere => uniform_sphere_inverse(uniform_sphere(u)),
            Self::Cone(k) => uniform_cone_inverse(uniform_cone(u, *k), *k),
            Self::Table1(table) => [table.inverse(table.sample(u[0]).x), u[1]],
            Self::Table2(table) => table.inverse(table.sample(u).p),
        }
    }
}

/// r² and the angle of a point of the unit disk.
fn polar(p: Vec2) -> [f64; 2] {
    let p = p.as_dvec2();
    [p.length_squared(), p.y.atan2(p.x).rem_euclid(TAU) / TAU]
}

/// (1 − cos θ)/k and the angle of a direction of the cap 1 − cos θ ≤ k.
fn cap(w: Vec3, one_minus_cos: f32) -> [f64; 2] {
    // 1 − z from the sine: a narrow cone has no digits left in z.
    let sin2 = w.truncate().length_squared();
    let height = if w.z > 0.5 { one_minus_cos_of_sin2(sin2) } else { 1.0 - w.z };
    [f64::from(height) / f64::from(one_minus_cos), polar(w.truncate())[1]]
}

/// Inverse of [`cap`].
fn direction([height, angle]: [f64; 2], one_minus_cos: f64) -> DVec3 {
    let height = height * one_minus_cos;
    let (sin, cos) = (TAU * angle).sin_cos();
    let rho = (height * (2.0 - height)).max(0.0).sqrt();
    DVec3::new(rho * cos, rho * sin, 1.0 - height)
}
