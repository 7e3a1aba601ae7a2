//! Traversal: the right hit, no leaks, the same on every kernel.

use glam::{Quat, Vec3};
use proptest::prelude::*;
use radianza::bvh::{Aabb, BoxBvh, Isa, TriangleBvh};
use radianza::math::{Ray, offset_origin};
use radianza::sampler::{Kind, Sampler};
use radianza::shape::intersect_triangle;
use radianza::warp;

/// Icosphere-like closed mesh: a cube's faces in an n × n grid, pushed out to a sphere.
fn closed_mesh(n: u32, scale: f32, centre: Vec3) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut positions: Vec<Vec3> = Vec::new();
    let mut index = std::collections::HashMap::new();
    let mut vertex = |p: [i64; 3]| {
        *index.entry(p).or_insert_with(|| {
            let q = Vec3::from_array(p.map(|c| c as f32 / n as f32 * 2.0 - 1.0)).normalize();
            positions.push(centre + q * scale);
            (positions.len() - 1) as u32
        })
    };
    let mut indices = Vec::new();
    let n = i64::from(n);
    for axis in 0..3 {
        for side in [0, n] {
            for i in 0..n {
                for j in 0..n {
                    let corner = |a: i64, b: i64| {
                        let mut p = [0; 3];
                        p[axis] = side;
                        p[(axis + 1) % 3] = i + a;
                        p[(axis + 2) % 3] = j + b;
                        p
                    };
                    let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)].map(&mut vertex);
                    if side == 0 {
                        indices.extend([[a, c, b], [a, d, c]]);
                    } else {
                        indices.extend([[a, b, c], [a, c, d]]);
                    }
                }
            }
        }
    }
    (positions, indices)
}

#[test]
fn rays_at_edges_and_vertices_of_a_closed_mesh_never_slip_through() {
    let mut rays = 0;
    for (scale, centre) in [
        (1.0, Vec3::ZERO),
        (1e-3, Vec3::new(0.1, -0.2, 0.3)),
        (1e6, Vec3::ZERO),
        (1.0, Vec3::new(1000.0, -500.0, 300.0)),
    ] {
        let (positions, indices) = closed_mesh(24, scale, centre);
        let bvh = TriangleBvh::build(&positions, &indices);
        let mut u = Sampler::new(Kind::Independent, 1, [scale.to_bits(), 0], 0, 1);
        for t in indices.iter().cycle().take(40_000) {
            let [a, b] = [t[0], t[1]].map(|i| positions[i as usize]);
            let at = if u.next_1d() < 0.3 { a } else { a + (b - a) * u.next_1d() };
            // From inside, and from outside towards the far side.
            let inside = centre + warp::uniform_sphere(u.next_2d()) * scale * 0.5 * u.next_1d();
            let outside = centre + warp::uniform_sphere(u.next_2d()) * scale * 3.0;
            for o in [inside, outside] {
                let ray = Ray::new(o, (at - o).normalize());
                let hit = bvh.nearest(&ray);
                let grazing = o == outside && (at - centre).normalize().dot(ray.d).abs() < 0.15;
                assert!(hit.is_some() || grazing, "a ray from {o} at {at} slipped through");
                assert!(grazing || bvh.occluded(&ray));
                rays += 1;
            }
        }
    }
    println!("{rays} rays at edges and vertices: 0 misses");
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
        let bvh = TriangleBvh::build(&positions, &indices).with_isa(Isa::Portable).unwrap();
        let fast = TriangleBvh::build(&positions, &indices).with_isa(Isa::detect()).unwrap();
        let mut u = Sampler::new(Kind::Independent, seed ^ 1, [0, 0], 0, 1);
        for i in 0..200 {
            let o = (Vec3::new(u.next_1d(), u.next_1d(), u.next_1d()) * 2.0 - 1.0) * spread;
            // Axis-parallel rays too: their reciprocals are infinite.
            let d = if i % 10 == 0 { Vec3::AXES[i / 10 % 3] } else { warp::uniform_sphere(u.next_2d()) };
            let ray = Ray { o, d, t_max: if i % 3 == 0 { spread } else { f32::INFINITY } };
            let hit = bvh.nearest(&ray);
            prop_assert_eq!(hit, fast.nearest(&ray));
            prop_assert_eq!(hit.is_some(), bvh.occluded(&ray));
            prop_assert_eq!(hit.is_some(), fast.occluded(&ray));
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
        let bvh = BoxBvh::build(&boxes);
        for _ in 0..50 {
            let target = boxes[(p().x * n as f32) as usize % n];
            let o = p() * 40.0 - 20.0;
            let at = (target.min + target.max) * 0.5;
            let ray = Ray { o, d: (at - o).normalize(), t_max: f32::INFINITY };
            let mut asked = vec![0; n];
            bvh.traverse(&ray, |i, _| { asked[i as usize] += 1; None });
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
    let bvh = TriangleBvh::build(&positions, &indices);
    for i in 0..1000 {
        let d = Quat::from_rotation_y(i as f32 * 0.1) * Vec3::new(0.3, (i as f32).sin(), 0.9).normalize();
        let hit = bvh.nearest(&Ray::new(-d * 0.7, d)).expect("inside a closed mesh");
        assert!(hit.triangle < indices.len() as u32 - 3);
        assert!(hit.t.is_finite() && hit.u.is_finite() && hit.v.is_finite());
    }
    assert!(TriangleBvh::build(&[], &[]).nearest(&Ray::new(Vec3::ZERO, Vec3::X)).is_none());
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
            for isa in [Isa::Portable, Isa::detect()] {
                let bvh = TriangleBvh::build(&positions, &indices).with_isa(isa).unwrap();
                for i in 0..20_000 {
                    let mut u = Sampler::new(Kind::Independent, 3, [axis as u32, 0], i, 1);
                    let [x, z] = u.next_2d().map(|u| (0.2 * u - 0.1) * scale * 0.999);
                    let normal = turn(Vec3::Y);
                    let d = warp::cosine_hemisphere(u.next_2d());
                    let d = turn(Vec3::new(d.x, d.z, d.y));
                    let o = offset_origin(turn(Vec3::new(x, 0.0, z)), Vec3::ZERO, normal, d);
                    let found = (bvh.nearest(&Ray::new(o, d)), bvh.occluded(&Ray::new(o, d)));
                    assert_eq!(found, (None, false), "axis {axis} scale {scale} {isa:?}: {o} {d}");
                    let back = Ray::new(o + normal * (1e-3 * scale), -normal);
                    assert!(bvh.nearest(&back).is_some() && bvh.occluded(&back), "{o}");
                }
            }
        }
    }
}
