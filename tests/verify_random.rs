//! Random scenes: what they hold, and what was once found with them.

use radianza::scene::Scene;
use radianza::verify::random::{Pair, lawful_pairs, may_meet, scene};
use radianza::verify::{self, Size};
use std::collections::BTreeSet;

/// Scenes in which all pairs meet.
const ENOUGH: u64 = 600;

#[test]
fn a_scene_is_a_function_of_seed_and_index() {
    for index in 0..20 {
        assert_eq!(scene(3, index), scene(3, index));
    }
    assert_ne!(scene(3, 1), scene(3, 2));
    assert_ne!(scene(3, 1), scene(4, 1));
}

#[test]
fn every_pair_of_features_meets() {
    let mut met: BTreeSet<Pair> = BTreeSet::new();
    let mut scenes = 0;
    let lawful = lawful_pairs();
    while scenes < ENOUGH {
        met.extend(scene(0, scenes).1.pairs());
        scenes += 1;
    }
    let missing: Vec<_> = lawful.difference(&met).map(|(a, b)| format!("{} × {}", a.name(), b.name())).collect();
    let unlawful: Vec<_> = met.iter().filter(|(a, b)| !may_meet(*a, *b)).collect();
    assert!(unlawful.is_empty(), "{unlawful:?}");
    assert!(missing.is_empty(), "{} of {} pairs: {missing:#?}", missing.len(), lawful.len());
}

#[test]
fn every_scene_is_lawful() {
    for index in 0..12 {
        let (desc, _) = scene(0, index);
        let compiled = Scene::compile(&desc).unwrap_or_else(|e| panic!("scene {index}: {e}"));
        assert!(compiled.info().lights > 0, "scene {index} is dark");
        let tasks = verify::scene::tasks(&desc.into(), &compiled.into());
        let data: Vec<_> = tasks.into_iter().filter(|task| task.topic.id == "data").collect();
        let report = verify::run(&data, Size::Quick, 1, 1e-4, &|_| {});
        assert!(report.passes(), "scene {index}: {report:#?}");
        let odd: Vec<_> = report.sections.iter().flat_map(|s| &s.words).filter(|w| !w.starts_with("every")).collect();
        assert!(odd.is_empty(), "scene {index}: {odd:?}");
    }
}
