//! Row X3: random scenes, in which any two features of the description meet.
//!
//! Every other row proves a part by itself. Faults that survive sit where two parts meet: a lamp with coverage, a mirrored
//! instance with tangents. A random scene has no known answer, but much is known of it: every strategy estimates the same
//! image; in a uniform environment nothing is brighter than it, and what was made white vanishes; no sample is NaN or
//! negative; threads, replays and a file of it change no bit.
//!
//! | file | what |
//! | --- | --- |
//! | `feature.rs` | what a scene may have, and which pairs may meet |
//! | `scene.rs` | a scene of a seed and an index |
//! | `material.rs`, `texture.rs`, `shape.rs`, `light.rs` | its parts |
//! | `judge.rs`, `bits.rs` | what must hold of it |
//! | `mitsuba.rs` | another renderer's image of it, where one is there |
//! | `tally.rs` | which scenes were slow, and what was skipped |
//! | `shrink.rs`, `simpler.rs`, `prune.rs` | the smallest scene that still fails |

mod bits;
mod draw;
mod feature;
mod judge;
mod light;
mod material;
mod mitsuba;
mod prune;
mod scene;
mod shape;
mod shrink;
mod simpler;
mod tally;
mod texture;

pub use feature::{Feature, Features, Pair, lawful_pairs, may_meet};
pub use scene::scene;

pub use tally::Tally;

use super::{Exhibit, Findings, Listing, Task, Topic};
use crate::desc::{self, Filter, Integrator, SamplerKind, Strategy};
use crate::render::Settings;
use crate::sampler::hash;
use judge::{Aspect, kind, least, look};
use std::ops::Range;
use std::time::{Duration, Instant};
use tally::Entry;

const X3: Topic = Topic {
    id: "X3",
    title: "random scenes: strategies agree; open furnace ≤ 1, and = 1 once made white; threads, replays and files change nothing",
    source: "conservation of energy; unbiasedness; pairs of features: Cohen et al. 1997 (pairwise testing)",
};

/// Rays of an image at the first look, by size.
const RAYS: [u64; 2] = [250_000, 500_000];

/// How many times the rays of the first look the later ones take. What has a tail so long that 64 replicates do not know
/// their error is no fault: it is looked at again, with other numbers, before it is said to be one.
const AGAIN: [u64; 2] = [8, 64];

/// Less likely than this, a check is looked at again.
const SUSPECT: f64 = 1e-3;

/// Less likely than this at the last look, it fails: what Šidák leaves to one of a hundred thousand checks.
const FAILS: f64 = 1e-9;

/// Pixels across and down.
const SIDE: u32 = 16;

/// Rays of an image of the battery's row: many scenes that are looked at coarsely meet more than few that are looked at well.
const ROW_RAYS: u64 = 30_000;

/// Tasks of the battery's row.
const ROW: u64 = 12;

/// Scenes of each of its tasks in a thorough run.
const MORE: u64 = 50;

/// A task for each of the scenes `indices` of `seed`; what fails is shrunk. `tally` says afterwards how it went.
pub fn tasks(seed: u64, indices: Range<u64>, tally: &Tally) -> Vec<Task> {
    let task = |index: u64| {
        let tally = tally.clone();
        Task::new(X3, format!("seed {seed} scene {index:05}"), move |trial, found| {
            alone(|| {
                let (desc, _) = scene(seed, index);
                let rays = trial.work(RAYS[0], RAYS[1]);
                let examined = examine(&desc, "", &Aspect::ALL, rays, trial.seed, found);
                tally.add(Entry { index, time: examined.time, compared: examined.compared });
                for Failing { aspect, kind, rays } in examined.failing {
                    let said = if aspect == Aspect::Mitsuba { mitsuba::sayable(&desc) } else { None };
                    let desc = said.unwrap_or_else(|| desc.clone());
                    let shrunk = shrink::shrink(desc, aspect, &kind, rays, trial.seed);
                    let title = format!("the smallest scene found of which `{aspect:?}, {kind}` fails");
                    found.exhibits.push(Exhibit::Listing(Listing { title, text: shrink::text(&shrunk) }));
                }
            });
        })
    };
    indices.map(task).collect()
}

