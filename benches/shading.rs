//! Evaluations a second: every lobe, both samplers.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;
use radianza::bsdf::{Transport, specimens};
use radianza::sampler::{Kind, Sampler};
use std::hint::black_box;

fn lobes(c: &mut Criterion) {
    let wo = Vec3::new(0.5, 0.2, 0.84).normalize();
    let wi = Vec3::new(-0.3, 0.4, 0.87).normalize();
    let mut group = c.benchmark_group("lobes");
    group.throughput(Throughput::Elements(1));
    for specimen in specimens() {
        let (name, bsdf) = (&specimen.name, &*specimen.bsdf);
        group.bench_function(format!("sample/{name}"), |b| {
            let mut i = 0u32;
            b.iter(|| {
                i = i.wrapping_add(0x9e37_79b9);
                let u = (i >> 8) as f32 / (1 << 24) as f32;
                bsdf.sample(black_box(wo), u, [u, 1.0 - u], Transport::Radiance)
            });
        });
        group.bench_function(format!("eval/{name}"), |b| {
            b.iter(|| bsdf.eval(black_box(wo), black_box(wi), Transport::Radiance));
        });
    }
    group.finish();
}

fn samplers(c: &mut Criterion) {
    let mut group = c.benchmark_group("samplers");
    group.throughput(Throughput::Elements(1));
    for kind in [Kind::Independent, Kind::Sobol, Kind::Lattice] {
        group.bench_function(format!("{kind:?}/2d"), |b| {
            let mut index = 0;
            let mut sampler = Sampler::new(kind, 1, [3, 4], index, 16);
            b.iter(|| {
                // A path of about twenty numbers, then the next sample.
                if sampler.dimension() >= 20 {
                    index += 1;
                    sampler = Sampler::new(kind, 1, [3, 4], index, 16);
                }
                sampler.next_2d()
            });
        });
    }
    group.finish();
}

criterion_group!(benches, lobes, samplers);
criterion_main!(benches);
