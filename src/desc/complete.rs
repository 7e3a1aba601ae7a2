//! What a scene needs to be seen at all: a camera and a light.

use super::frame_camera::framing;
use super::{Emission, Environment, Scene};
use glam::Mat3;

/// The note on a scene that was given a light.
pub const NO_LIGHT: &str = "there is no light: a uniform environment of radiance 1 was added";

/// Frames a scene that has no camera, and gives one without any light a uniform environment of radiance 1. The notes
/// say so.
pub fn complete(scene: &mut Scene) {
    if scene.cameras.is_empty() {
        scene.cameras.push(framing(scene));
        scene.notes.push("there is no camera: the whole scene is framed".into());
    }
    if !is_lit(scene) {
        scene.environment = Some(Environment { radiance: [1.0; 3], image: None, to_world: Mat3::IDENTITY });
        scene.notes.push(NO_LIGHT.into());
    }
}

/// Whether anything emits.
fn is_lit(scene: &Scene) -> bool {
    let positive = |rgb: &[f32; 3]| rgb.iter().any(|x| *x > 0.0);
    let emits = |e: &Option<Emission>| e.is_some_and(|e| positive(&e.radiance.factor));
    let material = |index: usize| scene.materials.get(index).is_some_and(|m| emits(&m.emission));
    !scene.lights.is_empty()
        || scene.environment.as_ref().is_some_and(|e| positive(&e.radiance))
        || scene.objects.iter().any(|o| if o.emission.is_some() { emits(&o.emission) } else { material(o.material) })
}
