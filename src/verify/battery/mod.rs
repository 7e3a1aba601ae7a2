//! The tasks that check this crate.

mod camera;
mod filter;
mod light;
mod lobes;
mod sampler;
mod scenes;
mod warp;

use super::Task;

/// Every check of the crate, row by row.
pub fn tasks() -> Vec<Task> {
    let rows: &[fn() -> Vec<Task>] = &[camera::tasks, filter::tasks, light::tasks, lobes::tasks, sampler::tasks, scenes::tasks, warp::tasks];
    rows.iter().flat_map(|row| row()).collect()
}
