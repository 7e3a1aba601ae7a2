//! L3 and L4: disks and spheres, and the quadrics that have no closed form.
//!
//! Disk of radius R parallel to the receiver, on its axis at h: E = π L R²/(R² + h²). Sphere of radius R at distance d, wholly
//! above the horizon: E = π L (R/d)² cosθ; from inside, and inside anything closed, E = π L.

use super::irradiance::{Lit, ROUNDING};
use super::quadric_light;
use crate::desc::Sides;
use crate::shape::Quadric;
use crate::texture::Textures;
use crate::verify::{Findings, Task, Topic, Trial};
use glam::{Mat4, Quat, Vec3};
use std::f64::consts::PI;

pub(super) const L3: Topic =
    Topic { id: "L3", title: "disk light on the axis: E = π L R²/(R² + h²)", source: "Howell catalogue B-12" };

pub(super) const L4: Topic = Topic {
    id: "L4",
    title: "sphere light above the horizon: E = π L (R/d)² cosθ; π L from inside",
    source: "Howell catalogue B-38",
};

pub(super) fn tasks() -> Vec<Task> {
    let mut tasks = Vec::new();
    for (radius, h) in [(0.5f32, 1.0f32), (2.0, 0.7), (30.0, 10.0)] {
        let n = Vec3::new(0.36, -0.48, 0.8);
        let to_world = Mat4::from_rotation_translation(Quat::from_rotation_arc(Vec3::Z, -n), n * h);
        let (r2, h2) = (f64::from(radius).powi(2), f64::from(h).powi(2));
        let shape = (Quadric::Disk { radius }, to_world, Sides::Front);
        let name = format!("disk R {radius}, h {h} by light sampling and hemisphere");
        tasks.push(closed(L3, name, shape, (Vec3::ZERO, n), PI * r2 / (r2 + h2)));
    }
    for (name, radius, centre) in [
        ("R 0.7, d 2", 0.7f32, Vec3::new(0.0, 0.0, 2.0)),
        ("oblique", 1.0, Vec3::new(0.8, -0.9, 1.3)),
        ("almost touching", 1.0, Vec3::new(0.0, 0.0, 1.001)),
        ("on the horizon", 1.0, Vec3::new(3.0, 0.0, 1.01)),
    ] {
        let d = centre.as_dvec3();
        let exact = PI * f64::from(radius).powi(2) / d.length_squared() * (d.z / d.length());
        let name = format!("sphere {name} by light sampling and hemisphere");
        tasks.push(closed(L4, name, sphere(radius, centre), (Vec3::ZERO, Vec3::Z), exact));
    }
    let inside = (Vec3::new(0.3, -0.4, 0.2), Vec3::new(0.6, 0.0, 0.8));
    let ellipsoid = (Quadric::Sphere { radius: 1.0 }, Mat4::from_scale(Vec3::new(1.0, 2.0, 0.7)), Sides::Both);
    tasks.push(closed(L4, "sphere from inside", sphere(1.0, Vec3::ZERO), inside, PI));
    tasks.push(closed(L4, "ellipsoid from inside", ellipsoid, inside, PI));
    tasks.push(Task::new(L4, "sphere of tiny solid angle by light sampling", tiny_spheres));
    tasks
}

type Shape = (Quadric, Mat4, Sides);

fn sphere(radius: f32, centre: Vec3) -> Shape {
    let to_world = Mat4::from_rotation_translation(Quat::from_rotation_y(1.0), centre);
    (Quadric::Sphere { radius }, to_world, Sides::Both)
}

/// Both estimators against the closed form.
fn closed(topic: Topic, name: impl Into<String>, shape: Shape, (p, n): (Vec3, Vec3), exact: f64) -> Task {
    Task::new(topic, name, move |trial, found| {
        let Some(light) = quadric_light(shape.0, shape.1, shape.2) else {
            return found.checks.holds("the map is invertible", false);
        };
        Lit { light: &light, p, n, textures: &Textures::default() }.check(trial, found, "E", exact);
    })
}

/// Directions across spheres so small differ by less than the rounding of f32.
fn tiny_spheres(trial: &Trial, found: &mut Findings) {
    let n = Vec3::new(0.6, 0.0, 0.8);
    for (k, (name, radius, distance)) in
        [("sun", 7e8f32, 1.5e11f32), ("1 nm at 1 m", 1e-9, 1.0), ("1 mm at 1000 km", 1e-3, 1e6)].into_iter().enumerate()
    {
        let shape = sphere(radius, Vec3::Z * distance);
        let Some(light) = quadric_light(shape.0, shape.1, shape.2) else {
            found.checks.holds(format!("{name}: the map is invertible"), false);
            continue;
        };
        let exact = PI * (f64::from(radius) / f64::from(distance)).powi(2) * 0.8;
        let trial = Trial { seed: trial.seed.wrapping_add(10 * k as u64), ..*trial };
        let lit = Lit { light: &light, p: Vec3::ZERO, n, textures: &Textures::default() };
        found.checks.replicated(name, exact, &lit.by_light(&trial, exact), ROUNDING);
    }
}
