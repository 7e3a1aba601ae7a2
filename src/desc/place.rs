//! Scenes inside scenes.

use super::{Alpha, ColorParam, Fresnel, Light, Material, Model, Object, Roughness, ScalarParam, Scene, Texture};
use glam::Mat4;

/// Appends what a scene has to another's lists, except cameras, environment and settings, and returns its objects and
/// lights, which the caller places.
pub(crate) fn append(scene: &mut Scene, mut part: Scene) -> (Vec<Object>, Vec<Light>) {
    let (shapes, materials) = (scene.shapes.len(), scene.materials.len());
    let (textures, images) = (scene.textures.len(), scene.images.len());
    for object in &mut part.objects {
        object.shape += shapes;
        object.material += materials;
        if let Some(emission) = &mut object.emission {
            color(&mut emission.radiance, textures);
        }
    }
    for material in &mut part.materials {
        shift(material, textures);
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

/// Adds `by` to every texture index of a material.
fn shift(material: &mut Material, by: usize) {
    if let Some(emission) = &mut material.emission {
        color(&mut emission.radiance, by);
    }
    if let Some(map) = &mut material.normal_map {
        map.texture.texture += by;
    }
    if let Alpha::Mask { coverage, .. } | Alpha::Blend { coverage } = &mut material.alpha {
        scalar(coverage, by);
    }
    model(&mut material.model, by);
}

fn model(m: &mut Model, by: usize) {
    match m {
        Model::Diffuse { reflectance } | Model::Mirror { reflectance } | Model::Phong { reflectance, exponent: _ } => {
            color(reflectance, by);
        }
        Model::RoughDiffuse { reflectance, roughness } => {
            color(reflectance, by);
            scalar(roughness, by);
        }
        Model::Dielectric { ior: _, roughness: r, tint } => {
            roughness(r, by);
            color(tint, by);
        }
        Model::Conductor { fresnel, roughness: r } | Model::CookTorrance { fresnel, roughness: r } => {
            roughness(r, by);
            if let Fresnel::Schlick { f0 } = fresnel {
                color(f0, by);
            }
        }
        Model::Mix(parts) => parts.iter_mut().for_each(|(_, part)| model(part, by)),
        Model::MetallicRoughness(m) => {
            color(&mut m.base_color, by);
            color(&mut m.specular_color, by);
            for s in [&mut m.metallic, &mut m.roughness, &mut m.specular] {
                scalar(s, by);
            }
            if let Some(transmission) = &mut m.transmission {
                scalar(&mut transmission.factor, by);
            }
            if let Some(through) = &mut m.diffuse_transmission {
                scalar(&mut through.factor, by);
                color(&mut through.color, by);
            }
            if let Some(film) = &mut m.iridescence {
                scalar(&mut film.factor, by);
                if let Some((texture, _)) = &mut film.thickness_texture {
                    texture.texture += by;
                }
            }
        }
        Model::SpecularGlossiness(m) => {
            color(&mut m.diffuse, by);
            color(&mut m.specular, by);
            scalar(&mut m.glossiness, by);
        }
        Model::Absorb => {}
    }
}

fn color(c: &mut ColorParam, by: usize) {
    if let Some(texture) = &mut c.texture {
        texture.texture += by;
    }
}

fn scalar(s: &mut ScalarParam, by: usize) {
    if let Some((texture, _)) = &mut s.texture {
        texture.texture += by;
    }
}

fn roughness(r: &mut Roughness, by: usize) {
    if let Roughness::Perceptual(s) | Roughness::Glossiness(s) = r {
        scalar(s, by);
    }
}
