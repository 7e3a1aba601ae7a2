//! A scene in a furnace, and materials made lossless.

use crate::desc::{ColorParam, Emission, Environment, Fresnel, Interior, Material, Model, Scene, Shape, framing};
use glam::Mat3;
use std::sync::Arc;

/// The same material with everything that could be coloured made white, so that it scatters all that it receives:
/// reflectances, base colours and tints 1, interiors clear, mixtures filled up to 1. Roughness, metalness, indices and coverage stay as
/// they are. `None` for what absorbs whatever its parameters are.
pub(super) fn lossless(material: &Material) -> Option<Material> {
    let interior = Interior { absorption: [0.0; 3], ..material.interior };
    Some(Material { model: white(&material.model)?, emission: None, interior, ..material.clone() })
}

fn white(model: &Model) -> Option<Model> {
    const WHITE: ColorParam = ColorParam::constant([1.0; 3]);
    Some(match model {
        // Of Phong's lobe a part is below the horizon.
        Model::Absorb | Model::Phong { .. } => return None,
        Model::Diffuse { .. } => Model::Diffuse { reflectance: WHITE },
        Model::RoughDiffuse { roughness, .. } => Model::RoughDiffuse { reflectance: WHITE, roughness: *roughness },
        Model::Mirror { .. } => Model::Mirror { reflectance: WHITE },
        Model::Dielectric { ior, roughness, .. } => Model::Dielectric { ior: *ior, roughness: *roughness, tint: WHITE },
        Model::Conductor { roughness, .. } => {
            Model::Conductor { fresnel: Fresnel::Schlick { f0: WHITE }, roughness: *roughness }
        }
        Model::CookTorrance { roughness, .. } => {
            Model::CookTorrance { fresnel: Fresnel::Schlick { f0: WHITE }, roughness: *roughness }
        }
        Model::SpecularGlossiness(m) => {
            let mut m = m.clone();
            m.diffuse = WHITE;
            Model::SpecularGlossiness(m)
        }
        Model::MetallicRoughness(m) => {
            let mut m = m.clone();
            m.base_color = WHITE;
            (m.layers.sheen, m.layers.clearcoat) = (None, None);
            if let Some(through) = &mut m.diffuse_transmission {
                through.color = WHITE;
            }
            // A base under a film whose fringes are too many for its series is coupled to more than the film reflects.
            m.iridescence = None;
            Model::MetallicRoughness(m)
        }
        Model::Mix(parts) => {
            let parts: Vec<_> = parts.iter().filter_map(|(weight, part)| Some((*weight, white(part)?))).collect();
            let sum: f32 = parts.iter().map(|(weight, _)| weight).sum();
            if parts.is_empty() || sum.is_nan() || sum <= 0.0 {
                return None;
            }
            Model::Mix(parts.into_iter().map(|(weight, part)| (weight / sum, part)).collect())
        }
    })
}

/// What a scene is made before it is put into a furnace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Dress {
    /// Nothing.
    Written,
    /// Every material is [`lossless`] that can be.
    White,
    /// The same, and shading normals are those of the triangles.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mixtures_are_filled_up() {
        let grey = ColorParam::constant([0.5; 3]);
        let mix = Model::Mix(vec![
            (0.2, Model::Diffuse { reflectance: grey }),
            (0.3, Model::Mirror { reflectance: grey }),
            (0.5, Model::Absorb),
        ]);
        let Some(Model::Mix(parts)) = white(&mix) else { panic!("a mixture stays one") };
        assert_eq!(parts.iter().map(|(w, _)| *w).collect::<Vec<_>>(), [0.4, 0.6]);
        assert_eq!(parts[0].1, Model::Diffuse { reflectance: ColorParam::constant([1.0; 3]) });
        assert_eq!(white(&Model::Mix(vec![(1.0, Model::Absorb)])), None);
    }
}
