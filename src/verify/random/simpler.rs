//! Materials with one thing less.

use crate::desc::{
    Alpha, ColorParam, Emission, Material, MetallicRoughness, Model, ScalarParam, Sides, parameter::Value,
};

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
