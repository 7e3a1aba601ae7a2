//! Materials (glTF 2.0, section 3.9), the UV sets that they look at, and KHR_materials_variants: which a primitive has.

use super::texture::TextureUse;
use super::{Reader, Source};
use crate::desc::{
    Alpha, ColorParam, Emission, Error, Interior, Layers, Material, MetallicRoughness, Model, NormalMap, ScalarParam,
    Sides, TextureRef,
};
use gltf::json;
use json::material::AlphaMode;
use json::mesh::Primitive;
use json::validation::Checked;
use serde::Deserialize;
use serde_json::Value;

/// Channels of textures.
const R: usize = 0;
const G: usize = 1;
const B: usize = 2;
const A: usize = 3;

impl Reader<'_> {
    /// The material `index`, which `place` refers to, or the default one.
    pub(super) fn material(&mut self, index: Option<usize>, place: &str) -> Result<usize, Error> {
        if let Some(material) = self.materials.get(&index) {
            return Ok(*material);
        }
        let default = json::Material::default();
        let (material, name, place) = match index {
            Some(i) => {
                let material = self.source.get(&self.source.root.materials, i, "material", place)?;
                (material, material.name.clone().unwrap_or_else(|| format!("material {i}")), format!("/materials/{i}"))
            }
            None => (&default, "default".to_owned(), String::new()),
        };
        self.uv_sets = UvSets::default();
        let material = self.convert(material, name, &place)?;
        self.scene.materials.push(material);
        let number = self.scene.materials.len() - 1;
        self.uv_sets_of.insert(number, self.uv_sets.numbers());
        self.materials.insert(index, number);
        Ok(number)
    }

    fn convert(&mut self, m: &json::Material, name: String, place: &str) -> Result<Material, Error> {
        let pbr = &m.pbr_metallic_roughness;
        let at = |key: &str| format!("{place}/pbrMetallicRoughness/{key}");

        // Base colour and coverage share factor and texture.
        let factor = self.units(pbr.base_color_factor.0, &at("baseColorFactor"))?;
        let texture = self.core_texture(pbr.base_color_texture.as_ref(), true, &at("baseColorTexture"))?;
        let base_color = ColorParam { factor: [factor[R], factor[G], factor[B]], texture, vertex_color: true };
        let coverage = ScalarParam { factor: factor[A], texture: texture.map(|t| (t, A)) };
        let unlit = self.open("KHR_materials_unlit", place)?.is_some();
        let gloss = if unlit { None } else { self.specular_glossiness(place)? };
        let coverage = gloss.as_ref().map_or(coverage, |(_, coverage)| *coverage);
        let alpha = match m.alpha_mode {
            Checked::Valid(AlphaMode::Opaque) => Alpha::Opaque,
            Checked::Valid(AlphaMode::Blend) => Alpha::Blend { coverage },
            Checked::Valid(AlphaMode::Mask) => {
                let cutoff = m.alpha_cutoff.unwrap_or_default().0;
                Alpha::Mask { coverage, cutoff: self.finite(cutoff, &format!("{place}/alphaCutoff"))? }
            }
            Checked::Invalid => {
                let message = "is no alpha mode; expected \"OPAQUE\", \"MASK\" or \"BLEND\"";
                return Err(self.source.invalid(format!("{place}/alphaMode"), message));
            }
        };
        let (interior, double_sided) = (Interior::default(), m.double_sided);
        let surface =
            |model, emission| Material { name, model, emission, normal_map: None, alpha, interior, double_sided };

        // KHR_materials_unlit: the base colour as it is, whatever the light.
        if unlit {
            self.notes.at(
                place,
                "`KHR_materials_unlit`: the material emits its base colour on both sides and reflects nothing",
            );
            let emission = Emission { radiance: base_color, sides: Sides::Both, coat: None };
            return Ok(surface(Model::Absorb, Some(emission)));
        }

        // Roughness is in G, metalness in B of one texture.
        let metallic = self.unit(pbr.metallic_factor.0, &at("metallicFactor"))?;
        let roughness = self.unit(pbr.roughness_factor.0, &at("roughnessFactor"))?;
        let texture =
            self.core_texture(pbr.metallic_roughness_texture.as_ref(), false, &at("metallicRoughnessTexture"))?;
        let channel = |factor, channel| ScalarParam { factor, texture: texture.map(|t| (t, channel)) };
        let interior = self.interior(place)?;
        let ior = self.ior(place)?;
        let (specular, specular_color) = self.specular(place)?;
        let model = Model::MetallicRoughness(Box::new(MetallicRoughness {
            base_color,
            metallic: channel(metallic, B),
            roughness: channel(roughness, G),
            ior,
            specular,
            specular_color,
            transmission: self.transmission(place)?,
            layers: Layers {
                anisotropy: self.anisotropy(place)?,
                sheen: self.sheen(place)?,
                clearcoat: self.clearcoat(place)?,
            },
            diffuse_transmission: self.diffuse_transmission(place)?,
            iridescence: self.iridescence(place)?,
        }));
        let model = gloss.map_or(model, |(m, _)| Model::SpecularGlossiness(Box::new(m)));
        if m.occlusion_texture.is_some() {
            self.notes.at(place, "occlusion textures are ignored: light transport finds what is occluded");
        }
        let coat = match &model {
            Model::MetallicRoughness(m) => m.layers.clearcoat.map(|coat| coat.factor),
            _ => None,
        };
        let emission = self.emission(m, place)?.map(|emission| Emission { coat, ..emission });
        let normal_map = self.normal_map(m.normal_texture.as_ref(), &format!("{place}/normalTexture"))?;
        Ok(Material { normal_map, interior, ..surface(model, emission) })
    }

    /// Le = factor × texture × KHR_materials_emissive_strength; `None` where that is black.
    fn emission(&mut self, m: &json::Material, place: &str) -> Result<Option<Emission>, Error> {
        let strength = self.emissive_strength(place)?;
        let mut factor = m.emissive_factor.0;
        for x in &mut factor {
            let at = format!("{place}/emissiveFactor");
            *x = self.clamped(*x, 0.0, f32::INFINITY, &at)?;
            *x = self.finite(*x * strength, &at)?;
        }
        if factor == [0.0; 3] {
            return Ok(None);
        }
        let texture = self.core_texture(m.emissive_texture.as_ref(), true, &format!("{place}/emissiveTexture"))?;
        let sides = if m.double_sided { Sides::Both } else { Sides::Front };
        Ok(Some(Emission { radiance: ColorParam { factor, texture, vertex_color: false }, sides, coat: None }))
    }

    fn normal_map(
        &mut self,
        map: Option<&json::material::NormalTexture>,
        place: &str,
    ) -> Result<Option<NormalMap>, Error> {
        let Some(map) = map else { return Ok(None) };
        let scale = self.finite(map.scale, &format!("{place}/scale"))?;
        let used = TextureUse::of_normals(map, self.source, place)?;
        let texture = self.texture(used, false, place)?;
        Ok(texture.map(|texture| NormalMap { texture, scale }))
    }

    /// Numbers in [0, 1].
    fn units<const N: usize>(&mut self, mut xs: [f32; N], place: &str) -> Result<[f32; N], Error> {
        for x in &mut xs {
            *x = self.unit(*x, place)?;
        }
        Ok(xs)
    }
}

