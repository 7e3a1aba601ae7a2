//! Materials and shapes with one thing less.

use crate::desc::{
    Alpha, ColorParam, Emission, Interior, Light, Material, Mesh, MetallicRoughness, Model, ScalarParam, Scene, Shape,
    Sides, parameter::Value, primitives,
};
use glam::Vec3;
use std::sync::Arc;

/// A model, each time with one thing less.
pub(super) fn models(model: &Model) -> Vec<Model> {
    let mut simpler = vec![Model::Absorb, Model::Diffuse { reflectance: ColorParam::constant([0.5; 3]) }];
    match model {
        Model::Absorb => return Vec::new(),
        Model::Diffuse { .. } => simpler.truncate(1),
        Model::Mix(parts) => simpler.extend(parts.iter().map(|(_, part)| part.clone())),
        Model::MetallicRoughness(m) => {
            let edits: [fn(&mut MetallicRoughness); 10] = [
                |m| m.layers.clearcoat = None,
                |m| m.layers.sheen = None,
                |m| m.layers.anisotropy = None,
                |m| m.iridescence = None,
                |m| m.transmission = None,
                |m| m.diffuse_transmission = None,
                |m| (m.specular, m.specular_color) = (ScalarParam::constant(1.0), ColorParam::constant([1.0; 3])),
                |m| m.metallic = ScalarParam::constant(0.0),
                |m| m.layers.clearcoat.iter_mut().for_each(|c| c.normal_map = None),
                |m| m.base_color = ColorParam::constant([1.0; 3]),
            ];
            simpler.extend(edits.map(|edit| {
                let mut m = m.clone();
                edit(&mut m);
                Model::MetallicRoughness(m)
            }));
        }
        _ => {}
    }
    simpler.retain(|other| other != model);
    simpler
}

/// Coverage by a number.
pub(super) fn alpha(alpha: &Alpha) -> Alpha {
    match alpha {
        Alpha::Opaque => Alpha::Opaque,
        Alpha::Mask { .. } | Alpha::Blend { .. } => Alpha::Blend { coverage: ScalarParam::constant(0.5) },
    }
}

/// White emission of the front.
pub(super) fn emission(_: Emission) -> Emission {
    Emission { radiance: ColorParam::constant([2.0; 3]), sides: Sides::Front, coat: None }
}

/// Textures are left out.
pub(super) fn untextured(material: &mut Material) {
    material.visit(&mut |parameter| match parameter.value {
        Value::Color(color) => color.texture = None,
        Value::Scalar(number) => number.texture = None,
        Value::Between(texture) => *texture = None,
        Value::Directions(texture) => *texture = None,
        Value::Normals(map) => *map = None,
        Value::Rgb(_) | Value::Number(_) => {}
    });
}

/// A scene, each time without one kind of thing that other renderers rarely have.
pub(super) fn plainer(scene: &Scene) -> Vec<Scene> {
    let edits: [fn(&mut Scene); 9] = [
        |s| s.lights.iter_mut().for_each(endless),
        |s| s.lights.retain(|light| !matches!(light, Light::Profile { .. })),
        |s| s.lights.retain(|light| !matches!(light, Light::Sun { .. })),
        |s| s.environment.iter_mut().for_each(|e| e.image = None),
        |s| s.materials.iter_mut().for_each(|m| m.interior = Interior::default()),
        |s| s.materials.iter_mut().for_each(|m| m.normal_map = None),
        |s| s.materials.iter_mut().for_each(untextured),
        |s| s.objects.iter_mut().filter_map(|o| o.emission.as_mut()).for_each(|e| *e = emission(*e)),
        |s| {
            s.shapes.iter_mut().for_each(|shape| {
                if let Shape::Mesh(mesh) = shape {
                    Arc::make_mut(mesh).colors.clear();
                }
            })
        },
    ];
    let edited = edits.map(|edit| {
        let mut edited = scene.clone();
        edit(&mut edited);
        edited
    });
    edited.into_iter().filter(|edited| edited != scene).collect()
}

/// Without an end of its light.
fn endless(light: &mut Light) {
    if let Light::Point { range, .. } | Light::Spot { range, .. } = light {
        *range = f32::INFINITY;
    }
}

/// Fewest triangles of a mesh that something simpler stands for.
const MANY: usize = 12;

/// What may stand for a shape: a sphere, a box; either half of its triangles where it `bounds` no volume.
pub(super) fn shapes(shape: &Shape, bounds: bool) -> Vec<Shape> {
    let Shape::Mesh(mesh) = shape else { return Vec::new() };
    let half = mesh.indices.len() / 2;
    let mut simpler = Vec::new();
    if mesh.indices.len() > MANY {
        simpler.push(Shape::Sphere { radius: 0.5 });
        simpler.push(Shape::Mesh(Arc::new(primitives::cuboid(Vec3::splat(-0.5), Vec3::splat(0.5)))));
    }
    if half > 0 && !bounds {
        simpler
            .extend([&mesh.indices[..half], &mesh.indices[half..]].map(|kept| Shape::Mesh(Arc::new(part(mesh, kept)))));
    }
    simpler
}

/// Some triangles of a mesh, with the vertices that they have.
fn part(mesh: &Mesh, triangles: &[[u32; 3]]) -> Mesh {
    let mut used: Vec<u32> = triangles.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    fn of<T: Copy>(list: &[T], used: &[u32]) -> Vec<T> {
        if list.is_empty() { Vec::new() } else { used.iter().map(|i| list[*i as usize]).collect() }
    }
    let number = |i: u32| used.binary_search(&i).map_or(0, |k| k as u32);
    Mesh {
        positions: of(&mesh.positions, &used),
        indices: triangles.iter().map(|t| t.map(number)).collect(),
        normals: of(&mesh.normals, &used),
        tangents: of(&mesh.tangents, &used),
        uv: [0, 1].map(|set| of(&mesh.uv[set], &used)),
        colors: of(&mesh.colors, &used),
    }
}
