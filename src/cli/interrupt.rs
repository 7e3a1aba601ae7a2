//! What Ctrl-C and SIGTERM do.

use super::Failure;
use std::process::exit;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// True once the user or the system wants an end. A second wish is granted at once.
pub(super) fn after_the_pass() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let handler = move || {
        if flag.swap(true, Ordering::Relaxed) {
            exit(Failure::Nothing.code().into());
        }
        eprintln!("note: ending after the running pass; interrupt again to quit at once");
    };
    if ctrlc::set_handler(handler).is_err() {
        eprintln!("note: interrupts are not caught; one will lose the image");
    }
    stop
}

/// Ends at once, with nothing written: a part of a run is no verdict.
pub(super) fn at_once() {
    // Where it cannot be set, the system's own handler ends the process, with its own code.
    let _ = ctrlc::set_handler(|| {
        Failure::Abandoned.report();
        exit(Failure::Abandoned.code().into());
    });
}
