//! Hosts that render several scenes in one pool of threads.

mod common;

use common::{film, settings};
use radianza::desc::toml;
use radianza::scene::Scene;
use std::path::Path;
use std::sync::mpsc;
use std::time::Duration;

/// Materials whose energies are tabulated when they are first asked for: sheen, two roughnesses, metals, rough glass.
const SCENE: &str = r#"
    [camera]
    position = [0, 0, 4]
    target = [0, 0, 0]
    view_angle = 40
    resolution = [8, 8]
    [environment]
    radiance = 1
    [material.cloth]
    type = "metallic-roughness"
    base_color = [0.5, 0.5, 0.5]
    metallic = 0
    roughness = 0.7
    sheen_color = [1, 1, 1]
    sheen_roughness = 0.6
    anisotropy = 0.6
    clearcoat = 1
    clearcoat_roughness = 0.3
    [material.metal]
    type = "conductor"
    metal = "Au"
    alpha = [0.3, 0.1]
    [material.glass]
    type = "dielectric"
    ior = 1.5
    roughness = 0.4
    [[shape]]
    type = "sphere"
    center = [-1, 0, 0]
    radius = 0.6
    material = "cloth"
    [[shape]]
    type = "sphere"
    center = [1, 0, 0]
    radius = 0.6
    material = "metal"
    [[shape]]
    type = "sphere"
    center = [0, 1, 0]
    radius = 0.4
    material = "glass"
"#;

/// A thread of the pool that waits for others while it holds what those wait for would never come back. The test is alone
/// in its program, so that nothing is tabulated when it begins.
#[test]
fn scenes_in_one_pool_do_not_wait_for_each_other() {
    let (done, result) = mpsc::channel();
    std::thread::spawn(move || {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        let render = || {
            let desc = toml::parse(SCENE, Path::new("pool.toml")).unwrap_or_else(|e| panic!("{e}"));
            film(&Scene::compile(&desc).unwrap_or_else(|e| panic!("{e}")), &settings([8, 8]))
        };
        let ((a, b), (c, d)) =
            pool.install(|| rayon::join(|| rayon::join(render, render), || rayon::join(render, render)));
        done.send(a == b && b == c && c == d).unwrap();
    });
    let same = result.recv_timeout(Duration::from_secs(300)).expect("the renders wait for each other, or one failed");
    assert!(same);
}
