//! L2: polygonal lights.
//!
//! E = (L/2) Σᵢ Θᵢ (Γᵢ·n), Θᵢ the angle of edge i seen from the receiver and Γᵢ the unit normal of its plane, over the
//! polygon clipped at the receiver's horizon (Lambert 1760; Arvo 1995).

use super::irradiance::Lit;
use super::{random_direction, rng, triangle_light};
use crate::desc::{self, ColorParam, Emission, Sides};
use crate::light::{Emitter, Light, TriangleLight};
use crate::shape::TriangleAttributes;
use crate::texture::Textures;
use crate::verify::{Findings, Task, Topic, Trial};
use glam::{Affine2, DVec3, Vec2, Vec3, Vec4};
use rand::RngExt;

pub(super) const L2: Topic = Topic {
    id: "L2",
    title: "polygonal Lambertian light, clipped at the horizon: E = (L/2) Σᵢ Θᵢ (Γᵢ·n)",
    source: "Lambert 1760; Arvo 1995",
};

pub(super) fn tasks() -> Vec<Task> {
    let mut tasks: Vec<Task> =
        (0..4).map(|part| Task::new(L2, format!("triangles at random poses, part {part}"), poses)).collect();
    tasks.push(Task::new(L2, "triangles at every scale", scales));
    tasks.push(Task::new(L2, "textured and vertex-coloured triangle", textured));
    tasks
}

/// Irradiance at the origin with normal `n` of a polygon of radiance 1, either side, clipped at the horizon.
pub(super) fn polygon(vertices: &[DVec3], n: DVec3) -> f64 {
    let mut clipped = Vec::new();
    for (i, &a) in vertices.iter().enumerate() {
        let b = vertices[(i + 1) % vertices.len()];
        let (ha, hb) = (a.dot(n), b.dot(n));
        if ha >= 0.0 {
            clipped.push(a);
        }
        if (ha > 0.0 && hb < 0.0) || (ha < 0.0 && hb > 0.0) {
            clipped.push(a.lerp(b, ha / (ha - hb)));
        }
    }
    let edge = |i: usize| {
        let (a, b) = (clipped[i], clipped[(i + 1) % clipped.len()]);
        a.angle_between(b) * a.cross(b).normalize_or_zero().dot(n)
    };
    0.5 * (0..clipped.len()).map(edge).sum::<f64>().abs()
}

/// Triangles at random poses, among them ones that dip below the horizon.
fn poses(trial: &Trial, found: &mut Findings) {
    let mut rng = rng(trial.seed);
    let mut pose = 0;
    while pose < trial.pick(2, 10) {
        let centre = random_direction(&mut rng) * (0.3 + 1.2 * rng.random::<f32>());
        let corners = [(); 3].map(|()| centre + random_direction(&mut rng));
        // Every other pose dips below the horizon.
        let dips = corners.iter().any(|p| p.z < 0.0);
        let exact = polygon(&corners.map(|p| p.as_dvec3()), DVec3::Z);
        if exact < 0.05 || dips != (pose % 2 == 1) {
            continue;
        }
        // The exact value is of both sides; only one is seen.
        let Some(light) = triangle_light(corners, Sides::Both) else { continue };
        let lit = Lit { light: &light, p: Vec3::ZERO, n: Vec3::Z, textures: &Textures::default() };
        let trial = Trial { seed: rng.random(), ..*trial };
        lit.check(&trial, found, &format!("pose {pose}{}", if dips { ", clipped" } else { "" }), exact);
        pose += 1;
    }
}

