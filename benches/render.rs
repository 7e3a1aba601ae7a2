//! Msamples/s of the path tracer on the Cornell box, all cores, depth 8, box filter.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use radianza::desc::{self, Filter, Integrator, SamplerKind, Strategy};
use radianza::render::{Settings, render};
use radianza::scene::Scene;
use std::path::Path;
use std::sync::atomic::AtomicBool;

fn cornell(c: &mut Criterion) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-box.toml");
    let scene = desc::load(&path).and_then(|desc| Scene::compile(&desc)).unwrap_or_else(|e| panic!("{e}"));
    let mut group = c.benchmark_group("Cornell box");
    group.sample_size(10);
    for sampler in [SamplerKind::Independent, SamplerKind::Sobol, SamplerKind::Lattice] {
        let settings = Settings {
            size: [256, 256],
            crop: [0, 0, 256, 256],
            camera: 0,
            spp: 16,
            time: None,
            replicate: 16,
            integrator: Integrator::Path,
            strategy: Strategy::Mis,
            sampler,
            seed: 1,
            max_depth: Some(7),
            filter: Filter::Box,
            transport: false,
            threads: 0,
            tile: 16,
        };
        group.throughput(Throughput::Elements(256 * 256 * 16));
        group.bench_function(format!("samples, {sampler:?}"), |b| {
            b.iter(|| render(&scene, &settings, &AtomicBool::new(false), &|_| {}).map(|o| o.rays));
        });
    }
    group.finish();
}

criterion_group!(benches, cornell);
criterion_main!(benches);
