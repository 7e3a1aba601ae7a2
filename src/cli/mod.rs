//! The commands, a file each.

mod args;
mod compare;
mod conformance;
mod environment;
mod export;
mod failure;
mod info;
mod interrupt;
mod meter;
mod pick;
mod progress;
mod render;
mod settings;
mod verify;

pub(crate) use failure::Failure;

use clap::{Parser, Subcommand};

/// Solves the rendering equation by Monte Carlo and says how far each pixel may be from the solution.
#[derive(Parser, Debug)]
#[command(name = "radianza", version, after_help = failure::HELP, after_long_help = failure::HELP)]
pub(crate) struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Render a scene (.toml, .gltf, .glb, .obj, .ply) to an EXR that knows its error, and a PNG
    Render(Box<render::Arguments>),
    /// Say what a scene holds, or print the JSON Schema of scene files
    Info(info::Arguments),
    /// Write a scene for another renderer: Mitsuba 3, pbrt-v4
    Export(Box<export::Arguments>),
    /// Compare two EXR images: errors, bias and its z
    Compare(compare::Arguments),
    /// Prove the estimator: closed forms, densities, reciprocity, energy, agreement of estimators
    Verify(verify::Arguments),
}

/// Does what the arguments say.
pub(crate) fn run(cli: &Cli) -> Result<(), Failure> {
    radianza::bvh::Isa::chosen().map_err(Failure::Usage)?;
    match &cli.command {
        Command::Render(arguments) => render::run(arguments),
        Command::Info(arguments) => info::run(arguments),
        Command::Export(arguments) => export::run(arguments),
        Command::Compare(arguments) => compare::run(arguments),
        Command::Verify(arguments) => verify::run(arguments),
    }
}

/// Help and version are answers; everything else that cannot be parsed is a failure.
pub(crate) fn usage(message: &clap::Error) -> Result<(), Failure> {
    if message.use_stderr() {
        let text = message.to_string();
        return Err(Failure::Usage(text.trim_start_matches("error: ").trim_end().into()));
    }
    // A closed pipe is no reason to complain about help.
    let _ = message.print();
    Ok(())
}
