//! The exact answers that a file carries.

use super::Subject;
use crate::verify::expect::{Effort, checks};
use crate::verify::{Task, Topic};

const TOPIC: Topic = Topic {
    id: "expect",
    title: "every way of estimating gives the answer that stands in the file",
    source: "the file's own [expect]",
};

/// Relative bias to detect.
const AIM: f64 = 5e-3;

/// Most rays of one way, by size; the renderer's own gets [`OWN`] times as many.
const RAYS: [f64; 2] = [1e5, 1.5e6];
const OWN: f64 = 10.0;

/// A task, if the file carries answers.
pub(super) fn tasks(subject: &Subject) -> Vec<Task> {
    if subject.desc.expect.is_empty() {
        return Vec::new();
    }
    let subject = subject.clone();
    vec![Task::new(TOPIC, "answers of the file", move |trial, found| {
        let others = trial.work(RAYS[0], RAYS[1]);
        let effort = Effort { aim: AIM, own: OWN * others, others };
        checks(&subject.desc, &subject.scene, effort, trial, found);
    })]
}
