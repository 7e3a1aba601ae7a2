//! The command line of Radianza.
fn main() {}
