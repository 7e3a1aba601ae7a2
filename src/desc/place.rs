//! Scenes inside scenes.

use super::parameter::Parameter;
use super::{Light, Object, Scene, Texture};
use glam::Mat4;

/// Appends what a scene has to another's lists, except cameras, environment and settings, and returns its objects and
/// lights, which the caller places.
pub(crate) fn append(scene: &mut Scene, mut part: Scene) -> (Vec<Object>, Vec<Light>) {
    let (shapes, materials) = (scene.shapes.len(), scene.materials.len());
    let (textures, images) = (scene.textures.len(), scene.images.len());
    let shift = &mut |mut parameter: Parameter| {
        if let Some(texture) = parameter.value.texture_mut() {
            texture.texture += textures;
        }
    };
    for object in &mut part.objects {
        object.shape += shapes;
        object.material += materials;
        if let Some(emission) = &mut object.emission {
            emission.visit(shift);
        }
    }
    for material in &mut part.materials {
        material.visit(shift);
    }
    for texture in &mut part.textures {
        if let Texture::Image { image, .. } = texture {
            *image += images;
        }
    }
    if part.environment.is_some() {
        part.notes.push("its environment is left out".into());
    }
    scene.shapes.append(&mut part.shapes);
    scene.materials.append(&mut part.materials);
    scene.textures.append(&mut part.textures);
    scene.images.append(&mut part.images);
    scene.notes.append(&mut part.notes);
    scene.metadata.append(&mut part.metadata);
    part.extensions.retain(|used| !scene.extensions.contains(used));
    scene.extensions.append(&mut part.extensions);
    part.variants.retain(|name| !scene.variants.contains(name));
    scene.variants.append(&mut part.variants);
    scene.duration = scene.duration.into_iter().chain(part.duration).reduce(f64::max);
    (part.objects, part.lights)
}

/// A light moved by an affine map; its intensity stays, as glTF has it.
pub(crate) fn moved(light: &Light, m: Mat4) -> Light {
    let turn = |d: glam::Vec3| m.as_dmat4().transform_vector3(d.as_dvec3()).try_normalize().map_or(d, |d| d.as_vec3());
    match light.clone() {
        Light::Point { position, intensity, range } => {
            Light::Point { position: m.transform_point3(position), intensity, range }
        }
        Light::Spot { position, direction, intensity, inner, outer, range } => {
            let (position, direction) = (m.transform_point3(position), turn(direction));
            Light::Spot { position, direction, intensity, inner, outer, range }
        }
        Light::Profile { position, to_world, intensity, profile } => {
            let to_world = super::ies::frame(turn(to_world.z_axis), turn(to_world.x_axis));
            Light::Profile { position: m.transform_point3(position), to_world, intensity, profile }
        }
        Light::Directional { direction, irradiance } => Light::Directional { direction: turn(direction), irradiance },
        Light::Sun { direction, irradiance, diameter } => {
            Light::Sun { direction: turn(direction), irradiance, diameter }
        }
    }
}
