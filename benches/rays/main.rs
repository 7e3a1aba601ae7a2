//! Mrays/s of nearest-hit and occlusion queries on five scenes, beside Embree where `EMBREE_LIB` names its library.
//!
//! ```text
//! cargo bench --bench rays                                              # ours alone
//! EMBREE_LIB=…/libembree4.so.4 cargo bench --bench rays                 # and Embree, medium and high quality, fast and robust
//! cargo bench --bench rays -- terrain                                   # scenes with this in their name
//! ```
//!
//! Kernels that this CPU has beside its best stand under their names, on trees of the default quality; the best kernel under the names
//! of all qualities. One thread, its CPU time, all contenders in turn on the same rays of one process, medians of eleven turns. A ratio of 1.25 is
//! a quarter more rays in the same time. Rays that leave a surface do not meet it again: ours know which triangle it was, as the
//! renderer's do, Embree's begin a little later, as its users have it. With `--untold` neither is so. Also prints the seconds
//! that each tree took to build, and how often hits differ.

mod embree;
mod scenes;

use cpu_time::ThreadTime;
use embree::{BuildQuality, Embree};
use radianza::bvh::{Isa, Quality, TriangleBvh, TriangleRef};
use radianza::math::Ray;
use scenes::{Meshed, Query, RaySet};
use std::hint::black_box;
use std::rc::Rc;

const TURNS: usize = 11;

/// Where Embree's rays begin that leave a surface, in the largest coordinate of their origin: what Mitsuba 3 moves its origins by.
const NEAR: f32 = 1500.0 * 0.5 * f32::EPSILON;

/// Traces the rays of a set: the number that meet something, and Σ t of nearest hits.
type Run<'a> = Box<dyn Fn(&[Ray]) -> (usize, f64) + 'a>;

/// Something that answers both queries, once it knows of a set what it may know.
struct Contender<'a> {
    name: String,
    prepare: Box<dyn Fn(&RaySet) -> Run<'a> + 'a>,
}

/// One of ours: rays know which triangle they leave, as the renderer's do, where they are `told`.
fn own<'a>(name: &str, bvh: TriangleBvh, told: bool) -> Contender<'a> {
    let bvh = Rc::new(bvh);
    let prepare = move |set: &RaySet| {
        let slot = |ray: &Ray| bvh.nearest(ray, TriangleRef::NONE).map_or(TriangleRef::NONE, |hit| hit.slot);
        let leaving: Vec<TriangleRef> = if told && set.leaves_surfaces() {
            set.parents.iter().map(slot).collect()
        } else {
            vec![TriangleRef::NONE; set.rays.len()]
        };
        let (bvh, query) = (bvh.clone(), set.query);
        Box::new(move |rays: &[Ray]| ours(&bvh, query, rays, &leaving)) as Run
    };
    Contender { name: name.into(), prepare: Box::new(prepare) }
}

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let told = !std::env::args().any(|a| a == "--untold");
    let library = std::env::var_os("EMBREE_LIB").map(|path| {
        Embree::load(&path).unwrap_or_else(|e| {
            eprintln!("EMBREE_LIB: {}: {e}", path.display());
            std::process::exit(1)
        })
    });
    if library.is_none() {
        println!("EMBREE_LIB is not set: without Embree");
    }
    let mut sums: Vec<Geometric> = Vec::new();
    for scene in scenes::all().filter(|s| wanted.is_empty() || wanted.iter().any(|w| s.name.contains(w.as_str()))) {
        race(&scene, library.as_ref(), told, &mut sums);
    }
    println!("\ngeometric means over all sets");
    for sum in sums {
        println!("  {:32} {:.3}", sum.name, (sum.log / f64::from(sum.n)).exp());
    }
}

/// A geometric mean as it grows.
struct Geometric {
    name: String,
    log: f64,
    n: u32,
}

fn add(sums: &mut Vec<Geometric>, name: String, ratio: f64) {
    match sums.iter_mut().find(|s| s.name == name) {
        Some(sum) => (sum.log, sum.n) = (sum.log + ratio.ln(), sum.n + 1),
        None => sums.push(Geometric { name, log: ratio.ln(), n: 1 }),
    }
}

