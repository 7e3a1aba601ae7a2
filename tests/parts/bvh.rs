//! Traversal: the right hit, the same on every kernel.

use crate::common::closed_mesh;
use glam::{Quat, Vec3, Vec3A};
use proptest::prelude::*;
use radianza::bvh::{Aabb, BoxBvh, Isa, Quality, TriangleBvh, TriangleRef};
use radianza::math::{Ray, offset_origin};
use radianza::sampler::{Kind, Sampler};
use radianza::shape::intersect_triangle;
use radianza::warp;

/// The kernels that this CPU runs, the portable one first.
fn kernels() -> impl Iterator<Item = Isa> {
    Isa::ALL.into_iter().map(|(isa, _)| isa).filter(|isa| isa.is_available())
}

fn soup(seed: u64, n: usize, spread: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut u = Sampler::new(Kind::Independent, seed, [0, 0], 0, 1);
    let mut positions = Vec::new();
    for _ in 0..n {
        let mut p = || Vec3::new(u.next_1d(), u.next_1d(), u.next_1d()) * 2.0 - 1.0;
        let centre = p() * spread;
        for _ in 0..3 {
            positions.push(centre + p());
        }
    }
    let indices = (0..n as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    (positions, indices)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// All kernels agree bit for bit, and with a search through all triangles in f64.
    #[test]
    fn kernels_agree_and_find_the_nearest(seed: u64, n in 1usize..400, spread in 0.5f32..30.0) {
        let (positions, indices) = soup(seed, n, spread);
        let by = |isa| TriangleBvh::build(&positions, &indices, Quality::Default).with_isa(isa).unwrap();
        let trees = Quality::ALL.map(|(quality, _)| TriangleBvh::build(&positions, &indices, quality));
        let (bvh, others) = (by(Isa::Portable), kernels().skip(1).map(by).collect::<Vec<_>>());
        let mut u = Sampler::new(Kind::Independent, seed ^ 1, [0, 0], 0, 1);
        for i in 0..200 {
            let o = (Vec3::new(u.next_1d(), u.next_1d(), u.next_1d()) * 2.0 - 1.0) * spread;
            // Axis-parallel rays too: their reciprocals are infinite.
            let d = if i % 10 == 0 { Vec3::AXES[i / 10 % 3] } else { warp::uniform_sphere(u.next_2d()) };
            let ray = Ray { t_max: if i % 3 == 0 { spread } else { f32::INFINITY }, ..Ray::new(o, d) };
            let hit = bvh.nearest(&ray, TriangleRef::NONE);
            prop_assert_eq!(hit.is_some(), bvh.occluded(&ray, TriangleRef::NONE));
            // At an edge another tree may find the other triangle, at the same place.
            for tree in &trees {
                prop_assert_eq!(hit.map(|h| h.t), tree.nearest(&ray, TriangleRef::NONE).map(|h| h.t));
            }
            for other in &others {
                prop_assert_eq!(hit, other.nearest(&ray, TriangleRef::NONE));
                prop_assert_eq!(hit.is_some(), other.occluded(&ray, TriangleRef::NONE));
            }
            // A ray that is told to leave the triangle meets what is behind it.
            if let Some(hit) = hit {
                let behind = bvh.nearest(&ray, hit.slot);
                prop_assert!(behind.is_none_or(|b| b.t >= hit.t && b.slot != hit.slot && b.triangle != hit.triangle));
                for tree in std::iter::once(&bvh).chain(&others) {
                    prop_assert_eq!(behind, tree.nearest(&ray, hit.slot));
                    prop_assert_eq!(behind.is_some(), tree.occluded(&ray, hit.slot));
                }
            }
            let corner = |i: u32| positions[i as usize];
            let slow = indices.iter().filter_map(|t| Some(intersect_triangle(&ray, t.map(corner))?.t));
            let slow = slow.min_by(f32::total_cmp);
            match (hit, slow) {
                (Some(hit), Some(t)) => prop_assert!((hit.t - t).abs() <= 1e-3 * spread, "{} {}", hit.t, t),
                (None, None) => {}
                // At an edge, or where the limit cuts, f32 and f64 may differ.
                (Some(hit), None) => {
                    let edge = hit.u.min(hit.v).min(1.0 - hit.u - hit.v);
                    prop_assert!(edge < 1e-3 || (hit.t - ray.t_max).abs() < 1e-3 * spread);
                }
                (None, Some(t)) => prop_assert!((t - ray.t_max).abs() < 1e-3 * spread || t < 1e-4, "{}", t),
            }
        }
    }

    /// A hierarchy of boxes asks about every box that a ray meets before the nearest hit.
    #[test]
    fn boxes_on_the_ray_are_asked(seed: u64, n in 1usize..200) {
        let mut u = Sampler::new(Kind::Independent, seed, [0, 0], 0, 1);
        let mut p = || Vec3::new(u.next_1d(), u.next_1d(), u.next_1d());
        let boxes: Vec<Aabb> = (0..n).map(|_| {
            let (c, e) = (p() * 10.0, p());
            Aabb { min: c - e, max: c + e }
        }).collect();
        let bvh = BoxBvh::build(boxes.clone(), Quality::Default);
        for _ in 0..50 {
            let target = boxes[(p().x * n as f32) as usize % n];
            let o = p() * 40.0 - 20.0;
            let at = (target.min + target.max) * 0.5;
            let ray = Ray::new(o, (at - o).normalize());
            let mut asked = vec![0; n];
            bvh.traverse(&ray, ray.t_max, |i, _| { asked[i as usize] += 1; None });
            let i = boxes.iter().position(|b| *b == target).unwrap();
            prop_assert_eq!(asked[i], 1);
            prop_assert!(asked.iter().all(|&n| n <= 1));
        }
    }
}

#[test]
fn degenerate_triangles_are_never_hit_and_harm_nothing() {
    let (mut positions, mut indices) = closed_mesh(8, 1.0, Vec3::ZERO);
    let base = positions.len() as u32;
    positions.extend([Vec3::ZERO, Vec3::X * 0.3, Vec3::X * 0.6]);
    indices.extend([[base, base + 1, base + 2], [base, base, base], [base, base, base + 1]]);
    let bvh = TriangleBvh::build(&positions, &indices, Quality::Default);
    for i in 0..1000 {
        let d = Quat::from_rotation_y(i as f32 * 0.1) * Vec3::new(0.3, (i as f32).sin(), 0.9).normalize();
        let hit = bvh.nearest(&Ray::new(-d * 0.7, d), TriangleRef::NONE).expect("inside a closed mesh");
        assert!(hit.triangle < indices.len() as u32 - 3);
        assert!(hit.t.is_finite() && hit.u.is_finite() && hit.v.is_finite());
    }
    assert!(
        TriangleBvh::build(&[], &[], Quality::Default)
            .nearest(&Ray::new(Vec3::ZERO, Vec3::X), TriangleRef::NONE)
            .is_none()
    );
}

#[test]
fn rays_that_leave_a_plane_through_zero_do_not_meet_it() {
    // Where a plane has coordinate 0, the error of its points along the normal is 0 too, and rays start the least float
    // above it; their first t is then far below the rounding of the triangle's other coordinates.
    let quad = [[-0.1, 0.0, 0.1], [0.1, 0.0, 0.1], [0.1, 0.0, -0.1], [-0.1, 0.0, -0.1]].map(Vec3::from);
    let indices = [[0, 1, 2], [0, 2, 3]];
    for axis in 0..3 {
        for scale in [1e-3, 1.0, 1e4] {
            let turn = |v: Vec3| Vec3::from([0, 1, 2].map(|i| v[(i + axis) % 3]));
            let positions = quad.map(|p| turn(p * scale));
            for isa in kernels() {
                let bvh = TriangleBvh::build(&positions, &indices, Quality::Default).with_isa(isa).unwrap();
                for i in 0..20_000 {
                    let mut u = Sampler::new(Kind::Independent, 3, [axis as u32, 0], i, 1);
                    let [x, z] = u.next_2d().map(|u| (0.2 * u - 0.1) * scale * 0.999);
                    let normal = Vec3A::from(turn(Vec3::Y));
                    let d = warp::cosine_hemisphere(u.next_2d());
                    let d = Vec3A::from(turn(Vec3::new(d.x, d.z, d.y)));
                    let o = offset_origin(turn(Vec3::new(x, 0.0, z)).into(), Vec3A::ZERO, normal, d);
                    let found = (
                        bvh.nearest(&Ray::new(o, d), TriangleRef::NONE),
                        bvh.occluded(&Ray::new(o, d), TriangleRef::NONE),
                    );
                    assert_eq!(found, (None, false), "axis {axis} scale {scale} {isa:?}: {o} {d}");
                    let back = Ray::new(o + normal * (1e-3 * scale), -normal);
                    assert!(
                        bvh.nearest(&back, TriangleRef::NONE).is_some() && bvh.occluded(&back, TriangleRef::NONE),
                        "{o}"
                    );
                }
            }
        }
    }
}
