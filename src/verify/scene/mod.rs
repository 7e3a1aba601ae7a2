//! A scene file under test: everything that its author may have got wrong, and everything that this crate may get
//! wrong with it.
//!
//! | topic | what must hold |
//! | --- | --- |
//! | `data` | numbers are what readers promise; what is odd but survives is said in words |
//! | `normals` | shading frames are usable; triangles against their normals are counted |
//! | `leaks` | no ray gets out of a surface that is closed |
//! | `material` | each material scatters by its density, both ways alike, no more than it receives; made white, all of it |
//! | `furnace` | in a uniform environment no pixel is brighter than it, and with everything made white none darker |
//! | `census` | no sample is NaN, infinite or negative |
//! | `agreement` | all strategies estimate one image |
//! | `expect` | the answers that the file carries |
//!
//! Defects of the data that the renderer survives are words, and their checks pass; energy out of nothing, samples that
//! are no radiance, leaks and disagreement fail.

pub(in crate::verify) mod agreement;
mod census;
mod conformance;
mod data;
mod expect;
pub(in crate::verify) mod furnace;
mod leaks;
mod material;
mod normals;
mod one_sided;
mod places;
mod surfaces;
mod topology;
pub(in crate::verify) mod view;
pub(in crate::verify) mod white;
mod worn;

pub use conformance::{Conformance, conformance};
pub use material::Albedo;

use super::Task;
use crate::desc;
use crate::scene::Scene;
use std::collections::HashMap;
use std::sync::Arc;

/// A scene as written and as traced.
#[derive(Clone)]
pub(in crate::verify) struct Subject {
    pub(in crate::verify) desc: Arc<desc::Scene>,
    pub(in crate::verify) scene: Arc<Scene>,
}

/// Every check of a scene: `desc` as written (and completed: [`desc::load`]), `scene` compiled from it. The names of the
/// tasks, and so their numbers, depend on the scene alone.
pub fn tasks(desc: &Arc<desc::Scene>, scene: &Arc<Scene>) -> Vec<Task> {
    let subject = Subject { desc: desc.clone(), scene: scene.clone() };
    let parts: [fn(&Subject) -> Vec<Task>; 8] = [
        data::tasks,
        normals::tasks,
        leaks::tasks,
        material::tasks,
        furnace::tasks,
        census::tasks,
        agreement::tasks,
        expect::tasks,
    ];
    parts.iter().flat_map(|part| part(&subject)).collect()
}

/// Names that no two of a list share: empty ones become `what NUMBER`, repeated ones get their number behind.
fn unique<'a>(names: impl Iterator<Item = &'a str>, what: &str) -> Vec<String> {
    let mut seen: HashMap<String, ()> = HashMap::new();
    let name = |(i, name): (usize, &str)| {
        let plain = if name.is_empty() { format!("{what} {i}") } else { name.to_owned() };
        let free = if seen.contains_key(&plain) { format!("{plain} #{i}") } else { plain };
        seen.insert(free.clone(), ());
        free
    };
    names.enumerate().map(name).collect()
}

/// A count with its noun: `1 triangle`, `3 triangles`, `2 meshes`.
fn count(n: usize, noun: &str) -> String {
    let plural = if noun.ends_with("sh") { "es" } else { "s" };
    if n == 1 { format!("1 {noun}") } else { format!("{n} {noun}{plural}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_made_unique() {
        assert_eq!(unique(["a", "", "a", "b"].into_iter(), "mesh"), ["a", "mesh 1", "a #2", "b"]);
    }
}
