//! Extensions of the material, a function each. All are read alike: the object as plain JSON, numbers with the bounds and
//! defaults of the specification, textures with the channel that is looked up. What a factor of 0 multiplies is not read.

use super::Reader;
use super::extensions::kind;
use crate::desc::{
    Anisotropy, Clearcoat, ColorParam, DiffuseTransmission, Dispersion, Error, Interior, Iridescence, NormalMap,
    ScalarParam, Sheen, SpecularGlossiness, Transmission, absorption,
};
use serde_json::Value;

/// Channels of textures.
const R: usize = 0;
const G: usize = 1;
const B: usize = 2;
const A: usize = 3;

/// The object of an extension, and the place where it stands.
pub(super) struct Extension<'e> {
    object: &'e Value,
    place: String,
}

impl Extension<'_> {
    fn at(&self, key: &str) -> String {
        format!("{}/{key}", self.place)
    }
}

impl<'a> Reader<'a> {
    /// KHR_materials_ior. 0 is a code for total reflection; below 1 there is nothing else.
    pub(super) fn ior(&mut self, place: &str) -> Result<f32, Error> {
        let Some(e) = self.open("KHR_materials_ior", place)? else { return Ok(1.5) };
        match self.number_under(e.object, "ior", 1.5, &e.place)? {
            0.0 => Ok(0.0),
            ior => self.clamped(ior, 1.0, f32::INFINITY, &e.at("ior")),
        }
    }

    /// KHR_materials_specular: factor on the dielectric's reflection, and its colour at normal incidence.
    pub(super) fn specular(&mut self, place: &str) -> Result<(ScalarParam, ColorParam), Error> {
        let Some(e) = self.open("KHR_materials_specular", place)? else {
            return Ok((ScalarParam::constant(1.0), ColorParam::constant([1.0; 3])));
        };
        let factor = self.share(&e, ["specularFactor", "specularTexture"], 1.0, A)?;
        let color = self.color(&e, ["specularColorFactor", "specularColorTexture"], 1.0, f32::INFINITY)?;
        Ok((factor, color))
    }

    /// KHR_materials_transmission.
    pub(super) fn transmission(&mut self, place: &str) -> Result<Option<Transmission>, Error> {
        let Some(e) = self.open("KHR_materials_transmission", place)? else { return Ok(None) };
        let factor = self.share(&e, ["transmissionFactor", "transmissionTexture"], 0.0, R)?;
        if factor.factor == 0.0 {
            return Ok(None);
        }
        Ok(Some(Transmission { factor, thin: self.thin(place)? }))
    }

    /// KHR_materials_diffuse_transmission (release candidate).
    pub(super) fn diffuse_transmission(&mut self, place: &str) -> Result<Option<DiffuseTransmission>, Error> {
        let Some(e) = self.open("KHR_materials_diffuse_transmission", place)? else { return Ok(None) };
        let factor = self.share(&e, ["diffuseTransmissionFactor", "diffuseTransmissionTexture"], 0.0, A)?;
        let keys = ["diffuseTransmissionColorFactor", "diffuseTransmissionColorTexture"];
        let color = self.color(&e, keys, 1.0, 1.0)?;
        let thin = self.thin(place)?;
        Ok((factor.factor > 0.0).then_some(DiffuseTransmission { factor, color, thin }))
    }

    /// KHR_materials_anisotropy; `None` where its strength is 0.
    pub(super) fn anisotropy(&mut self, place: &str) -> Result<Option<Anisotropy>, Error> {
        let Some(e) = self.open("KHR_materials_anisotropy", place)? else { return Ok(None) };
        let rotation = self.number_under(e.object, "anisotropyRotation", 0.0, &e.place)?;
        // Directions in R and G, strength in B.
        let strength = self.share(&e, ["anisotropyStrength", "anisotropyTexture"], 0.0, B)?;
        let direction = strength.texture.map(|(texture, _)| texture);
        Ok((strength.factor > 0.0).then_some(Anisotropy { strength, rotation, direction }))
    }

    /// KHR_materials_sheen; `None` where its colour is black.
    pub(super) fn sheen(&mut self, place: &str) -> Result<Option<Sheen>, Error> {
        let Some(e) = self.open("KHR_materials_sheen", place)? else { return Ok(None) };
        let color = self.color(&e, ["sheenColorFactor", "sheenColorTexture"], 0.0, 1.0)?;
        if color.factor == [0.0; 3] {
            return Ok(None);
        }
        let roughness = self.share(&e, ["sheenRoughnessFactor", "sheenRoughnessTexture"], 0.0, A)?;
        Ok(Some(Sheen { color, roughness }))
    }

