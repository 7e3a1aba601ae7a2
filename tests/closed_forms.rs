//! Every scene that carries its exact answer (`[expect]`) against the renderer: for each strategy and sampler that it
//! names, the mean over its region by z, and every pixel by Student's t with Šidák over the pixels (the standard error
//! of a pixel is its own or the region's, whichever is larger: where light comes by rare events, most pixels have seen
//! too few to know theirs). A new file in `scenes/verify/` is a new test.

mod common;

use common::{SAMPLERS, STRATEGIES, film, load, repo, settings};
use radianza::desc::{Expect, Integrator};
use radianza::film::{CLASSES, Film};
use radianza::scene::Scene;
use radianza::stats::Family;
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::path::PathBuf;

/// Relative error that f32 arithmetic may leave on an estimate without variance.
const ROUNDING: f64 = 2e-5;

/// Samples per pixel where the scene says nothing.
const SPP: u32 = 512;

/// Samples of a replicate: at least 32 replicates for Student's t, of at most 16 samples.
fn replicate(spp: u32) -> u32 {
    1 << (spp / 32).clamp(1, 16).ilog2()
}

fn scenes() -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = [repo("scenes"), repo("scenes/verify")]
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display())))
        .map(|entry| entry.expect("a readable folder").path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    found.sort();
    found
}

/// Mean and standard error of a pixel, RGB.
type Read<'a> = dyn Fn(&Film, u32, u32) -> ([f64; 3], [f64; 3]) + 'a;

/// One quantity: name, exact RGB, and how to read it off the film.
type Quantity<'a> = (String, [f64; 3], Box<Read<'a>>);

fn quantities(expect: &Expect) -> Vec<Quantity<'_>> {
    let mut list: Vec<Quantity> = Vec::new();
    if let Some(value) = expect.radiance {
        list.push(("L".into(), value.rgb(), Box::new(|f, x, y| (f.mean(x, y), f.stderr(x, y).unwrap_or_default()))));
    }
    for (name, value) in &expect.layers {
        let class = CLASSES.iter().position(|c| c == name).unwrap_or_else(|| panic!("no layer `{name}`"));
        let read = move |f: &Film, x: u32, y: u32| {
            (f.class_mean(class, x, y).unwrap_or_default(), f.class_stderr(class, x, y).unwrap_or_default())
        };
        list.push((name.clone(), value.rgb(), Box::new(read)));
    }
    list
}

fn check(name: &str, scene: &Scene, size: [u32; 2], expect: &Expect, family: &mut Family) {
    let or = |list: &[_], all: &[_]| if list.is_empty() { all.to_vec() } else { list.to_vec() };
    let integrators = or(&expect.integrators, &[Integrator::Path]);
    let samplers = if expect.samplers.is_empty() { SAMPLERS.to_vec() } else { expect.samplers.clone() };
    let strategies = if expect.strategies.is_empty() { STRATEGIES.to_vec() } else { expect.strategies.clone() };
    let region = expect.region.unwrap_or([0, 0, size[0], size[1]]);
    for &integrator in &integrators {
        for &strategy in &strategies {
            for &sampler in &samplers {
                let mut s = settings(size);
                (s.integrator, s.strategy, s.sampler) = (integrator, strategy, sampler);
                s.crop = region;
                let spp = expect.spp.unwrap_or(SPP).max(32);
                s.replicate = replicate(spp);
                s.spp = spp.next_multiple_of(s.replicate);
                s.max_depth = expect.max_depth;
                s.transport = !expect.layers.is_empty();
                s.seed = 7;
                let film = film(scene, &s);
                for (what, exact, read) in quantities(expect) {
                    let label = format!("{name} {what} {integrator:?}/{strategy:?}/{sampler:?}");
                    compare(
                        &label,
                        &film,
                        region,
                        exact,
                        f64::from(s.spp / s.replicate),
                        expect.tolerance,
                        &read,
                        family,
                    );
                }
            }
        }
    }
}

fn compare(
    label: &str,
    film: &Film,
    region: [u32; 4],
    exact: [f64; 3],
    replicates: f64,
    tolerance: f64,
    read: &Read,
    family: &mut Family,
) {
    let t = StudentsT::new(0.0, 1.0, replicates - 1.0).expect("several replicates");
    let [x0, y0, x1, y1] = region;
    // Grey answers have three equal channels: one is tested.
    let channels = if exact.iter().all(|&x| x == exact[0]) { 1..2 } else { 0..3 };
    for c in channels {
        let granted = (ROUNDING + tolerance) * exact[c].abs();
        let pixels: Vec<(f64, f64)> = (y0..y1)
            .flat_map(|y| (x0..x1).map(move |x| (x, y)))
            .map(|(x, y)| {
                let (mean, se) = read(film, x, y);
                (mean[c], se[c])
            })
            .collect();
        let n = pixels.len() as f64;
        let mean = pixels.iter().map(|p| p.0).sum::<f64>() / n;
        let pooled = (pixels.iter().map(|p| p.1 * p.1).sum::<f64>() / n).sqrt();
        family.rounded(format!("{label} mean"), exact[c], mean, pooled / n.sqrt(), ROUNDING + tolerance);
        // A pixel that rare events have missed does not know its own error: the region's stands in.
        let t_of = |&(mean, se): &(f64, f64)| match ((mean - exact[c]).abs() - granted).max(0.0) {
            0.0 => 0.0,
            off => off / se.max(pooled),
        };
        let worst = pixels.iter().map(t_of).fold(0.0, f64::max);
        let p = 2.0 * (1.0 - t.cdf(worst));
        family.p(format!("{label} worst of {n} pixels, |t| {worst:.2}"), 1.0 - (1.0 - p).powf(n));
    }
}

#[test]
fn every_scene_with_an_exact_answer_agrees_with_it() {
    let mut family = Family::new("scenes with [expect]");
    let mut tested = 0;
    for path in scenes() {
        let (desc, scene) = load(&path);
        let size = desc.cameras[0].resolution.unwrap_or([8, 8]);
        let name = path.file_stem().expect("a file").to_string_lossy().into_owned();
        for expect in &desc.expect {
            check(&name, &scene, size, expect, &mut family);
            tested += 1;
        }
    }
    assert!(tested >= 10, "only {tested} answers found");
    family.assert();
}