/// Where the formula meets f32: very large, very small, far and almost touching.
fn scales(trial: &Trial, found: &mut Findings) {
    let shape = [Vec3::new(-1.0, -0.8, 0.0), Vec3::new(1.2, -0.7, 0.0), Vec3::new(0.1, 0.9, 0.0)];
    for (k, (name, size, p)) in [
        ("1 mm", 1e-3, Vec3::new(0.2, 0.1, 0.5)),
        ("1000 km", 1e6, Vec3::new(0.2, 0.1, 0.5)),
        ("almost touching", 1.0, Vec3::new(0.1, -0.1, 0.003)),
        ("touching at 10 km", 1e4, Vec3::new(0.1, -0.1, 1e-4)),
        ("afar", 1.0, Vec3::new(3.0, -4.0, 200.0)),
        ("grazing", 1.0, Vec3::new(2.5, 0.3, 0.01)),
    ]
    .into_iter()
    .enumerate()
    {
        let (corners, p) = (shape.map(|x| x * size), p * size);
        let n = Vec3::new(-0.48, 0.0, -0.877_268_5).normalize();
        let exact = polygon(&corners.map(|x| x.as_dvec3() - p.as_dvec3()), n.as_dvec3());
        let Some(light) = triangle_light(corners, Sides::Front) else {
            found.checks.holds(format!("{name} is a triangle"), false);
            continue;
        };
        let lit = Lit { light: &light, p, n, textures: &Textures::default() };
        let trial = Trial { seed: trial.seed.wrapping_add(10 * k as u64), ..*trial };
        found.checks.replicated(name, exact, &lit.by_light(&trial, exact), 1e-5);
    }
}

/// Emission that varies over the triangle has no closed form here: the light's samples agree with directions that meet
/// it.
fn textured(trial: &Trial, found: &mut Findings) {
    let texture = desc::TextureRef { texture: 0, uv_set: 1, transform: Affine2::IDENTITY };
    let textures = Textures::new(&desc::Scene {
        textures: vec![desc::Texture::Checker { even: [1.0, 0.2, 0.0], odd: [0.0, 0.6, 2.0], scale: [3.0, 2.0] }],
        ..desc::Scene::default()
    });
    let radiance = ColorParam { factor: [2.0, 1.0, 0.5], texture: Some(texture), vertex_color: true };
    let attributes = TriangleAttributes {
        uv: [None, Some([Vec2::ZERO, Vec2::X, Vec2::Y])],
        colors: Some([Vec4::ONE, Vec4::splat(0.5), Vec4::new(0.0, 1.0, 0.0, 1.0)]),
        ..TriangleAttributes::default()
    };
    for (k, (name, height)) in [("near", 0.4), ("far", 5.0)].into_iter().enumerate() {
        let p = [Vec3::new(1.0, -0.5, height), Vec3::new(-1.0, -1.0, height), Vec3::new(0.2, 1.5, height)];
        let emitter = Emitter::new(&Emission { radiance, sides: Sides::Front, coat: None });
        let Some(light) = TriangleLight::new(p, &attributes, false, emitter) else {
            found.checks.holds(format!("{name} is a triangle"), false);
            continue;
        };
        let light = Light::Triangle(light);
        let trial = Trial { seed: trial.seed.wrapping_add(10 * k as u64), ..*trial };
        Lit { light: &light, p: Vec3::ZERO, n: Vec3::Z, textures: &textures }.agree(&trial, found, name);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of side 1 at height 1 over its corner: E/L = ½ · 2 · (1/√2) atan(1/√2), Lambert's formula done by hand.
    #[test]
    fn a_square_over_its_corner() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 1.0));
        let half = 0.5f64.sqrt();
        assert!((polygon(&square, DVec3::Z) - half * half.atan()).abs() < 1e-14);
    }

    /// Both halves of a triangle that the horizon cuts give what the whole does.
    #[test]
    fn what_is_below_the_horizon_does_not_count() {
        let [a, b, c] = [DVec3::new(1.0, 0.0, 1.0), DVec3::new(1.0, 1.0, -1.0), DVec3::new(1.0, -1.0, -1.0)];
        let [ab, ac] = [a.lerp(b, 0.5), a.lerp(c, 0.5)];
        assert!((polygon(&[a, b, c], DVec3::Z) - polygon(&[a, ab, ac], DVec3::Z)).abs() < 1e-14);
        assert_eq!(polygon(&[ab, b, c, ac].map(|p| p - DVec3::Z), DVec3::Z), 0.0);
    }
}
