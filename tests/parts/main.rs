//! The parts of the library: closed forms, χ² of everything that samples, properties.

#[path = "../common/mod.rs"]
mod common;

mod bsdf;
mod bvh;
mod camera;
mod estimators;
mod film;
mod lamps;
mod layers;
mod light;
mod sampling;
mod shape;
mod specimens;
mod warp;
mod watertight;
