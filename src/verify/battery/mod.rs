//! The tasks that check this crate.

use super::Task;

/// Every check of the crate, row by row.
pub fn tasks() -> Vec<Task> {
    let rows: [fn() -> Vec<Task>; 0] = [];
    rows.iter().flat_map(|row| row()).collect()
}
