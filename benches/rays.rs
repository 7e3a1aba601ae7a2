//! Mrays/s of nearest-hit and occlusion queries on a generated terrain of a million triangles.

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;
use radianza::bvh::{Isa, TriangleBvh};
use radianza::math::{Frame, Ray};
use radianza::sampler::{Kind, Sampler};
use radianza::warp;
use std::hint::black_box;

const SIDE: u32 = 708;
const RAYS: usize = 1 << 14;

/// Rolling hills: 2 (SIDE − 1)² triangles over 100 m × 100 m.
fn terrain() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let height = |x: f32, y: f32| {
        let octave = |k: f32| ((x * k).sin() * (y * k * 1.3 + 1.0).cos()) / k;
        4.0 * (octave(0.1) * 0.1 + octave(0.37) + octave(1.1) + octave(3.7))
    };
    let at = |i: u32| i as f32 / (SIDE - 1) as f32 * 100.0 - 50.0;
    let vertex = |k: u32| Vec3::new(at(k % SIDE), height(at(k % SIDE), at(k / SIDE)), at(k / SIDE));
    let quad = |k: u32| [[k, k + SIDE, k + 1], [k + 1, k + SIDE, k + SIDE + 1]];
    let corners = (0..SIDE - 1).flat_map(|y| (0..SIDE - 1).map(move |x| y * SIDE + x));
    ((0..SIDE * SIDE).map(vertex).collect(), corners.flat_map(quad).collect())
}

/// Camera rays over the hills, rays that leave their hits diffusely, and shadow rays to points in the sky.
fn ray_sets(bvh: &TriangleBvh, positions: &[Vec3], indices: &[[u32; 3]]) -> [(&'static str, Vec<Ray>); 3] {
    let mut u = Sampler::new(Kind::Independent, 1, [0, 0], 0, 1);
    let eye = Vec3::new(0.0, 12.0, 55.0);
    let (mut primary, mut bounce, mut shadow) = (Vec::new(), Vec::new(), Vec::new());
    while bounce.len() < RAYS {
        let [a, b] = u.next_2d();
        let ray = Ray::new(eye, Vec3::new(a - 0.5, 0.1 - 0.5 * b, -1.0).normalize());
        primary.push(ray);
        let Some(hit) = bvh.nearest(&ray) else { continue };
        let [p, q, r] = indices[hit.triangle as usize].map(|i| positions[i as usize]);
        let n = (q - p).cross(r - p).normalize();
        let n = if n.y < 0.0 { -n } else { n };
        let o = ray.at(hit.t) + n * 1e-3;
        bounce.push(Ray::new(o, Frame::from_z(n).to_world(warp::cosine_hemisphere(u.next_2d()))));
        let to = Vec3::new(u.next_1d() * 100.0 - 50.0, 30.0, u.next_1d() * 100.0 - 50.0) - o;
        shadow.push(Ray { o, d: to, t_max: 1.0 });
    }
    primary.truncate(RAYS);
    [("primary", primary), ("bounce", bounce), ("shadow", shadow)]
}

fn rays(c: &mut Criterion) {
    let (positions, indices) = terrain();
    for isa in [Isa::detect(), Isa::Portable] {
        let Some(bvh) = TriangleBvh::build(&positions, &indices).with_isa(isa) else { continue };
        let mut group = c.benchmark_group(format!("{} triangles, {isa:?}", indices.len()));
        group.throughput(Throughput::Elements(RAYS as u64));
        for (name, set) in ray_sets(&bvh, &positions, &indices) {
            group.bench_function(BenchmarkId::new("nearest", name), |b| {
                b.iter(|| set.iter().filter(|ray| bvh.nearest(black_box(ray)).is_some()).count());
            });
            group.bench_function(BenchmarkId::new("occluded", name), |b| {
                b.iter(|| set.iter().filter(|ray| bvh.occluded(black_box(ray))).count());
            });
        }
        group.finish();
        if isa == Isa::Portable {
            break;
        }
    }
}

fn build(c: &mut Criterion) {
    let (positions, indices) = terrain();
    let mut group = c.benchmark_group("build");
    group.sample_size(10).throughput(Throughput::Elements(indices.len() as u64));
    group.bench_function("a million triangles", |b| {
        b.iter_batched(|| (), |()| TriangleBvh::build(&positions, &indices), BatchSize::PerIteration);
    });
    group.finish();
}

criterion_group!(benches, rays, build);
criterion_main!(benches);
