//! A scene in a furnace, and materials made lossless.

use crate::desc::{Emission, Environment, Interior, Material, Scene, Shape, framing};
use glam::Mat3;
use std::sync::Arc;

/// A material made to scatter all that it receives: its model [lossless](crate::desc::Model::lossless), its interior clear, without
/// emission. `None` for what absorbs whatever its parameters are.
pub(in crate::verify) fn lossless(material: &Material) -> Option<Material> {
    let interior = Interior { absorption: [0.0; 3], ..material.interior };
    Some(Material { model: material.model.lossless()?, emission: None, interior, ..material.clone() })
}

/// What a scene is made before it is put into a furnace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::verify) enum Dress {
    /// Nothing.
    Written,
    /// Every material is [`lossless`] that can be.
    White,
    /// Every material is [`lossless`] that can be, and shading normals are those of the triangles.
    Flat,
}

/// The scene in a uniform environment of radiance 1, without any other light; a camera that sees everything stands
/// behind its own.
pub(super) fn furnace(scene: &Scene, dress: Dress) -> Scene {
    let mut scene = scene.clone();
    scene.lights.clear();
    scene.environment = Some(Environment { radiance: [1.0; 3], image: None, to_world: Mat3::IDENTITY });
    let nothing: Option<Emission> = None;
    scene.objects.iter_mut().for_each(|object| object.emission = nothing);
    for material in &mut scene.materials {
        material.emission = nothing;
        if let Some(white) = lossless(material).filter(|_| dress != Dress::Written) {
            *material = white;
        }
        if dress == Dress::Flat {
            material.normal_map = None;
        }
    }
    for shape in &mut scene.shapes {
        if let (Dress::Flat, Shape::Mesh(mesh)) = (dress, shape) {
            let mesh = Arc::make_mut(mesh);
            mesh.normals.clear();
            mesh.tangents.clear();
        }
    }
    let everything = framing(&scene);
    scene.cameras.push(everything);
    scene
}
