//! Materials (glTF 2.0, section 3.9).

use super::Reader;
use super::extensions::kind;
use super::slot::Slot;
use super::uv_sets::UvSets;
use crate::desc::{
    Alpha, ColorParam, Emission, Error, Interior, Layers, Material, MetallicRoughness, Model, NormalMap, ScalarParam,
    Sides, TextureRef,
};
use gltf::json;
use json::material::AlphaMode;
use json::validation::Checked;
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
        let extensions = m.extensions.as_ref();
        let at = |key: &str| format!("{place}/pbrMetallicRoughness/{key}");

        // Base colour and coverage share factor and texture.
        let factor = self.units(pbr.base_color_factor.0, &at("baseColorFactor"))?;
        let texture = self.color_texture(pbr.base_color_texture.as_ref(), &at("baseColorTexture"))?;
        let base_color = ColorParam { factor: [factor[R], factor[G], factor[B]], texture, vertex_color: true };
        let coverage = ScalarParam { factor: factor[A], texture: texture.map(|t| (t, A)) };
        let unlit = extensions.is_some_and(|e| e.unlit.is_some());
        let gloss = if unlit { None } else { self.specular_glossiness(extensions, place)? };
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
        let texture = self.data_texture(pbr.metallic_roughness_texture.as_ref(), &at("metallicRoughnessTexture"))?;
        let channel = |factor, channel| ScalarParam { factor, texture: texture.map(|t| (t, channel)) };
        let dielectric = self.dielectric(extensions, place)?;
        let model = Model::MetallicRoughness(Box::new(MetallicRoughness {
            base_color,
            metallic: channel(metallic, B),
            roughness: channel(roughness, G),
            ior: dielectric.ior,
            specular: dielectric.specular,
            specular_color: dielectric.specular_color,
            transmission: dielectric.transmission,
            layers: Layers {
                anisotropy: self.anisotropy(extensions, place)?,
                sheen: self.sheen(extensions, place)?,
                clearcoat: self.clearcoat(extensions, place)?,
            },
            diffuse_transmission: self.diffuse_transmission(extensions, place)?,
            iridescence: self.iridescence(extensions, place)?,
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
        Ok(Material { normal_map, interior: dielectric.interior, ..surface(model, emission) })
    }

    /// Le = factor × texture × KHR_materials_emissive_strength; `None` where that is black.
    fn emission(&mut self, m: &json::Material, place: &str) -> Result<Option<Emission>, Error> {
        let strength = m.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref());
        let strength = strength.map_or(1.0, |s| s.emissive_strength.0);
        let at = format!("{place}/extensions/KHR_materials_emissive_strength/emissiveStrength");
        let strength = self.clamped(strength, 0.0, f32::INFINITY, &at)?;
        let mut factor = m.emissive_factor.0;
        for x in &mut factor {
            let at = format!("{place}/emissiveFactor");
            *x = self.clamped(*x, 0.0, f32::INFINITY, &at)?;
            *x = self.finite(*x * strength, &at)?;
        }
        if factor == [0.0; 3] {
            return Ok(None);
        }
        let texture = self.color_texture(m.emissive_texture.as_ref(), &format!("{place}/emissiveTexture"))?;
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
        let slot = Slot::of_normals(map, self.source, place)?;
        let texture = self.texture(slot, false, place)?;
        Ok(texture.map(|texture| NormalMap { texture, scale }))
    }

    /// A texture of colours: RGB is stored with the sRGB curve.
    pub(super) fn color_texture(
        &mut self,
        info: Option<&json::texture::Info>,
        place: &str,
    ) -> Result<Option<TextureRef>, Error> {
        let Some(info) = info else { return Ok(None) };
        let slot = Slot::of_info(info, self.source, place)?;
        self.texture(slot, true, place)
    }

    /// A texture of numbers.
    pub(super) fn data_texture(
        &mut self,
        info: Option<&json::texture::Info>,
        place: &str,
    ) -> Result<Option<TextureRef>, Error> {
        let Some(info) = info else { return Ok(None) };
        let slot = Slot::of_info(info, self.source, place)?;
        self.texture(slot, false, place)
    }

    /// The object of an extension that the `gltf` crate leaves untyped, and its place.
    pub(super) fn untyped<'e>(
        &self,
        extensions: Option<&'e json::extensions::material::Material>,
        name: &str,
        place: &str,
    ) -> Result<Option<(&'e Value, String)>, Error> {
        let Some(object) = extensions.and_then(|e| e.others.get(name)) else { return Ok(None) };
        let place = format!("{place}/extensions/{name}");
        if !object.is_object() {
            return Err(self.source.invalid(place, format!("is {}; expected an object", kind(object))));
        }
        Ok(Some((object, place)))
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
