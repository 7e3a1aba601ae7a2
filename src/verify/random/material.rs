//! Random materials: every model, extension and parameter.

use super::draw::Draw;
use super::feature::Feature;
use super::texture::{Images, checker};
use crate::desc::{
    Alpha, Anisotropy, Clearcoat, ColorParam, DiffuseTransmission, Dispersion, Emission, Fresnel, Interior,
    Iridescence, Layers, Material, MetallicRoughness, Model, Roughness, ScalarParam, Scene, Sheen, Sides,
    SpecularGlossiness, Transmission,
};
use std::collections::BTreeSet;

/// Models, by the feature that each is.
const MODELS: [Feature; 12] = [
    Feature::Diffuse,
    Feature::RoughDiffuse,
    Feature::Phong,
    Feature::Mirror,
    Feature::SmoothDielectric,
    Feature::RoughDielectric,
    Feature::Conductor,
    Feature::CookTorrance,
    Feature::Mix,
    Feature::MetallicRoughness,
    Feature::SpecularGlossiness,
    Feature::Absorb,
];

/// Indices of refraction: few, for each pair that meets has an energy table of its own, which takes longer than an image.
const INDICES: [f32; 4] = [1.2, 1.33, 1.5, 2.0];

/// What a material is drawn for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Use {
    /// The surface bounds a volume, so that light may pass into it.
    pub(super) closed: bool,
    /// There are vertex colours.
    pub(super) colored: bool,
    /// Set of texture coordinates.
    pub(super) uv_set: usize,
}

/// Draws materials into a scene.
pub(super) struct Maker<'a> {
    pub(super) scene: &'a mut Scene,
    pub(super) draw: &'a mut Draw,
    pub(super) images: Images,
    /// Least perceptual roughness of what is not smooth: peaks that no light sampling finds tell nothing.
    pub(super) least: f32,
}

/// A material under construction.
struct Draft<'m, 'a> {
    maker: &'m mut Maker<'a>,
    of: Use,
    features: BTreeSet<Feature>,
    /// It has much of everything.
    rich: bool,
}

impl Maker<'_> {
    /// A material and its features; how it scatters, emits and covers.
    pub(super) fn material(&mut self, of: Use) -> (Material, BTreeSet<Feature>) {
        let rich = self.draw.chance(0.3);
        let mut draft = Draft { maker: self, of, features: BTreeSet::new(), rich };
        let model = draft.model(true);
        let encloses = crate::material::interior(&Material::new("", model.clone())).is_some();
        let mut material = Material::new("", model);
        if encloses {
            material.interior = draft.interior();
            // As readers have it: the model's index is that of the formula.
            match (&mut material.model, material.interior.dispersion.index()) {
                (Model::Dielectric { ior, .. }, Some(index)) => *ior = index,
                (Model::MetallicRoughness(m), Some(index)) => m.ior = index,
                _ => {}
            }
        } else {
            material.alpha = draft.alpha();
        }
        material.emission = draft.emission();
        let (draw, images) = (&mut *draft.maker.draw, draft.maker.images);
        if draw.chance(0.25) {
            draft.features.insert(Feature::NormalMap);
            material.normal_map = Some(images.normals(draft.maker.scene, draw, of.uv_set));
        }
        material.double_sided = draft.maker.draw.chance(0.7);
        (material, draft.features)
    }

    /// What an object emits in place of its material.
    pub(super) fn own_emission(&mut self, of: Use, features: &mut BTreeSet<Feature>) -> Emission {
        let mut draft = Draft { maker: self, of, features: BTreeSet::new(), rich: false };
        let emission = draft.emitted();
        features.retain(|f| {
            use Feature::*;
            !matches!(f, EmitsFront | EmitsBoth | EmissionImage | EmissionCoat)
        });
        features.extend(&draft.features);
        features.insert(Feature::OwnEmission);
        emission
    }
}

impl Draft<'_, '_> {
    fn chance(&mut self, p: f32) -> bool {
        self.maker.draw.chance(p)
    }

    fn between(&mut self, a: f32, b: f32) -> f32 {
        self.maker.draw.between(a, b)
    }

    /// An extension or a property, with a probability.
    fn maybe(&mut self, feature: Feature, p: f32) -> bool {
        let has = self.chance(if self.rich { 2.5 * p } else { p });
        if has {
            self.features.insert(feature);
        }
        has
    }

    /// A colour, perhaps of a texture.
    fn color(&mut self, a: f32, b: f32) -> ColorParam {
        let (draw, scene, uv_set) = (&mut *self.maker.draw, &mut *self.maker.scene, self.of.uv_set);
        let factor = draw.rgb(a, b);
        let (texture, feature) = match draw.unit() {
            x if x < 0.3 => (Some(self.maker.images.color(scene, draw, uv_set)), Some(Feature::ImageColor)),
            x if x < 0.45 => (Some(checker(scene, draw, uv_set)), Some(Feature::Checker)),
            _ => (None, None),
        };
        self.features.extend(feature);
        ColorParam { factor, texture, vertex_color: self.of.colored }
    }

