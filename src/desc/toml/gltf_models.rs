//! `type = "metallic-roughness"` and `"specular-glossiness"`: the models of glTF.

use super::build::Builder;
use super::color::{Radiance, Reflectance, Scalar};
use super::film::FilmTable;
use super::interior::InteriorTable;
use super::keys::keys;
use super::layers::LayersTable;
use super::number::Number;
use super::read::{At, Fault};
use super::writer::Names;
use crate::desc::{DiffuseTransmission, Interior, MetallicRoughness, Model, SpecularGlossiness, Transmission};

keys! {
    /// The metallic-roughness model of glTF 2.0.
    struct MetallicRoughnessTable {
        /// Albedo of the dielectric, reflectance of the metal, each channel in [0, 1]. Default 1.
        base_color: Reflectance = Reflectance::one_everywhere(),
        /// Metalness in [0, 1], a number or a texture. Default 0.
        metallic: Scalar = Scalar::Constant(0.0),
        /// Perceptual roughness in [0, 1] (GGX alpha is its square), a number or a texture. Default 1.
        roughness: Scalar = Scalar::Constant(1.0),
        /// Index of refraction of the dielectric, at least 1; or 0, for one that reflects everything. Default 1.5.
        ior: Option<At<Number>>,
        /// Factor on the reflection of the dielectric in [0, 1], a number or a texture. Default 1.
        specular: Scalar = Scalar::Constant(1.0),
        /// Colour of the reflection of the dielectric at normal incidence, at least 0. Default 1.
        specular_color: Radiance = Radiance::one_everywhere(),
        /// Share of the diffuse light that passes through instead in [0, 1], a number or a texture. Default: none.
        transmission: Option<Scalar>,
        /// Share of what is left of the diffuse light that passes through diffusely in [0, 1], a number or a texture. Default: none.
        diffuse_transmission: Option<Scalar>,
        /// Colour of the diffuse light that passes through, each channel in [0, 1]. Default 1.
        diffuse_transmission_color: Reflectance = Reflectance::one_everywhere(),
        /// Whether the surface is a thin sheet: what passes goes straight on instead of being refracted. Default true.
        thin: bool = true,
        /// Whether it is a thin sheet for what passes diffusely. Default: as `thin` says.
        thin_diffuse: Option<bool>,
        /// A film on the surface that is so thin that the light of its two faces interferes. Default: none.
        film: Option<FilmTable>,
        ..interior: InteriorTable,
        ..layers: LayersTable,
    }
}

impl MetallicRoughnessTable {
    /// The scattering model.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<Model, Fault> {
        let ior = match &self.ior {
            Some(At { at, value: Number(ior) }) if *ior < 1.0 && *ior != 0.0 => {
                return Err(Fault::new(at, format!("`ior` is {ior}, expected at least 1")));
            }
            Some(At { at, .. }) if self.interior.cauchy.is_some() => {
                return Err(Fault::new(at, "`cauchy` is given too; expected one way"));
            }
            Some(ior) => ior.value.0,
            None => self.interior.index(None)?,
        };
        let transmission = match &self.transmission {
            None => None,
            Some(factor) => Some(Transmission { factor: factor.build(b)?, thin: self.thin }),
        };
        let diffuse_transmission = match &self.diffuse_transmission {
            None => None,
            Some(factor) => {
                let color = self.diffuse_transmission_color.build(b)?;
                Some(DiffuseTransmission {
                    factor: factor.build(b)?,
                    color,
                    thin: self.thin_diffuse.unwrap_or(self.thin),
                })
            }
        };
        Ok(Model::MetallicRoughness(Box::new(MetallicRoughness {
            base_color: self.base_color.build_base(b)?,
            metallic: self.metallic.build(b)?,
            roughness: self.roughness.build(b)?,
            ior,
            specular: self.specular.build(b)?,
            specular_color: self.specular_color.build(b)?,
            transmission,
            layers: self.layers.build(b)?,
            diffuse_transmission,
            iridescence: self.film.as_ref().map(|film| film.build(b)).transpose()?,
        })))
    }

    /// The inverse of [`Self::build`]; `interior` is that of the material.
    pub(super) fn of(model: &MetallicRoughness, interior: &Interior, names: &Names) -> Self {
        let m = model;
        let interior = InteriorTable::of(interior);
        let through = m.diffuse_transmission.as_ref();
        let thin = m.transmission.as_ref().map(|t| t.thin).or(through.map(|t| t.thin)).unwrap_or(true);
        let color = through.map(|t| Reflectance::of(&t.color, names));
        Self {
            base_color: Reflectance::of_base(&m.base_color, names),
            metallic: Scalar::of(&m.metallic, names),
            roughness: Scalar::of(&m.roughness, names),
            ior: interior.ior_of(m.ior).filter(|ior| *ior != 1.5).map(|ior| At::nowhere(Number(ior))),
            specular: Scalar::of(&m.specular, names),
            specular_color: Radiance::of(&m.specular_color, names),
            transmission: m.transmission.as_ref().map(|t| Scalar::of(&t.factor, names)),
            diffuse_transmission: through.map(|t| Scalar::of(&t.factor, names)),
            diffuse_transmission_color: color.unwrap_or(Reflectance::one_everywhere()),
            thin,
            thin_diffuse: through.map(|t| t.thin).filter(|other| *other != thin),
            film: m.iridescence.as_ref().map(|film| FilmTable::of(film, names)),
            interior,
            layers: LayersTable::of(&m.layers, names),
        }
    }
}

keys! {
    /// The specular-glossiness model of glTF (KHR_materials_pbrSpecularGlossiness).
    struct SpecularGlossinessTable {
        /// Albedo of the diffuse base, each channel in [0, 1]. Default 1.
        diffuse: Reflectance = Reflectance::one_everywhere(),
        /// Reflectance at normal incidence, each channel in [0, 1]. Default 1.
        specular: Reflectance = Reflectance::one_everywhere(),
        /// Glossiness in [0, 1], 1 − perceptual roughness, a number or a texture. Default 1.
        glossiness: Scalar = Scalar::Constant(1.0),
    }
}

impl SpecularGlossinessTable {
    /// The scattering model.
    pub(super) fn build(&self, b: &mut Builder<'_>) -> Result<Model, Fault> {
        Ok(Model::SpecularGlossiness(Box::new(SpecularGlossiness {
            diffuse: self.diffuse.build_base(b)?,
            specular: self.specular.build(b)?,
            glossiness: self.glossiness.build(b)?,
        })))
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(model: &SpecularGlossiness, names: &Names) -> Self {
        let SpecularGlossiness { diffuse, specular, glossiness } = model;
        Self {
            diffuse: Reflectance::of_base(diffuse, names),
            specular: Reflectance::of(specular, names),
            glossiness: Scalar::of(glossiness, names),
        }
    }
}
