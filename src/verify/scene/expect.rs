//! The exact answers that a file carries.

use super::Subject;
use crate::verify::expect::{Effort, check, ways};
use crate::verify::replicated::Census;
use crate::verify::{Findings, Task, Topic, Trial};

const TOPIC: Topic = Topic {
    id: "expect",
    title: "every way of estimating gives the answer that stands in the file",
    source: "the file's own [expect]",
};

/// Relative bias to detect.
const AIM: f64 = 5e-3;

/// Rays of one way, by size; the renderer's own gets [`OWN`] times as many.
const RAYS: [f64; 2] = [1e5, 1.5e6];
const OWN: f64 = 10.0;

/// A task for each answer.
pub(super) fn tasks(subject: &Subject) -> Vec<Task> {
    let task = |number: usize| {
        let subject = subject.clone();
        let formula = &subject.desc.expect[number].formula;
        let name = if formula.is_empty() { format!("answer {number}") } else { format!("answer {number}: {formula}") };
        Task::new(TOPIC, name, move |trial, found| compare(&subject, number, trial, found))
    };
    (0..subject.desc.expect.len()).map(task).collect()
}

fn compare(subject: &Subject, number: usize, trial: &Trial, found: &mut Findings) {
    let expect = &subject.desc.expect[number];
    let size = subject.desc.cameras.first().and_then(|camera| camera.resolution).unwrap_or([8, 8]);
    let mut census = Census::default();
    let ways = ways(expect);
    for (i, &way) in ways.iter().enumerate() {
        let share = if i + 1 == ways.len() { OWN } else { 1.0 };
        let effort = Effort { aim: AIM, rays: share * trial.pick(RAYS[0], RAYS[1]) };
        check(&subject.scene, size, expect, way, effort, trial, &mut census, found);
    }
    census.report(found);
}