    /// KHR_materials_clearcoat; `None` where nothing is coated.
    pub(super) fn clearcoat(&mut self, place: &str) -> Result<Option<Clearcoat>, Error> {
        let Some(e) = self.open("KHR_materials_clearcoat", place)? else { return Ok(None) };
        let factor = self.share(&e, ["clearcoatFactor", "clearcoatTexture"], 0.0, R)?;
        if factor.factor == 0.0 {
            return Ok(None);
        }
        let roughness = self.share(&e, ["clearcoatRoughnessFactor", "clearcoatRoughnessTexture"], 0.0, G)?;
        const NORMALS: &str = "clearcoatNormalTexture";
        let texture = self.texture_under(e.object, NORMALS, false, &e.place)?;
        let normal_map = match (texture, e.object.get(NORMALS)) {
            (Some(texture), Some(info)) => {
                let scale = self.number_under(info, "scale", 1.0, &e.at(NORMALS))?;
                Some(NormalMap { texture, scale })
            }
            _ => None,
        };
        Ok(Some(Clearcoat { factor, roughness, normal_map }))
    }

    /// KHR_materials_iridescence: a thin film over the surface; `None` where its factor is 0.
    pub(super) fn iridescence(&mut self, place: &str) -> Result<Option<Iridescence>, Error> {
        let Some(e) = self.open("KHR_materials_iridescence", place)? else { return Ok(None) };
        let factor = self.share(&e, ["iridescenceFactor", "iridescenceTexture"], 0.0, R)?;
        if factor.factor == 0.0 {
            return Ok(None);
        }
        let ior = self.number_in(&e, "iridescenceIor", 1.3, [1.0, 1e3])?;
        let thinnest = self.number_in(&e, "iridescenceThicknessMinimum", 100.0, [0.0, f32::INFINITY])?;
        let thickest = self.number_in(&e, "iridescenceThicknessMaximum", 400.0, [0.0, f32::INFINITY])?;
        let texture = self.texture_under(e.object, "iridescenceThicknessTexture", false, &e.place)?;
        let thickness_texture = texture.map(|t| (t, G));
        Ok(Some(Iridescence { factor, ior, thickness: [thinnest, thickest], thickness_texture }))
    }

    /// KHR_materials_pbrSpecularGlossiness, archived and still in files, which stands before the core's model: the model
    /// and its coverage.
    pub(super) fn specular_glossiness(
        &mut self,
        place: &str,
    ) -> Result<Option<(SpecularGlossiness, ScalarParam)>, Error> {
        let Some(e) = self.open("KHR_materials_pbrSpecularGlossiness", place)? else { return Ok(None) };

        // The base's colour and its coverage share factor and texture.
        let mut factor = self.numbers_under(e.object, "diffuseFactor", [1.0; 4], &e.place)?;
        for x in &mut factor {
            *x = self.unit(*x, &e.at("diffuseFactor"))?;
        }
        let texture = self.texture_under(e.object, "diffuseTexture", true, &e.place)?;
        let [r, g, b, a] = factor;
        let diffuse = ColorParam { factor: [r, g, b], texture, vertex_color: true };
        let coverage = ScalarParam { factor: a, texture: texture.map(|t| (t, A)) };

        // So do specular colour, in sRGB, and glossiness, which is linear as every alpha.
        const TEXTURE: &str = "specularGlossinessTexture";
        let specular = self.color(&e, ["specularFactor", TEXTURE], 1.0, 1.0)?;
        let factor = self.number_in(&e, "glossinessFactor", 1.0, [0.0, 1.0])?;
        let texture = match specular.texture {
            // A black colour has not looked for it.
            None if factor > 0.0 => self.texture_under(e.object, TEXTURE, true, &e.place)?,
            texture => texture,
        };
        let glossiness = ScalarParam { factor, texture: texture.map(|t| (t, A)) };
        Ok(Some((SpecularGlossiness { diffuse, specular, glossiness }, coverage)))
    }

