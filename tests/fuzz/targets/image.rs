#![no_main]

#[path = "../bodies.rs"]
mod bodies;

// Decoders of others may panic: what is caught is no finding, and what is not ends the process whatever the hook does.
libfuzzer_sys::fuzz_target!(init: std::panic::set_hook(Box::new(|_| {})), |bytes: &[u8]| bodies::image(bytes));
