//! What is read and written: scene files of every format, sound and damaged.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/skip.rs"]
mod skip;

mod assets;
mod export;
mod fuzz;
mod gltf;
mod readers;