/// Whose UV the tangents are for that a material needs: its normal map's, else that of what lies over or stretches it.
pub(super) fn tangent_map(m: &Material) -> Option<TextureRef> {
    let layers = match &m.model {
        Model::MetallicRoughness(p) => p.layers.tangent_map(),
        _ => None,
    };
    m.normal_map.map(|map| map.texture).or(layers)
}

/// Which of the two UV sets of a mesh the textures of a material look at.
pub(super) fn uv_sets(m: &Material) -> [bool; 2] {
    let mut used = [false; 2];
    m.textures().iter().for_each(|t| used[t.uv_set] = true);
    used
}

/// The sets of the file that the textures of one material look at, by their place in [`Mesh::uv`](crate::desc::Mesh).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct UvSets([Option<u32>; 2]);

impl UvSets {
    /// The place of TEXCOORD_`set`, which is given one if need be: 0 and 1 their own where it is free. `None` where two
    /// other sets have both.
    pub(super) fn place(&mut self, set: u32) -> Option<usize> {
        let own = set.min(1) as usize;
        let places = [own, 1 - own];
        let known = places.into_iter().find(|p| self.0[*p] == Some(set));
        let place = known.or_else(|| places.into_iter().find(|p| self.0[*p].is_none()))?;
        self.0[place] = Some(set);
        Some(place)
    }

