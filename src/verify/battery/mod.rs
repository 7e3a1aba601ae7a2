//! The tasks that check this crate.

mod light;
mod lobes;
mod scenes;

use super::Task;

/// Every check of the crate, row by row.
pub fn tasks() -> Vec<Task> {
    let rows: &[fn() -> Vec<Task>] = &[light::tasks, lobes::tasks, scenes::tasks];
    rows.iter().flat_map(|row| row()).collect()
}
