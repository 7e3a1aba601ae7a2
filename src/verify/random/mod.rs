//! Row X3: random scenes, in which any two features of the description meet.
//!
//! Every other row proves a part by itself. Faults that survive sit where two parts meet: a lamp with coverage, a mirrored
//! instance with tangents. A random scene has no known answer, but much is known of it: every strategy estimates the same
//! image; in a uniform environment nothing is brighter than it, and what was made white vanishes; no sample is NaN or
//! negative; threads and replays change no bit.
//!
//! | file | what |
//! | --- | --- |
//! | `feature.rs` | what a scene may have, and which pairs may meet |
//! | `scene.rs` | a scene of a seed and an index |
//! | `material.rs`, `texture.rs`, `shape.rs`, `light.rs` | its parts |
//! | `judge.rs`, `bits.rs` | what must hold of it |
//! | `mitsuba.rs` | another renderer's image of it, where one is there |
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
mod texture;

pub use feature::{Feature, Features, Pair, lawful_pairs, may_meet};
pub use scene::scene;

use super::{Findings, Task, Topic, Trial};
use crate::desc;
use crate::sampler::hash;
use judge::{Aspect, least, look};
use std::ops::Range;
use std::time::{Duration, Instant};

const X3: Topic = Topic {
    id: "X3",
    title: "random scenes: strategies agree; open furnace ≤ 1, and = 1 once made white; threads and replays change nothing",
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

/// How long a scene may take at its first look without a word about it.
const SLOW: Duration = Duration::from_secs(30);

/// A task for each of the scenes `indices` of `seed`; what fails is shrunk.
pub fn tasks(seed: u64, indices: Range<u64>) -> Vec<Task> {
    let task = |index: u64| {
        Task::new(X3, format!("seed {seed} scene {index:05}"), move |trial, found| {
            let (desc, _) = scene(seed, index);
            let failing = examine(&desc, trial, found);
            if let Some((aspect, rays)) = failing {
                let shrunk = shrink::shrink(desc, aspect, rays, trial.seed);
                found.words.push(format!("seed {seed}, scene {index}, {aspect:?} fails; the smallest that does:"));
                found.words.push(shrink::text(&shrunk));
            }
        })
    };
    indices.map(task).collect()
}

/// Looks at a scene, and again at what is suspicious. The first aspect that fails, and the rays that show it.
fn examine(desc: &desc::Scene, trial: &Trial, found: &mut Findings) -> Option<(Aspect, u64)> {
    let start = Instant::now();
    let mut failing = None;
    let first = trial.work(RAYS[0], RAYS[1]);
    found.guarded = true;
    for aspect in Aspect::ALL {
        let mut rays = first;
        let mut looked = look(desc, aspect, rays, hash(&[trial.seed, aspect as u64]));
        for (k, more) in AGAIN.into_iter().enumerate() {
            if least(looked.checks.checks()) > SUSPECT || more > 1 && aspect == Aspect::Bits {
                break;
            }
            rays = first * more;
            looked = look(desc, aspect, rays, hash(&[trial.seed, aspect as u64, k as u64 + 1]));
        }
        if failing.is_none() && least(looked.checks.checks()) < FAILS {
            failing = Some((aspect, rays));
        }
        let name = |name: &str| format!("{aspect:?}, {name}");
        looked.checks.checks().iter().for_each(|check| found.checks.push(name(&check.name), check.evidence));
        if least(looked.checks.checks()) < SUSPECT {
            found.words.extend(looked.words);
            found.exhibits.extend(looked.exhibits);
        }
    }
    if failing.is_none() && start.elapsed() > SLOW {
        found.words.push(format!("slow: {:.0} s", start.elapsed().as_secs_f64()));
    }
    failing
}
