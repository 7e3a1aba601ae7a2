//! The command line of Radianza: parse → call → report.

mod cli;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let outcome = match cli::Cli::try_parse() {
        Ok(arguments) => cli::run(&arguments),
        Err(message) => cli::usage(&message),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.report();
            ExitCode::from(failure.code())
        }
    }
}
