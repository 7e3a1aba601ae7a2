//! Tests that cannot run on a machine say so where a person sees it.

use std::io::Write;

/// Says that the running test is skipped, and why. A skipped test passes, and the harness keeps to itself what passing tests
/// print; it takes `println!` and `eprintln!` alone, so this goes to stderr itself.
pub(crate) fn skip(why: &str) {
    let test = std::thread::current().name().unwrap_or("a test").to_owned();
    // Not in parts, which other threads could come between.
    let line = format!("\nskipped: {test}: {why}\n");
    let _ = std::io::stderr().write_all(line.as_bytes());
}
