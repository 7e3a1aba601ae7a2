//! `radianza verify`.

mod outputs;
mod select;

use outputs::Outputs;
use select::{list, select};

use super::meter::{Meter, left, time};
use super::pick::Pick;
use super::{Failure, args, interrupt};
use radianza::desc::{self, Options};
use radianza::scene::Scene;
use radianza::stats::ALPHA;
use radianza::verify::random::Tally;
use radianza::verify::report::text::{self, Detail};
use radianza::verify::report::{About, count, one_line};
use radianza::verify::{self, Report, Size, Task, battery};
use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// Prove the estimator, or a scene: every check is a hypothesis test that can fail, and all of them share one
/// significance.
#[derive(clap::Args, Debug)]
pub(crate) struct Arguments {
    /// A scene to check instead of the program: .toml, .gltf, .glb, .obj or .ply
    scene: Option<PathBuf>,
    #[command(flatten)]
    pick: Pick,
    /// Check N random scenes of the seed instead, in which any two features of the scene description meet; what fails is
    /// shrunk and printed
    #[arg(long, value_name = "N", conflicts_with = "scene")]
    random: Option<u64>,
    /// A quarter of an hour of two cores instead of a minute: more members, smaller detectable biases
    #[arg(long, conflicts_with = "quick")]
    thorough: bool,
    /// An eighth of the work, a look while working: finds large faults and no small biases; without SCENE and --only
    /// it takes every third subject
    #[arg(long)]
    quick: bool,
    /// Print the names of what would be checked, one a line, and check nothing; with -v, what each topic means
    #[arg(long)]
    list: bool,
    /// Check only what has PATTERN in its name, in upper or lower case; may be given more than once
    #[arg(long, value_name = "PATTERN")]
    only: Vec<String>,
    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Probability that correct code fails the run, shared by all its checks
    #[arg(long, value_name = "P", default_value_t = ALPHA, value_parser = args::significance)]
    alpha: f64,
    /// Threads; 0: all cores. Changes nothing in the findings
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    /// Write the findings as JSON; `-` is stdout, in place of the table
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write them as JUnit XML, which CI systems show
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Write them as a page of its own with curves, maps and pictures
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Print every check, not the least likely of each subject
    #[arg(short, long, conflicts_with = "quiet")]
    verbose: bool,
    /// No progress; print only what fails
    #[arg(short, long)]
    quiet: bool,
}

/// Checks, prints, writes; fails where a check does.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let tally = Tally::default();
    if arguments.list {
        return print(&list(&select(tasks(arguments, &tally)?, &arguments.only)?, arguments.verbose));
    }

    // Know before that the findings can be kept.
    let outputs = Outputs::new(arguments)?;
    interrupt::at_once();
    let mut tasks = select(tasks(arguments, &tally)?, &arguments.only)?;
    if arguments.quick && arguments.scene.is_none() && arguments.random.is_none() && arguments.only.is_empty() {
        tasks = battery::excerpt(tasks);
    }
    let mut report = check(&tasks, arguments)?;
    if arguments.random.is_some() {
        report.notes.extend(tally.notes());
    }
    outputs.write(&report, &about(arguments))?;
    if !outputs.take_stdout() {
        print(&text::table(&report, detail(arguments)))?;
    }
    verdict(&report)
}

/// Everything that can be checked of the scene, or of the program; `tally` takes what random scenes say of themselves.
fn tasks(arguments: &Arguments, tally: &Tally) -> Result<Vec<Task>, Failure> {
    let options = arguments.pick.options();
    let Some(path) = &arguments.scene else {
        return match options == Options::default() {
            true => Ok(match arguments.random {
                Some(count) => verify::random::tasks(arguments.seed, 0..count, tally),
                None => battery::tasks(),
            }),
            false => Err(Failure::Usage("a time or a variant needs a scene".into())),
        };
    };
    let scene = desc::load_with(path, &options)?;
    if !arguments.quiet {
        scene.notes.iter().for_each(|text| eprintln!("note: {}", one_line(text)));
    }
    let compiled = Scene::compile(&scene)?;
    Ok(verify::scene::tasks(&Arc::new(scene), &Arc::new(compiled)))
}

fn check(tasks: &[Task], arguments: &Arguments) -> Result<Report, Failure> {
    let size = size(arguments);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build();
    let pool = pool.map_err(|e| Failure::Usage(format!("{} threads: {e}", arguments.threads)))?;
    let (start, meter) = (Instant::now(), Meter::new(arguments.quiet));
    let news = |progress: &verify::Progress| {
        let (elapsed, fraction) = (start.elapsed(), progress.done as f64 / progress.total as f64);
        meter.update(elapsed, fraction, || {
            let left = time(left(elapsed, fraction));
            format!("{} of {}, about {left} left: {}", progress.done, progress.total, one_line(&progress.last.name()))
        });
    };
    let report = pool.install(|| verify::run(tasks, size, arguments.seed, arguments.alpha, &news));
    meter.finish();
    Ok(report)
}

fn size(arguments: &Arguments) -> Size {
    match (arguments.quick, arguments.thorough) {
        (true, _) => Size::Quick,
        (_, true) => Size::Thorough,
        _ => Size::Default,
    }
}

fn detail(arguments: &Arguments) -> Detail {
    match (arguments.verbose, arguments.quiet) {
        (true, _) => Detail::All,
        (_, true) => Detail::Failures,
        _ => Detail::Worst,
    }
}

/// What was run, and the command that does it again.
fn about(arguments: &Arguments) -> About {
    let quoted = |text: &str| format!("'{}'", text.replace('\'', r"'\''"));
    let scene = arguments.scene.as_ref().map(|path| path.to_string_lossy());
    let mut command = String::from("radianza verify");
    if let Some(scene) = &scene {
        command += &format!(" {}", quoted(scene));
        command += &arguments.pick.command(quoted);
    }
    if let Some(count) = arguments.random {
        command += &format!(" --random {count}");
    }
    command += &format!(" --seed {} --alpha {}", arguments.seed, arguments.alpha);
    match size(arguments) {
        Size::Default => {}
        size => command += &format!(" --{}", size.name()),
    }
    for pattern in &arguments.only {
        command += &format!(" --only {}", quoted(pattern));
    }
    let name = arguments.scene.as_ref().and_then(|path| path.file_name()).map(|name| name.to_string_lossy());
    About { what: name.map_or("Radianza itself".into(), |name| name.into_owned()), command }
}

fn verdict(report: &Report) -> Result<(), Failure> {
    let (all, failures) = (report.checks().count(), report.failures().count());
    match report.passes() {
        true => Ok(()),
        false if all == 0 => Err(Failure::Verification("nothing was checked".into())),
        false => Err(Failure::Verification(format!("{} of {} checks fail", count(failures), count(all)))),
    }
}

/// To stdout, with colours where a terminal shows them. Whoever closes the pipe has seen enough.
fn print(text: &str) -> Result<(), Failure> {
    match anstream::stdout().lock().write_all(text.as_bytes()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => Err(Failure::Output("stdout".into(), e)),
        _ => Ok(()),
    }
}
