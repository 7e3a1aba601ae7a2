//! The tasks that check this crate.

mod lobes;

use super::Task;

/// Every check of the crate, row by row.
pub fn tasks() -> Vec<Task> {
    let rows: [fn() -> Vec<Task>; 1] = [lobes::tasks];
    rows.iter().flat_map(|row| row()).collect()
}