    /// A number, perhaps of an image.
    fn number(&mut self, a: f32, b: f32) -> ScalarParam {
        let factor = self.between(a, b);
        if !self.maybe(Feature::ImageNumber, 0.3) {
            return ScalarParam::constant(factor);
        }
        self.maker.images.number(self.maker.scene, self.maker.draw, self.of.uv_set, factor)
    }

    /// A perceptual roughness, at times smooth.
    fn roughness(&mut self) -> ScalarParam {
        if self.chance(0.2) { ScalarParam::constant(0.0) } else { self.rough() }
    }

    fn rough(&mut self) -> ScalarParam {
        // Images have numbers from a half on.
        let least = self.maker.least;
        match self.number(least, 1.0) {
            textured @ ScalarParam { texture: Some(_), .. } => {
                ScalarParam { factor: textured.factor.max(2.0 * least).min(1.0), ..textured }
            }
            constant => constant,
        }
    }

    /// A microsurface of the classic models.
    fn microsurface(&mut self) -> Roughness {
        let least = self.maker.least.powi(2);
        match self.maker.draw.below(6) {
            0 | 1 => {
                self.features.insert(Feature::Stretched);
                if self.chance(0.5) {
                    Roughness::Alpha([self.between(least, 0.9), self.between(least, 0.9)])
                } else {
                    Roughness::Stretched { roughness: self.rough(), strength: self.number(0.2, 1.0) }
                }
            }
            2 => Roughness::Glossiness(ScalarParam::constant(1.0 - self.between(self.maker.least, 1.0))),
            _ => Roughness::Perceptual(self.rough()),
        }
    }

    fn fresnel(&mut self) -> Fresnel {
        if self.maybe(Feature::ComplexIndex, 0.5) {
            let eta = self.maker.draw.rgb(0.2, 2.5);
            Fresnel::Complex { eta, k: self.maker.draw.rgb(1.0, 5.0) }
        } else {
            Fresnel::Schlick { f0: self.color(0.2, 1.0) }
        }
    }

    /// How it scatters; mixtures have other models as parts.
    fn model(&mut self, outermost: bool) -> Model {
        let allowed = |f: Feature, closed: bool| match f {
            Feature::SmoothDielectric | Feature::RoughDielectric => closed,
            Feature::Mix => outermost,
            _ => true,
        };
        let closed = self.of.closed;
        let kinds: Vec<Feature> = MODELS.into_iter().filter(|f| allowed(*f, closed)).collect();
        let kind = match self.maker.draw.unit() {
            x if x < 0.3 => Feature::MetallicRoughness,
            x if x < 0.55 && outermost => Feature::Mix,
            _ => self.maker.draw.pick(&kinds),
        };
        self.features.insert(kind);
        match kind {
            Feature::Diffuse => Model::Diffuse { reflectance: self.color(0.2, 0.9) },
            Feature::RoughDiffuse => {
                Model::RoughDiffuse { reflectance: self.color(0.2, 0.9), roughness: self.number(0.1, 1.0) }
            }
            Feature::Phong => Model::Phong { reflectance: self.color(0.2, 0.9), exponent: self.between(0.0, 40.0) },
            Feature::Mirror => Model::Mirror { reflectance: self.color(0.3, 1.0) },
            Feature::SmoothDielectric | Feature::RoughDielectric => {
                let smooth = kind == Feature::SmoothDielectric;
                let roughness = if smooth { Roughness::Alpha([0.0; 2]) } else { self.microsurface() };
                let tint = if self.chance(0.3) { self.color(0.5, 1.0) } else { ColorParam::constant([1.0; 3]) };
                Model::Dielectric { ior: self.maker.draw.pick(&INDICES), roughness, tint }
            }
            Feature::Conductor => {
                let roughness = if self.chance(0.2) { Roughness::Alpha([0.0; 2]) } else { self.microsurface() };
                Model::Conductor { fresnel: self.fresnel(), roughness }
            }
            Feature::CookTorrance => Model::CookTorrance { fresnel: self.fresnel(), roughness: self.microsurface() },
            Feature::Mix => {
                let weight = self.between(0.2, 0.8);
                let rest = (1.0 - weight) * if self.chance(0.5) { 1.0 } else { 0.8 };
                Model::Mix(vec![(weight, self.model(false)), (rest, self.model(false))])
            }
            Feature::SpecularGlossiness => Model::SpecularGlossiness(Box::new(SpecularGlossiness {
                diffuse: self.color(0.1, 0.9),
                specular: self.color(0.02, 0.9),
                glossiness: ScalarParam::constant(1.0 - self.between(self.maker.least, 1.0)),
            })),
            Feature::Absorb => Model::Absorb,
            _ => Model::MetallicRoughness(Box::new(self.metallic_roughness())),
        }
    }

