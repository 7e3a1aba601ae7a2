//! Measures how often the battery fails though nothing is wrong, and whether its z-values are normal:
//!
//! ```text
//! cargo run --release --example false_alarms -- --runs 1000 --share 0.02
//! ```
//!
//! Each run has a seed of its own and does each task with probability `share`, so that a thousand runs cost what
//! `1000 × share` batteries do. What it prints is kept in `reference/false-alarms.md`.

use clap::Parser;
use radianza::sampler::{Kind, Sampler};
use radianza::stats::ALPHA;
use radianza::verify::calibration::Calibration;
use radianza::verify::{Size, Task, battery, run};
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
    /// Only tasks whose names contain one of these.
    #[arg(long)]
    only: Vec<String>,
}

fn main() -> ExitCode {
    let args = Args::parse();
    let start = Instant::now();
    let mut all: Vec<Task> = battery::tasks().into_iter().filter(|task| task.matches(&args.only)).collect();
    let mut calibration = Calibration::default();
    for seed in args.seed..args.seed.saturating_add(args.runs) {
        // Chosen tasks to the front.
        let mut chance = Sampler::new(Kind::Independent, seed, [0x5a, 0x5a], 0, 1);
        let mut chosen = 0;
        for k in 0..all.len() {
            if chance.next_1d() < args.share {
                all.swap(k, chosen);
                chosen += 1;
            }
        }
        calibration.add(&run(&all[..chosen], Size::Default, seed, ALPHA, &|_| {}));
        if (seed - args.seed) % 50 == 49 {
            eprintln!("{} runs in {:.0} s", seed - args.seed + 1, start.elapsed().as_secs_f64());
        }
    }
    println!("# False alarms\n");
    println!(
        "`cargo run --release --example false_alarms -- --runs {} --share {} --seed {}`: {} tasks, each in a run with \
         probability {}.\n",
        args.runs,
        args.share,
        args.seed,
        all.len(),
        args.share
    );
    print!("{calibration}");
    if calibration.holds() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
