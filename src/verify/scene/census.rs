//! Samples that are NaN, infinite or negative: of radiance, or of what the film keeps of the first surface.

use super::Subject;
use super::view::{Budget, View, camera_name};
use crate::desc::Strategy;
use crate::render::{Output, Settings};
use crate::verify::{Findings, Task, Topic, Trial};

const TOPIC: Topic = Topic {
    id: "census",
    title: "no sample is NaN, infinite or negative",
    source: "rule: such samples are counted, located and reported, never dropped",
};

/// Rays of an image.
const RAYS: [u64; 2] = [8_000_000, 120_000_000];

/// Most samples that are named one by one.
const NAMED: usize = 10;

/// An image by each camera; in the default size by the first alone.
pub(super) fn tasks(subject: &Subject) -> Vec<Task> {
    let cameras = subject.scene.cameras.len().min(4);
    let task = |camera: usize| {
        let subject = subject.clone();
        Task::new(TOPIC, camera_name(&subject.scene, camera), move |trial, found| {
            if camera > 0 && trial.pick(true, false) {
                found.words.push("left out of the default size".into());
                return;
            }
            count(&subject, camera, trial, found);
        })
    };
    (0..cameras).map(task).collect()
}

fn count(subject: &Subject, camera: usize, trial: &Trial, found: &mut Findings) {
    let view = View { camera, budget: Budget::of(trial, RAYS), strategy: Strategy::Mis };
    let settings = view.settings(&subject.scene);
    let output = settings.and_then(|s| View::render(&subject.scene, &s).map(|o| (s, o)));
    let (settings, output) = match output {
        Ok(rendered) => rendered,
        Err(e) => {
            found.words.push(format!("no image: {e}"));
            return found.checks.holds("an image is made", false);
        }
    };
    let [w, h] = settings.size;
    let samples = u64::from(w) * u64::from(h) * u64::from(output.samples_per_pixel);
    found.checks.holds("every sample is finite and not negative", output.bad_count == 0);
    found.words.push(match output.bad_count {
        0 => format!("{samples} samples: none is NaN, infinite or negative"),
        n => format!("{n} of {samples} samples hold what is no number and counts as 0; the first are replayed by"),
    });
    found.words.extend(replays(subject, &settings, &output));
}

/// Commands that replay the first bad samples.
fn replays(subject: &Subject, settings: &Settings, output: &Output) -> Vec<String> {
    let file = subject.desc.source.as_ref().map_or("SCENE".into(), |path| path.display().to_string());
    let [w, h] = settings.size;
    let common = format!(
        "radianza render {file} --camera {} --size {w}x{h} --spp {} --replicate {} --seed {} --sampler lattice \
         --integrator path --strategy mis --filter box",
        settings.camera, settings.spp, settings.replicate, settings.seed
    );
    let one = |bad: &crate::render::BadSample| {
        let [x, y] = bad.pixel;
        format!("`{common} --replay {x},{y},{}`: {} {:?}", bad.index, bad.invalid.layer, bad.invalid.value)
    };
    output.bad.iter().take(NAMED).map(one).collect()
}
