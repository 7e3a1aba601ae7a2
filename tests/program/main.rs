//! The program from outside: its command line, its reports, the reference pictures, the planted faults.

#[path = "../common/skip.rs"]
mod skip;

mod cli;
mod faults;
mod pictures;
mod report;
