//! The smallest scene that still fails: edits that make a scene simpler are kept where it fails all the same, until none is
//! left (Zeller & Hildebrandt 2002, "Simplifying and Isolating Failure-Inducing Input").

use super::judge::{Aspect, least_of_kind, look};
use super::prune::prune;
use super::{FAILS, simpler};
use crate::desc::{Mesh, Object, Projection, Scene, Shape};
use glam::Mat4;
use std::sync::Arc;

/// Most looks that are spent on one scene.
const LOOKS: usize = 120;

/// Shrinks a scene of whose `aspect` the check `kind` fails with so many rays an image: to one of which it fails too, not
/// another that an edit has broken.
pub(super) fn shrink(mut scene: Scene, aspect: Aspect, kind: &str, rays: u64, seed: u64) -> Scene {
    let fails = |scene: &Scene, rays: u64| least_of_kind(look(scene, aspect, rays, seed).checks.checks(), kind) < FAILS;
    // What is far off is seen with fewer rays.
    let rays = [rays / 64, rays / 8].into_iter().find(|fewer| fails(&scene, *fewer)).unwrap_or(rays);
    let mut looks = 0;
    loop {
        let next = candidates(&scene).into_iter().find(|candidate| {
            looks += 1;
            looks <= LOOKS && fails(candidate, rays)
        });
        match next {
            Some(smaller) => scene = prune(&smaller),
            None => return scene,
        }
    }
}

/// The scene, each time with one thing less; the largest things first.
pub(super) fn candidates(scene: &Scene) -> Vec<Scene> {
    let mut candidates = Vec::new();
    let mut edit = |change: &dyn Fn(&mut Scene)| {
        let mut edited = scene.clone();
        change(&mut edited);
        if edited != *scene {
            candidates.push(edited);
        }
    };
    (0..scene.objects.len()).for_each(|i| edit(&|s| drop(s.objects.remove(i))));
    (0..scene.lights.len()).for_each(|i| edit(&|s| drop(s.lights.remove(i))));
    edit(&|s| s.environment = None);
    for i in 0..scene.materials.len() {
        for model in simpler::models(&scene.materials[i].model) {
            edit(&|s| s.materials[i].model = model.clone());
        }
        edit(&|s| s.materials[i].emission = None);
        edit(&|s| s.materials[i].normal_map = None);
        edit(&|s| s.materials[i].interior = Default::default());
        edit(&|s| s.materials[i].alpha = crate::desc::Alpha::Opaque);
        edit(&|s| s.materials[i].alpha = simpler::alpha(&s.materials[i].alpha));
        edit(&|s| s.materials[i].emission = s.materials[i].emission.map(simpler::emission));
        edit(&|s| s.materials[i].double_sided = true);
        edit(&|s| simpler::untextured(&mut s.materials[i]));
    }
    for i in 0..scene.objects.len() {
        edit(&|s| s.objects[i].emission = None);
        edit(&|s| s.objects[i].emission = s.objects[i].emission.map(simpler::emission));
        edit(&|s| s.objects[i].reversed = false);
        edit(&|s| upright(&mut s.objects[i]));
    }
    for i in 0..scene.shapes.len() {
        let bounds = |o: &Object| o.shape == i && crate::material::interior(&scene.materials[o.material]).is_some();
        for shape in simpler::shapes(&scene.shapes[i], scene.objects.iter().any(bounds)) {
            edit(&|s| s.shapes[i] = shape.clone());
        }
        edit(&|s| bare(&mut s.shapes[i], |mesh| mesh.normals.clear()));
        edit(&|s| bare(&mut s.shapes[i], |mesh| mesh.tangents.clear()));
        edit(&|s| bare(&mut s.shapes[i], |mesh| mesh.colors.clear()));
    }
    edit(&|s| s.environment.iter_mut().for_each(|e| e.image = None));
    edit(&|s| s.cameras[0].lens = None);
    edit(&|s| {
        let fov = crate::desc::Fov::Vertical(0.7);
        s.cameras[0].projection = Projection::Perspective { fov };
    });
    candidates
}

/// Neither turned nor stretched.
fn upright(object: &mut Object) {
    object.to_world = Mat4::from_translation(object.to_world.w_axis.truncate());
}

fn bare(shape: &mut Shape, change: impl Fn(&mut Mesh)) {
    if let Shape::Mesh(mesh) = shape {
        change(Arc::make_mut(mesh));
    }
}

/// A scene as a file of its own.
pub(super) fn text(scene: &Scene) -> String {
    crate::desc::toml::to_text(scene)
}