    /// glTF's model; each extension with a probability of its own.
    fn metallic_roughness(&mut self) -> MetallicRoughness {
        const WHITE: ColorParam = ColorParam::constant([1.0; 3]);
        let specular = self.maybe(Feature::Specular, 0.25);
        let volume = self.of.closed && self.chance(0.5);
        let [through, diffusely] = match volume {
            true => [Feature::Transmission, Feature::DiffuseTransmission],
            false => [Feature::ThinTransmission, Feature::ThinDiffuseTransmission],
        };
        let (through, diffusely) = (self.maybe(through, 0.3), self.maybe(diffusely, 0.25));
        MetallicRoughness {
            base_color: self.color(0.2, 1.0),
            metallic: if self.chance(0.4) { ScalarParam::constant(0.0) } else { self.number(0.1, 1.0) },
            roughness: self.roughness(),
            ior: self.maker.draw.pick(&INDICES),
            specular: if specular { self.number(0.2, 1.0) } else { ScalarParam::constant(1.0) },
            specular_color: if specular { self.color(0.3, 1.0) } else { WHITE },
            transmission: through.then(|| Transmission { factor: self.number(0.3, 1.0), thin: !volume }),
            layers: self.layers(),
            diffuse_transmission: diffusely.then(|| DiffuseTransmission {
                factor: self.number(0.3, 1.0),
                color: self.color(0.3, 1.0),
                thin: !volume,
            }),
            iridescence: self.maybe(Feature::Iridescence, 0.25).then(|| self.film()),
        }
    }

    fn film(&mut self) -> Iridescence {
        let texture = self.number(1.0, 1.0).texture;
        Iridescence {
            factor: self.number(0.3, 1.0),
            ior: self.between(1.1, 2.0),
            thickness: [self.between(50.0, 300.0), self.between(300.0, 800.0)],
            thickness_texture: texture,
        }
    }

    fn layers(&mut self) -> Layers {
        let anisotropy = self.maybe(Feature::Anisotropy, 0.25).then(|| Anisotropy {
            strength: self.number(0.2, 0.9),
            rotation: self.between(-3.0, 3.0),
            direction: None,
        });
        let sheen = self
            .maybe(Feature::Sheen, 0.25)
            .then(|| Sheen { color: self.color(0.2, 1.0), roughness: self.number(0.3, 1.0) });
        let clearcoat = self.maybe(Feature::Clearcoat, 0.3).then(|| {
            let normal_map = self
                .maybe(Feature::CoatNormal, 0.4)
                .then(|| self.maker.images.normals(self.maker.scene, self.maker.draw, self.of.uv_set));
            Clearcoat { factor: self.number(0.3, 1.0), roughness: self.roughness(), normal_map }
        });
        Layers { anisotropy, sheen, clearcoat }
    }

    fn interior(&mut self) -> Interior {
        let absorption = match self.maybe(Feature::Absorption, 0.5) {
            true => self.maker.draw.rgb(0.0, 2.0),
            false => [0.0; 3],
        };
        let dispersion = match (self.maybe(Feature::Dispersion, 0.35), self.chance(0.7)) {
            (true, true) => Dispersion::InverseAbbe(1.0 / 25.0),
            (true, false) => Dispersion::Cauchy([1.45, 0.01]),
            _ => Dispersion::None,
        };
        Interior { absorption, priority: self.maker.draw.below(3) as i32, dispersion }
    }

    fn alpha(&mut self) -> Alpha {
        let form = self.maker.draw.below(8);
        let image =
            |draft: &mut Self| draft.maker.images.coverage(draft.maker.scene, draft.maker.draw, draft.of.uv_set);
        let (alpha, feature) = match form {
            0 => (Alpha::Mask { coverage: image(self), cutoff: 0.5 }, Feature::Mask),
            1 => (Alpha::Blend { coverage: ScalarParam::constant(self.between(0.2, 0.9)) }, Feature::BlendConstant),
            2 => (Alpha::Blend { coverage: image(self) }, Feature::BlendImage),
            _ => return Alpha::Opaque,
        };
        self.features.insert(feature);
        alpha
    }

    fn emission(&mut self) -> Option<Emission> {
        self.chance(0.3).then(|| self.emitted())
    }

    fn emitted(&mut self) -> Emission {
        let both = self.chance(0.5);
        self.features.insert(if both { Feature::EmitsBoth } else { Feature::EmitsFront });
        let mut radiance = ColorParam::constant(self.maker.draw.rgb(0.5, 5.0));
        if self.maybe(Feature::EmissionImage, 0.35) {
            radiance.texture = Some(self.maker.images.color(self.maker.scene, self.maker.draw, self.of.uv_set));
        }
        let coat = self.maybe(Feature::EmissionCoat, 0.2).then(|| self.number(0.3, 1.0));
        Emission { radiance, sides: if both { Sides::Both } else { Sides::Front }, coat }
    }
}
