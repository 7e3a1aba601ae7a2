//! A specimen of every model and of every extension of glTF's, for whoever must meet them all: random scenes, writers,
//! tests. Their numbers are only examples: [`Material::visit`](super::Material::visit) says where each may lie.

use super::{
    Anisotropy, Clearcoat, ColorParam, DiffuseTransmission, Fresnel, Iridescence, MetallicRoughness, Model, Roughness,
    ScalarParam, Sheen, SpecularGlossiness, Transmission,
};

/// At least one model of every [kind](Model::KINDS), and one of every form that its parameters can take, extensions of
/// glTF's apart.
pub fn models() -> Vec<Model> {
    let color = ColorParam::constant([0.7, 0.5, 0.3]);
    let number = ScalarParam::constant;
    let rough = || Roughness::Perceptual(number(0.4));
    let stretched = || Roughness::Alpha([0.1, 0.3]);
    let schlick = || Fresnel::Schlick { f0: color };
    let gold = || Fresnel::Complex { eta: [0.14, 0.38, 1.45], k: [3.98, 2.39, 1.77] };
    vec![
        Model::Absorb,
        Model::Diffuse { reflectance: color },
        Model::RoughDiffuse { reflectance: color, roughness: number(0.5) },
        Model::Phong { reflectance: color, exponent: 20.0 },
        Model::Mirror { reflectance: color },
        Model::Dielectric { ior: 1.5, roughness: rough(), tint: color },
        Model::Dielectric { ior: 1.5, roughness: stretched(), tint: color },
        Model::Conductor { fresnel: schlick(), roughness: rough() },
        Model::Conductor { fresnel: gold(), roughness: stretched() },
        Model::CookTorrance { fresnel: schlick(), roughness: rough() },
        Model::CookTorrance { fresnel: gold(), roughness: stretched() },
        Model::Mix(vec![
            (0.5, Model::Diffuse { reflectance: color }),
            (0.4, Model::Conductor { fresnel: gold(), roughness: rough() }),
        ]),
        Model::MetallicRoughness(Box::new(MetallicRoughness { roughness: number(0.4), ..Default::default() })),
        Model::SpecularGlossiness(Box::new(SpecularGlossiness {
            diffuse: color,
            specular: ColorParam::constant([0.1, 0.2, 0.3]),
            glossiness: number(0.6),
        })),
    ]
}

/// An extension of glTF's to the metallic-roughness model.
#[derive(Clone, Copy, Debug)]
pub struct Extension {
    /// Its name in glTF.
    pub name: &'static str,
    /// Adds it with all of its parameters.
    pub add: fn(&mut MetallicRoughness),
}

