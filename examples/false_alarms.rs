//! Measures how often the battery fails though nothing is wrong, and whether its z-values are normal:
//!
//! ```text
//! cargo run --release --example false_alarms -- --runs 1000 --share 0.02
//! ```
//!
//! Each run has a seed of its own and does each task with probability `share`, so that a thousand runs cost what
//! `1000 × share` batteries do. What it prints is kept in `reference/false-alarms.md`.
//!
//! With `--scenes` the same is measured of `radianza verify SCENE`: each run takes the random scene whose index is its seed,
//! in the quick size.

use clap::Parser;
use radianza::sampler::{Kind, Sampler};
use radianza::scene::Scene;
use radianza::stats::ALPHA;
use radianza::verify::calibration::Calibration;
use radianza::verify::{self, Size, Task, battery, random, run};
use std::process::ExitCode;
use std::time::Instant;

#[derive(Parser)]
#[command(about = "How often the battery fails though nothing is wrong")]
struct Args {
    /// Runs, each with its own seed.
    #[arg(long, default_value_t = 1000)]
    runs: u64,
    /// Probability of each task to be in a run.
    #[arg(long, default_value_t = 0.02)]
    share: f32,
    /// Seed of the first run; the others count on.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Each run is one random scene and what `verify SCENE` checks of it
    #[arg(long)]
    scenes: bool,
    /// Only tasks whose names contain one of these.
    #[arg(long)]
    only: Vec<String>,
}

/// What `verify SCENE` checks of the random scene with this index.
fn of_scene(index: u64) -> Vec<Task> {
    let (desc, _) = random::scene(0, index);
    match Scene::compile(&desc) {
        Ok(scene) => verify::scene::tasks(&desc.into(), &scene.into()),
        Err(e) => {
            eprintln!("scene {index}: {e}");
            Vec::new()
        }
    }
}

fn main() -> ExitCode {
    let args = Args::parse();
    let start = Instant::now();
    let (battery, size) = match args.scenes {
        true => (Vec::new(), Size::Quick),
        false => (battery::tasks(), Size::Default),
    };
    let chosen = |tasks: Vec<Task>| tasks.into_iter().filter(|task| task.matches(&args.only)).collect::<Vec<_>>();
    let mut all = chosen(battery);
    let mut calibration = Calibration::default();
    for seed in args.seed..args.seed.saturating_add(args.runs) {
        if args.scenes {
            all = chosen(of_scene(seed));
        }
        // Chosen tasks to the front.
        let mut chance = Sampler::new(Kind::Independent, seed, [0x5a, 0x5a], 0, 1);
        let mut count = 0;
        for k in 0..all.len() {
            if chance.next_1d() < args.share {
                all.swap(k, count);
                count += 1;
            }
        }
        calibration.add(&run(&all[..count], size, seed, ALPHA, &|_| {}));
        if (seed - args.seed) % 50 == 49 {
            eprintln!("{} runs in {:.0} s", seed - args.seed + 1, start.elapsed().as_secs_f64());
        }
    }
    println!("# False alarms\n");
    println!(
        "`cargo run --release --example false_alarms -- {}--runs {} --share {} --seed {}`: {} tasks, each in a run with \
         probability {}.\n",
        if args.scenes { "--scenes " } else { "" },
        args.runs,
        args.share,
        args.seed,
        all.len(),
        args.share
    );
    print!("{calibration}");
    if calibration.holds() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
