//! How many lights a scene asks for: every triangle of an emissive mesh is one, wherever the mesh is placed.

use super::{Emission, Error, Scene, Shape};
use std::path::Path;

/// Memory that a triangle which emits takes when the scene is compiled: the light, and its part in the choice of one
/// \[bytes\].
pub(crate) const EMITTER_BYTES: usize = 512;

/// Most triangles that instances may add to those of the emissive meshes themselves: about a gigabyte of lights.
const MOST_ADDED: usize = 1 << 21;

/// Triangles that emit of a shape of this material; 0 for quadrics, which are one light each.
pub(crate) fn emitters(scene: &Scene, shape: usize, material: usize) -> usize {
    match (&scene.shapes[shape], &scene.materials[material].emission) {
        (Shape::Mesh(mesh), Some(emission)) if emission.is_light() => mesh.indices.len(),
        _ => 0,
    }
}

/// Refuses a scene whose instances multiply emissive triangles without bound, naming the object that is one too many.
pub(crate) fn check(scene: &Scene) -> Result<(), Error> {
    let mut placed = vec![false; scene.shapes.len()];
    let mut added = 0usize;
    for object in &scene.objects {
        let emission = object.emission.or(scene.materials[object.material].emission);
        let (Shape::Mesh(mesh), Some(_)) = (&scene.shapes[object.shape], emission.filter(Emission::is_light)) else {
            continue;
        };
        if std::mem::replace(&mut placed[object.shape], true) {
            added = added.saturating_add(mesh.indices.len());
        }
        if added > MOST_ADDED {
            let file = scene.source.as_deref().unwrap_or(Path::new("scene"));
            let message = format!(
                "object `{}`: instances add {added} emissive triangles to those of their meshes; expected at most \
                 {MOST_ADDED}",
                object.name
            );
            return Err(Error::invalid(file, "", message));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::desc::{ColorParam, Material, Mesh, Model, Object, Sides};

    #[test]
    fn instances_multiply_lights_within_bounds() {
        let emission = |factor| {
            let radiance = ColorParam::constant([factor; 3]);
            Some(Emission { radiance, sides: Sides::Front, coat: None })
        };
        let mesh = Mesh { indices: vec![[0, 1, 2]; 1000], ..Mesh::default() };
        let dark = Material::new("dark", Model::Absorb);
        let lamp = Object { name: "lamp".into(), emission: emission(1.0), ..Object::new(0, 0) };
        let mut scene = Scene {
            shapes: vec![Shape::Mesh(mesh.into())],
            materials: vec![dark],
            objects: vec![lamp; 1 + MOST_ADDED / 1000],
            ..Scene::default()
        };
        assert_eq!(check(&scene), Ok(()));
        scene.objects.push(scene.objects[0].clone());
        let message = "object `lamp`: instances add 2098000 emissive triangles to those of their meshes; expected at most 2097152";
        assert_eq!(check(&scene).unwrap_err().message, message);
        // What is black is no light, wherever that is said.
        scene.objects.iter_mut().for_each(|o| o.emission = emission(0.0));
        assert_eq!(check(&scene), Ok(()));
        scene.objects.iter_mut().for_each(|o| o.emission = None);
        assert_eq!((check(&scene), emitters(&scene, 0, 0)), (Ok(()), 0));
        scene.materials[0].emission = emission(1.0);
        assert!(check(&scene).is_err());
        assert_eq!(emitters(&scene, 0, 0), 1000);
    }
}