fn race(scene: &Meshed, library: Option<&Embree>, told: bool, sums: &mut Vec<Geometric>) {
    let Meshed { name, positions, indices, .. } = scene;
    println!("\n{name}: {} triangles", indices.len());
    let trees = Quality::ALL.map(|(quality, name)| {
        let start = std::time::Instant::now();
        let bvh = TriangleBvh::build(positions, indices, quality);
        let per_triangle = bvh.memory() as f64 / indices.len() as f64;
        println!("  {name}: built in {:.2} s, {per_triangle:.0} bytes a triangle", start.elapsed().as_secs_f64());
        (bvh, name)
    });
    let sets = scene.rays(&trees[0].0);

    let mut contenders = Vec::new();
    for (isa, isa_name) in Isa::ALL.into_iter().filter(|(isa, _)| *isa < Isa::detect()) {
        let Some(bvh) = TriangleBvh::build(positions, indices, Quality::Default).with_isa(isa) else { continue };
        contenders.push(own(isa_name, bvh, told));
    }
    for (bvh, name) in trees {
        contenders.push(own(name, bvh, told));
    }
    let best_of_ours = contenders.len() - 1;
    if let Some(library) = library {
        for (quality, robust) in [
            (BuildQuality::Medium, false),
            (BuildQuality::High, false),
            (BuildQuality::Medium, true),
            (BuildQuality::High, true),
        ] {
            let start = std::time::Instant::now();
            let tree = library.build(positions, indices, quality, robust);
            let how = if robust { "robust" } else { "fast" };
            println!("  Embree {quality:?} {how}: built in {:.2} s", start.elapsed().as_secs_f64());
            let tree = Rc::new(tree);
            let prepare = move |set: &RaySet| {
                let near = if told && set.leaves_surfaces() { NEAR } else { 0.0 };
                let (tree, query) = (tree.clone(), set.query);
                Box::new(move |rays: &[Ray]| tree.answer(query, rays, near)) as Run
            };
            contenders.push(Contender { name: format!("Embree {how}"), prepare: Box::new(prepare) });
        }
    }

    print!("  {:16}", "Mrays/s");
    contenders.iter().for_each(|c| print!(" {:>13}", c.name));
    println!();
    for set in &sets {
        let RaySet { name, query, rays, .. } = set;
        let mut seconds = vec![Vec::with_capacity(TURNS); contenders.len()];
        let runs: Vec<Run> = contenders.iter().map(|c| (c.prepare)(set)).collect();
        let answers: Vec<_> = runs.iter().map(|run| run(rays)).collect();
        for _ in 0..TURNS {
            for (run, seconds) in runs.iter().zip(&mut seconds) {
                let start = ThreadTime::now();
                black_box(run(black_box(rays)));
                seconds.push(start.elapsed().as_secs_f64());
            }
        }
        let mut rates = Vec::new();
        print!("  {name:16}");
        for seconds in &mut seconds {
            seconds.sort_by(f64::total_cmp);
            rates.push(rays.len() as f64 / seconds[TURNS / 2] / 1e6);
            print!(" {:13.2}", rates[rates.len() - 1]);
        }
        println!();
        for (i, answer) in answers.iter().enumerate() {
            let (hits, expected) = (answer.0 as f64, answers[best_of_ours].0 as f64);
            if (hits - expected).abs() > 1e-3 * rays.len() as f64 {
                println!("    {} meets {hits} of {} rays, ours {expected}", contenders[i].name, rays.len());
            }
        }
        let own = rates[best_of_ours];
        for (i, rate) in rates[..best_of_ours].iter().enumerate() {
            add(sums, format!("{} / {}", contenders[best_of_ours].name, contenders[i].name), own / rate);
        }
        for how in ["Embree fast", "Embree robust"] {
            let of = |(c, rate): (&Contender, &f64)| (c.name == how).then_some(*rate);
            let best = contenders.iter().zip(&rates).filter_map(of).fold(0.0, f64::max);
            if best > 0.0 {
                println!("    {:.2} × {how}", own / best);
                add(sums, format!("{} / best {how}", contenders[best_of_ours].name), own / best);
                let kind = if *query == Query::Occluded { "shadow" } else { "nearest" };
                add(sums, format!("  of {kind} rays, {how}"), own / best);
            }
        }
    }
}

fn ours(bvh: &TriangleBvh, query: Query, rays: &[Ray], leaving: &[TriangleRef]) -> (usize, f64) {
    let rays = rays.iter().zip(leaving);
    match query {
        Query::Nearest => rays.fold((0, 0.0), |(n, sum), (ray, &slot)| match bvh.nearest(ray, slot) {
            Some(hit) => (n + 1, sum + f64::from(hit.t)),
            None => (n, sum),
        }),
        Query::Occluded => (rays.filter(|(ray, slot)| bvh.occluded(ray, **slot)).count(), 0.0),
    }
}