/// Every extension that adds parameters to the metallic-roughness model; any of them may meet on one material.
/// KHR_materials_volume makes what is transmitted enter a volume, and does nothing without a transmission.
pub const EXTENSIONS: &[Extension] = &[
    Extension {
        name: "KHR_materials_specular",
        add: |m| {
            m.specular.factor = 0.7;
            m.specular_color.factor = [0.9, 0.8, 0.7];
        },
    },
    Extension { name: "KHR_materials_ior", add: |m| m.ior = 1.8 },
    Extension {
        name: "KHR_materials_anisotropy",
        add: |m| {
            let strength = ScalarParam::constant(0.6);
            m.layers.anisotropy = Some(Anisotropy { strength, rotation: 0.5, direction: None });
        },
    },
    Extension {
        name: "KHR_materials_sheen",
        add: |m| {
            let (color, roughness) = (ColorParam::constant([0.5, 0.4, 0.6]), ScalarParam::constant(0.3));
            m.layers.sheen = Some(Sheen { color, roughness });
        },
    },
    Extension {
        name: "KHR_materials_clearcoat",
        add: |m| {
            let (factor, roughness) = (ScalarParam::constant(0.8), ScalarParam::constant(0.1));
            m.layers.clearcoat = Some(Clearcoat { factor, roughness, normal_map: None });
        },
    },
    Extension {
        name: "KHR_materials_transmission",
        add: |m| m.transmission = Some(Transmission { factor: ScalarParam::constant(0.7), thin: true }),
    },
    Extension {
        name: "KHR_materials_diffuse_transmission",
        add: |m| {
            let (factor, color) = (ScalarParam::constant(0.4), ColorParam::constant([0.6, 0.7, 0.8]));
            m.diffuse_transmission = Some(DiffuseTransmission { factor, color, thin: true });
        },
    },
    Extension {
        name: "KHR_materials_volume",
        add: |m| {
            m.transmission.iter_mut().for_each(|t| t.thin = false);
            m.diffuse_transmission.iter_mut().for_each(|t| t.thin = false);
        },
    },
    Extension {
        name: "KHR_materials_iridescence",
        add: |m| {
            let factor = ScalarParam::constant(0.9);
            m.iridescence = Some(Iridescence { factor, ior: 1.3, thickness: [100.0, 400.0], thickness_texture: None });
        },
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::desc::parameter::Value;
    use crate::desc::{Alpha, Emission, Material, NormalMap, Sides, TextureRef};

    /// A material of the model with all that can stand beside one, and all extensions.
    fn full(model: Model) -> Material {
        let mut material = Material::new("full", model);
        if let Model::MetallicRoughness(m) = &mut material.model {
            EXTENSIONS.iter().for_each(|extension| (extension.add)(m));
        }
        let coat = Some(ScalarParam::constant(0.5));
        material.emission = Some(Emission { radiance: ColorParam::constant([1.0; 3]), sides: Sides::Both, coat });
        material.alpha = Alpha::Mask { coverage: ScalarParam::constant(0.5), cutoff: 0.5 };
        material
    }

    #[test]
    fn every_kind_has_a_specimen() {
        for kind in Model::KINDS {
            assert!(models().iter().any(|m| m.kind() == *kind), "{kind}");
        }
    }

    #[test]
    fn every_extension_adds_to_the_plain_model() {
        let through = |m: &mut MetallicRoughness| {
            let ordinary = |e: &&Extension| e.name.ends_with("transmission");
            EXTENSIONS.iter().filter(ordinary).for_each(|e| (e.add)(m));
        };
        for extension in EXTENSIONS {
            let mut plain = MetallicRoughness::default();
            // A volume has nothing to fill without what enters it.
            if extension.name == "KHR_materials_volume" {
                through(&mut plain);
            }
            let mut extended = plain.clone();
            (extension.add)(&mut extended);
            assert_ne!(plain, extended, "{}", extension.name);
        }
    }

    /// As many textures are visited as `Debug` shows, where every parameter that can have one has one.
    #[test]
    fn every_texture_is_visited() {
        let texture = TextureRef { texture: 3, uv_set: 0, transform: glam::Affine2::IDENTITY };
        for model in models() {
            let mut material = full(model);
            material.visit(&mut |parameter| match parameter.value {
                Value::Color(color) => color.texture = Some(texture),
                Value::Scalar(scalar) => scalar.texture = Some((texture, 1)),
                Value::Between(between) => *between = Some((texture, 2)),
                Value::Directions(directions) => *directions = Some(texture),
                Value::Normals(map) => *map = Some(NormalMap { texture, scale: 1.0 }),
                Value::Rgb(_) | Value::Number(_) => {}
            });
            let shown = format!("{material:?}");
            assert_eq!(material.textures().len(), shown.matches("TextureRef {").count(), "{shown}");
            // None is left that could have one: `None` stands for textures and maps alone.
            assert!(!shown.contains("texture: None") && !shown.contains("map: None"), "{shown}");
        }
    }

    /// Every number that `Debug` shows is visited: set to one that occurs nowhere else, no other is left.
    #[test]
    fn every_number_is_visited() {
        for model in models() {
            let mut material = full(model);
            material.visit(&mut |mut parameter| parameter.value.factors().fill(77.0));
            let shown = format!("{:?} {:?} {:?}", material.model, material.emission, material.alpha);
            let mut words = shown.split(|c: char| !c.is_alphanumeric() && c != '.');
            assert!(words.all(|w| w == "77.0" || !w.starts_with(|c: char| c.is_ascii_digit())), "{shown}");
        }
    }

    #[test]
    fn specimens_and_usual_numbers_lie_within_bounds() {
        for model in models() {
            full(model).visit(&mut |mut parameter| {
                let bounds = parameter.bounds;
                assert!(bounds.usual.iter().all(|x| bounds.contain(*x)), "{}", parameter.name);
                assert!(bounds.contain(parameter.default), "{}", parameter.name);
                assert!(parameter.value.factors().iter().all(|x| bounds.contain(*x)), "{}", parameter.name);
            });
        }
    }

    #[test]
    fn names_are_unique_but_in_mixtures() {
        for model in models().into_iter().filter(|m| !matches!(m, Model::Mix(_))) {
            let mut names = Vec::new();
            full(model).visit(&mut |parameter| names.push(parameter.name));
            let all = names.len();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), all, "{names:?}");
        }
    }
}