/// The battery's share: a scene a task, many in a thorough run, others for every seed of a run.
pub(super) fn row() -> Vec<Task> {
    let task = |number: u64| {
        Task::new(X3, format!("scenes {number:02}"), move |trial, found| {
            alone(|| {
                for index in 0..trial.pick(1, MORE) {
                    let (desc, _) = scene(trial.seed, index);
                    let rays = trial.work(ROW_RAYS, ROW_RAYS);
                    let name = format!("scene {index:05}, ");
                    let examined = examine(&desc, &name, &Aspect::OURS, rays, trial.part(&name).seed, found);
                    if !examined.failing.is_empty() {
                        found.words.push(format!(
                            "`radianza verify --random {} --seed {} --only 'scene {index:05}'` shrinks what fails",
                            index + 1,
                            trial.seed
                        ));
                    }
                }
            });
        })
    };
    (0..ROW).map(task).collect()
}

/// Does work on one thread that does nothing else: a thread of a pool that waits takes up other tasks meanwhile, and
/// how long its own took would say nothing.
fn alone(work: impl FnOnce() + Send) {
    let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else { return work() };
    let done = std::thread::scope(|scope| scope.spawn(|| pool.install(work)).join());
    if let Err(cause) = done {
        std::panic::resume_unwind(cause);
    }
}

/// What is known of a scene that was looked at.
struct Examined {
    /// Of each aspect that fails, the least likely check.
    failing: Vec<Failing>,
    /// How long the first looks took.
    time: Duration,
    /// Another renderer made an image too.
    compared: bool,
}

/// What fails.
struct Failing {
    aspect: Aspect,
    /// Its least likely kind of check.
    kind: String,
    /// Rays of an image that show it.
    rays: u64,
}

/// Looks at aspects of a scene, and again at what is suspicious.
fn examine(
    desc: &desc::Scene,
    name: &str,
    aspects: &[Aspect],
    first: u64,
    seed: u64,
    found: &mut Findings,
) -> Examined {
    let mut examined = Examined { failing: Vec::new(), time: Duration::ZERO, compared: false };
    found.guarded = true;
    for &aspect in aspects {
        let start = Instant::now();
        let mut rays = first;
        let mut looked = look(desc, aspect, rays, hash(&[seed, aspect as u64]));
        if aspect == Aspect::Mitsuba {
            examined.compared = !looked.checks.checks().is_empty();
        } else {
            examined.time += start.elapsed();
        }
        for (k, more) in AGAIN.into_iter().enumerate() {
            if least(looked.checks.checks()) > SUSPECT || aspect == Aspect::Bits {
                break;
            }
            rays = first * more;
            looked = look(desc, aspect, rays, hash(&[seed, aspect as u64, k as u64 + 1]));
        }
        if least(looked.checks.checks()) < FAILS {
            examined.failing.push(Failing { aspect, kind: kind(looked.checks.checks()), rays });
        }
        for check in looked.checks.checks() {
            found.checks.push(format!("{name}{aspect:?}, {}", check.name), check.evidence);
        }
        if least(looked.checks.checks()) < SUSPECT {
            found.words.extend(looked.words);
            found.exhibits.extend(looked.exhibits);
        }
    }
    examined
}

/// A small image by the path tracer, in replicates of all its samples.
fn settings(spp: u32, seed: u64) -> Settings {
    Settings {
        size: [SIDE; 2],
        crop: [0, 0, SIDE, SIDE],
        camera: 0,
        spp,
        time: None,
        replicate: spp,
        integrator: Integrator::Path,
        strategy: Strategy::Mis,
        sampler: SamplerKind::Lattice,
        // Headers and command lines carry 53 bits.
        seed: seed >> 11,
        max_depth: None,
        filter: Filter::Box,
        transport: false,
        threads: 0,
        tile: SIDE,
    }
}
