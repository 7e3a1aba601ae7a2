//! The tasks that check this crate.

mod agreement;
mod restricted;
mod scenes;

use super::Task;

/// Every check of the crate, row by row.
pub fn tasks() -> Vec<Task> {
    let rows: [fn() -> Vec<Task>; 3] = [scenes::tasks, agreement::tasks, restricted::tasks];
    rows.iter().flat_map(|row| row()).collect()
}
