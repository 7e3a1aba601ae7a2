//! The tasks that check this crate.

mod light;
mod scenes;

use super::Task;

/// Every check of the crate, row by row.
pub fn tasks() -> Vec<Task> {
    let rows: &[fn() -> Vec<Task>] = &[light::tasks, scenes::tasks];
    rows.iter().flat_map(|row| row()).collect()
}