    /// What a material encloses: the attenuation of KHR_materials_volume, and KHR_materials_dispersion. Distances are in
    /// world space: the scale of nodes does not touch them. glTF has no priorities: of volumes that overlap the one entered
    /// last is there.
    pub(super) fn interior(&mut self, place: &str) -> Result<Interior, Error> {
        let mut interior = Interior::default();
        if let Some(e) = self.open("KHR_materials_volume", place)? {
            // σ_a = −ln(attenuationColor)/attenuationDistance; without the distance there is none.
            let color = self.rgb(&e, "attenuationColor", 1.0, 1.0)?;
            if e.object.get("attenuationDistance").is_some() {
                let distance = self.number_under(e.object, "attenuationDistance", 0.0, &e.place)?;
                if distance <= 0.0 {
                    let message = format!("is {distance}; expected a number above 0");
                    return Err(self.source.invalid(e.at("attenuationDistance"), message));
                }
                interior.absorption = absorption(color, distance);
            }
        }
        if let Some(e) = self.open("KHR_materials_dispersion", place)? {
            // 20 over the Abbe number.
            let dispersion = self.number_in(&e, "dispersion", 0.0, [0.0, f32::INFINITY])?;
            if dispersion > 0.0 {
                interior.dispersion = Dispersion::InverseAbbe(dispersion / 20.0);
            }
        }
        Ok(interior)
    }

    /// KHR_materials_emissive_strength: factor on the emission.
    pub(super) fn emissive_strength(&mut self, place: &str) -> Result<f32, Error> {
        let Some(e) = self.open("KHR_materials_emissive_strength", place)? else { return Ok(1.0) };
        self.number_in(&e, "emissiveStrength", 1.0, [0.0, f32::INFINITY])
    }

    /// KHR_materials_volume: whether what is transmitted passes a sheet without thickness, not into a volume.
    fn thin(&mut self, place: &str) -> Result<bool, Error> {
        let Some(e) = self.open("KHR_materials_volume", place)? else { return Ok(true) };
        if self.number_under(e.object, "thicknessFactor", 0.0, &e.place)? <= 0.0 {
            return Ok(true);
        }
        if e.object.get("thicknessTexture").is_some() {
            self.notes.at(&e.place, "thickness textures are ignored: the mesh itself says how thick it is");
        }
        Ok(false)
    }

    /// The object of an extension of the material at `place`; `None` where it has no such one, as the default material,
    /// which stands nowhere.
    pub(super) fn open(&self, name: &str, place: &str) -> Result<Option<Extension<'a>>, Error> {
        let place = match place {
            "" => return Ok(None),
            material => format!("{material}/extensions/{name}"),
        };
        let source = self.source;
        let Some(object) = source.json.pointer(&place) else { return Ok(None) };
        if !object.is_object() {
            return Err(source.invalid(place, format!("is {}; expected an object", kind(object))));
        }
        Ok(Some(Extension { object, place }))
    }

    /// The number under a key, clamped to bounds.
    fn number_in(&mut self, e: &Extension, key: &str, default: f32, [low, high]: [f32; 2]) -> Result<f32, Error> {
        let x = self.number_under(e.object, key, default, &e.place)?;
        self.clamped(x, low, high, &e.at(key))
    }

    /// The colour under a key, each channel clamped to [0, `most`].
    fn rgb(&mut self, e: &Extension, key: &str, default: f32, most: f32) -> Result<[f32; 3], Error> {
        let mut rgb = self.numbers_under(e.object, key, [default; 3], &e.place)?;
        for x in &mut rgb {
            *x = self.clamped(*x, 0.0, most, &e.at(key))?;
        }
        Ok(rgb)
    }

    /// A share in [0, 1] times one channel of a texture, by their keys.
    fn share(
        &mut self,
        e: &Extension,
        [factor, texture]: [&str; 2],
        default: f32,
        channel: usize,
    ) -> Result<ScalarParam, Error> {
        let factor = self.number_in(e, factor, default, [0.0, 1.0])?;
        if factor == 0.0 {
            return Ok(ScalarParam::constant(0.0));
        }
        let texture = self.texture_under(e.object, texture, false, &e.place)?;
        Ok(ScalarParam { factor, texture: texture.map(|t| (t, channel)) })
    }

    /// A colour of channels in [0, `most`] times that of a texture, by their keys.
    fn color(
        &mut self,
        e: &Extension,
        [factor, texture]: [&str; 2],
        default: f32,
        most: f32,
    ) -> Result<ColorParam, Error> {
        let rgb = self.rgb(e, factor, default, most)?;
        if rgb == [0.0; 3] {
            return Ok(ColorParam::constant(rgb));
        }
        let texture = self.texture_under(e.object, texture, true, &e.place)?;
        Ok(ColorParam { factor: rgb, texture, vertex_color: false })
    }
}
