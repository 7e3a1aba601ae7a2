//! The tasks that check this crate.

mod agreement;
mod camera;
mod error;
mod filter;
mod light;
mod lobes;
mod restricted;
mod sampler;
mod scenes;
mod warp;

use super::Task;

/// Every check of the crate, row by row.
pub fn tasks() -> Vec<Task> {
    let rows: &[fn() -> Vec<Task>] = &[
        agreement::tasks,
        camera::tasks,
        error::tasks,
        filter::tasks,
        light::tasks,
        lobes::tasks,
        restricted::tasks,
        sampler::tasks,
        scenes::tasks,
        warp::tasks,
    ];
    let mut tasks: Vec<Task> = rows.iter().flat_map(|row| row()).collect();
    // As tables are read, whatever file a row comes from; numbers depend on names alone.
    tasks.sort_by_key(|task| task.topic.id);
    tasks
}
