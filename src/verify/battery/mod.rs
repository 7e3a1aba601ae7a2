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
mod splats;
mod warp;

use super::{Task, random};
use std::collections::HashMap;

/// Every check of the crate, row by row.
pub fn tasks() -> Vec<Task> {
    let rows: &[fn() -> Vec<Task>] = &[
        agreement::tasks,
        camera::tasks,
        error::tasks,
        filter::tasks,
        light::tasks,
        lobes::tasks,
        random::row,
        restricted::tasks,
        sampler::tasks,
        scenes::tasks,
        splats::tasks,
        warp::tasks,
    ];
    let mut tasks: Vec<Task> = rows.iter().flat_map(|row| row()).collect();
    // As tables are read, whatever file a row comes from; numbers depend on names alone.
    tasks.sort_by_key(|task| task.topic.id);
    tasks
}

/// Of every row every third task, and at least one: what a quick run of the whole battery does.
pub fn excerpt(tasks: Vec<Task>) -> Vec<Task> {
    let mut seen: HashMap<&'static str, usize> = HashMap::new();
    let third = |task: &Task| {
        let seen = seen.entry(task.topic.id).or_default();
        *seen += 1;
        *seen % 3 == 1
    };
    tasks.into_iter().filter(third).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn an_excerpt_has_a_third_of_every_row() {
        let rows = |tasks: &[Task]| tasks.iter().map(|task| task.topic.id).collect::<BTreeSet<_>>();
        let (all, some) = (tasks(), excerpt(tasks()));
        assert_eq!(rows(&all), rows(&some));
        assert!(
            (all.len() / 3..all.len() / 3 + rows(&all).len()).contains(&some.len()),
            "{} of {}",
            some.len(),
            all.len()
        );
    }
}