    /// n of the TEXCOORD_n at both places; 0 and 1 where no texture asks for another.
    pub(super) fn numbers(self) -> [u32; 2] {
        [self.0[0].unwrap_or(0), self.0[1].unwrap_or(1)]
    }
}

/// The extension of variants.
const VARIANTS: &str = "KHR_materials_variants";

/// What a primitive says of variants.
#[derive(Deserialize)]
struct Mappings {
    mappings: Vec<Mapping>,
}

#[derive(Deserialize)]
struct Mapping {
    material: usize,
    variants: Vec<usize>,
}

/// The names of all variants.
pub(super) fn variants<'a>(source: Source<'a>) -> Result<Vec<&'a str>, Error> {
    let place = format!("/extensions/{VARIANTS}/variants");
    let Some(list) = source.json.pointer(&place) else { return Ok(Vec::new()) };
    let Some(list) = list.as_array() else { return Err(source.invalid(place, "is no list of variants")) };
    let name = |(i, variant): (usize, &'a Value)| {
        let missing = || source.invalid(format!("{place}/{i}/name"), "is missing; expected the name of a variant");
        variant.get("name").and_then(Value::as_str).ok_or_else(missing)
    };
    list.iter().enumerate().map(name).collect()
}

impl Reader<'_> {
    /// The material of the primitive at `place` under the chosen variant, and what refers to it.
    pub(super) fn chosen_material(&self, primitive: &Primitive, place: &str) -> Result<(Option<usize>, String), Error> {
        let own = || (primitive.material.map(|m| m.value()), format!("{place}/material"));
        let Some(variant) = self.variant else { return Ok(own()) };
        let others = primitive.extensions.as_ref().map(|e| &e.others);
        let Some(Mappings { mappings }) = self.source.extension(others, VARIANTS, place)? else { return Ok(own()) };
        let mapping = mappings.iter().enumerate().find(|(_, m)| m.variants.contains(&variant));
        let at = |i: usize| format!("{place}/extensions/{VARIANTS}/mappings/{i}/material");
        Ok(mapping.map_or_else(own, |(i, m)| (Some(m.material), at(i))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn two_sets_of_any_number() {
        let of = |asked: &[u32]| {
            let mut sets = UvSets::default();
            (asked.iter().map(|set| sets.place(*set)).collect::<Vec<_>>(), sets.numbers())
        };
        assert_eq!(of(&[]), (vec![], [0, 1]));
        assert_eq!(of(&[1, 0, 1]), (vec![Some(1), Some(0), Some(1)], [0, 1]));
        assert_eq!(of(&[5, 0, 5]), (vec![Some(1), Some(0), Some(1)], [0, 5]));
        assert_eq!(of(&[5, 1, 5]), (vec![Some(1), Some(0), Some(1)], [1, 5]));
        assert_eq!(of(&[7, 5, 0]), (vec![Some(1), Some(0), None], [5, 7]));
        assert_eq!(of(&[u32::MAX]), (vec![Some(1)], [0, u32::MAX]));
    }
}
