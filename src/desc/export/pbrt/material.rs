//! Scattering models as named materials.
//!
//! Metals and glass are what they are here, scattering once at their microfacets. A dielectric base is `coateddiffuse`, which
//! follows light to and fro under the coat: its colour is deeper than that of the coupled base here.

use super::super::ExportError;
use super::super::beside::Beside;
use super::super::fit;
use super::super::form::{Placed, medium_of};
use super::super::micro::Micro;
use super::super::picture::Map;
use super::super::value::{Color, Pattern, Scalar, Source};
use super::words::{Named, Words};
use crate::bsdf::MIN_ALPHA;
use crate::desc::{
    Alpha, ColorParam, Dispersion, Fresnel, Material, MetallicRoughness, Model, Roughness, ScalarParam, Wrap,
};
use glam::Affine2;

/// What shapes name of a material.
pub(super) struct MaterialUse {
    pub(super) material: String,
    /// Opacity, which belongs to shapes.
    pub(super) alpha: Option<Named<f32>>,
}

/// Writes the materials that are used, their textures and media.
pub(super) fn write(
    placed: &[Placed],
    beside: &mut Beside,
    out: &mut Words,
) -> Result<Vec<Option<MaterialUse>>, ExportError> {
    let scene = beside.scene;
    let mut materials = Vec::new();
    for (index, material) in scene.materials.iter().enumerate() {
        if !placed.iter().any(|p| p.object.material == index) {
            materials.push(None);
            continue;
        }
        let turned = beside.turns_normals(placed, index);
        let mut w = Writer { beside, out, material, index, turned, names: 0, textures: 0 };
        materials.push(Some(w.material_use()?));
        if let Some(medium) = medium_of(material, index) {
            let medium = out.line(&format!("MakeNamedMedium \"{medium}\"")).string("type", "homogeneous");
            medium.rgb("sigma_a", material.interior.absorption).rgb("sigma_s", [0.0; 3]);
        }
    }
    Ok(materials)
}

struct Writer<'a, 'b> {
    beside: &'a mut Beside<'b>,
    out: &'a mut Words,
    material: &'a Material,
    index: usize,
    /// Its normal map has its y turned.
    turned: bool,
    names: usize,
    textures: usize,
}

impl Writer<'_, '_> {
    fn note(&mut self, text: &str) {
        self.beside.note(format!("material `{}`: {text}", self.material.name));
    }

    fn material_use(&mut self) -> Result<MaterialUse, ExportError> {
        let material = self.material;
        let alpha = match &material.alpha {
            Alpha::Opaque => None,
            Alpha::Mask { coverage, cutoff } => {
                self.note("its mask is cut texel by texel, not between them");
                Some(self.beside.scalar(coverage, Map::AtLeast(*cutoff))?)
            }
            Alpha::Blend { coverage } => Some(self.beside.scalar(coverage, Map::Same)?),
        };
        let alpha = alpha.map(|alpha| self.scalar(&alpha));
        if material.interior.dispersion != Dispersion::None {
            self.note("it does not disperse");
        }
        if material.interior.priority != 0 {
            self.note("overlapping interiors have no priorities");
        }
        Ok(MaterialUse { material: self.model(&material.model)?, alpha })
    }

    /// Begins a material of this type; returns its name.
    fn begin(&mut self, kind: &str) -> Result<String, ExportError> {
        let name = match self.names {
            0 => format!("material-{}", self.index),
            n => format!("material-{}-{n}", self.index),
        };
        self.names += 1;
        let map = match &self.material.normal_map {
            Some(map) if kind != "mix" => {
                if map.texture.transform != Affine2::IDENTITY {
                    self.note("its normal map is looked up without its transform");
                }
                self.beside.normals(map, self.turned)?
            }
            _ => None,
        };
        self.out.line(&format!("MakeNamedMaterial \"{name}\"")).string("type", kind);
        if let Some(file) = map.as_ref().and_then(Source::file) {
            self.out.string("normalmap", file);
        }
        Ok(name)
    }

    fn model(&mut self, model: &Model) -> Result<String, ExportError> {
        match model {
            Model::Diffuse { reflectance } => self.diffuse(reflectance),
            Model::Phong { reflectance, exponent } => {
                self.note("pbrt has no Phong lobe; this is a metal's of the width √(2/(n + 2))");
                let alpha = (2.0 / (exponent.max(0.0) + 2.0)).sqrt();
                self.metal(reflectance, &Roughness::Alpha([alpha; 2]))
            }
            Model::Mirror { reflectance } => {
                self.note("its reflectance rises towards grazing angles, as a metal's");
                self.metal(reflectance, &Roughness::Alpha([0.0; 2]))
            }
            Model::Dielectric { ior, roughness, tint } => self.dielectric(*ior, roughness, tint),
            Model::CookTorrance { fresnel, roughness } => {
                self.note("its microfacets are GGX's, not Beckmann's");
                self.conductor(fresnel, roughness)
            }
            Model::Conductor { fresnel, roughness } => self.conductor(fresnel, roughness),
            Model::Mix(parts) => self.mixture(parts),
            Model::MetallicRoughness(m) => self.metallic_roughness(m),
            Model::SpecularGlossiness(m) => {
                if m.specular.texture.is_some() || m.specular.factor.iter().any(|x| *x != m.specular.factor[0]) {
                    self.note("its specular reflection is grey and the same all over");
                }
                let f0 = m.specular.factor.into_iter().fold(0.0, f32::max);
                self.coated(&m.diffuse, &Roughness::Glossiness(m.glossiness), f0)
            }
            Model::Absorb => self.diffuse(&ColorParam::constant([0.0; 3])),
            other => {
                let (plainer, lost) = other.plainer();
                self.note(&format!("pbrt has {lost}"));
                self.model(&plainer)
            }
        }
    }

    fn diffuse(&mut self, reflectance: &ColorParam) -> Result<String, ExportError> {
        let color = self.share(reflectance)?;
        let name = self.begin("diffuse")?;
        self.out.color("reflectance", &color);
        Ok(name)
    }

    /// α, with a note of what microfacets lose.
    fn roughness(&mut self, roughness: &Roughness) -> Result<[Named<f32>; 2], ExportError> {
        let micro = self.beside.micro(roughness, &self.material.name)?;
        if micro.loses() {
            self.note("light that its microfacets scatter more than once is lost in pbrt: it is darker");
        }
        Ok(match micro {
            Micro::Smooth => [Named::Constant(0.0), Named::Constant(0.0)],
            Micro::Constant([x, y]) => {
                if x.min(y) < 1e-3 {
                    self.note("below α = 0.001 pbrt's surfaces are smooth");
                }
                [Named::Constant(x), Named::Constant(y)]
            }
            Micro::Varying(alpha) => {
                let alpha = self.scalar(&alpha);
                [alpha.clone(), alpha]
            }
        })
    }

    fn put_roughness(&mut self, [x, y]: &[Named<f32>; 2]) {
        let out = self.out.boolean("remaproughness", false);
        if x == y {
            out.scalar("roughness", x)
        } else {
            out.scalar("uroughness", x).scalar("vroughness", y)
        };
    }

    fn dielectric(&mut self, ior: f32, roughness: &Roughness, tint: &ColorParam) -> Result<String, ExportError> {
        if *tint != ColorParam::constant([1.0; 3]) {
            self.note("what passes through it is not tinted");
        }
        let alpha = self.roughness(roughness)?;
        let name = self.begin("dielectric")?;
        self.out.float("eta", ior);
        self.put_roughness(&alpha);
        Ok(name)
    }

    fn conductor(&mut self, fresnel: &Fresnel, roughness: &Roughness) -> Result<String, ExportError> {
        match fresnel {
            Fresnel::Schlick { f0 } => self.metal(f0, roughness),
            Fresnel::Complex { eta, k } => {
                let alpha = self.roughness(roughness)?;
                let name = self.begin("conductor")?;
                self.out.rgb("eta", *eta).rgb("k", *k);
                self.put_roughness(&alpha);
                Ok(name)
            }
        }
    }

    /// A metal of this reflectance at normal incidence.
    fn metal(&mut self, f0: &ColorParam, roughness: &Roughness) -> Result<String, ExportError> {
        let (alpha, f0) = (self.roughness(roughness)?, self.share(f0)?);
        let name = self.begin("conductor")?;
        match f0 {
            Named::Constant(f0) => {
                let lanes = f0.map(fit::metal);
                self.out.rgb("eta", lanes.map(|l| l[0])).rgb("k", lanes.map(|l| l[1]));
                self.note("Schlick's reflectance is that of a metal with the same at normal incidence and in the mean");
            }
            Named::Texture(texture) => {
                self.out.texture("reflectance", &texture);
                self.note("Schlick's reflectance is that of a metal of η = 1 with the same at normal incidence");
            }
        }
        self.put_roughness(&alpha);
        Ok(name)
    }

    /// A diffuse base under a dielectric coat of this F₀.
    fn coated(&mut self, base: &ColorParam, roughness: &Roughness, f0: f32) -> Result<String, ExportError> {
        if f0 <= 1e-6 {
            return self.diffuse(base);
        }
        let (alpha, color) = (self.roughness(roughness)?, self.share(base)?);
        self.note("its diffuse base is pbrt's coateddiffuse, of a deeper colour");
        let name = self.begin("coateddiffuse")?;
        self.out.color("reflectance", &color).float("eta", fit::index(f0.min(0.98)));
        self.put_roughness(&alpha);
        Ok(name)
    }

    fn metallic_roughness(&mut self, m: &MetallicRoughness) -> Result<String, ExportError> {
        if !m.layers.is_empty() || m.iridescence.is_some() {
            self.note("its sheen, clear coat, anisotropy and iridescence are left out");
        }
        let full = if m.ior > 0.0 { ((m.ior - 1.0) / (m.ior + 1.0)).powi(2) } else { 1.0 };
        let tint = m.specular_color.factor;
        if m.specular.texture.or(m.specular_color.texture.map(|t| (t, 0))).is_some()
            || tint.iter().any(|x| *x != tint[0])
        {
            self.note("its dielectric reflection is grey and the same all over");
        }
        let f0 = (full * tint.iter().sum::<f32>() / 3.0 * m.specular.factor).clamp(0.0, 0.98);
        let rough = Roughness::Perceptual(m.roughness);
        let metallic = self.beside.scalar(&m.metallic, Map::Same)?;
        if metallic.constant().is_some_and(|x| x >= 1.0) {
            return self.metal(&m.base_color, &rough);
        }

        let mut name = self.coated(&m.base_color, &rough, f0)?;
        if let Some(t) = m.diffuse_transmission.as_ref().filter(|t| t.factor.factor > 0.0) {
            self.note("what it transmits diffusely is not dimmed by its surface's reflection");
            let color = self.share(&t.color)?;
            let sheet = self.begin("diffusetransmission")?;
            self.out.rgb("reflectance", [0.0; 3]).color("transmittance", &color);
            name = self.mix_by(name, sheet, &t.factor)?;
        }
        if let Some(t) = m.transmission.as_ref().filter(|t| t.factor.factor > 0.0) {
            let clear = if t.thin {
                if m.base_color != ColorParam::constant([1.0; 3]) || m.roughness.factor.powi(2) >= MIN_ALPHA {
                    self.note("its thin wall is clear: smooth, and not tinted");
                }
                // Two faces reflect 2R/(1 + R) there, and F₀ in all here.
                let wall = self.begin("thindielectric")?;
                self.out.float("eta", fit::index(f0 / (2.0 - f0)).max(1.001));
                wall
            } else {
                self.dielectric(m.ior, &rough, &m.base_color)?
            };
            name = self.mix_by(name, clear, &t.factor)?;
        }
        if metallic.constant() == Some(0.0) {
            return Ok(name);
        }
        let metal = self.metal(&m.base_color, &rough)?;
        self.mix(name, metal, &metallic)
    }

    fn mix_by(&mut self, a: String, b: String, share: &ScalarParam) -> Result<String, ExportError> {
        let share = self.beside.scalar(share, Map::Same)?;
        self.mix(a, b, &share)
    }

    /// `share` of `b`, the rest of `a`.
    fn mix(&mut self, a: String, b: String, share: &Scalar) -> Result<String, ExportError> {
        if share.constant().is_some_and(|x| x >= 1.0) {
            return Ok(b);
        }
        let share = self.scalar(share);
        let name = self.begin("mix")?;
        self.out.strings("materials", [&a, &b]).scalar("amount", &share);
        Ok(name)
    }

    /// Σ wᵢ fᵢ two at a time; what the weights lack is black.
    fn mixture(&mut self, parts: &[(f32, Model)]) -> Result<String, ExportError> {
        let (mut sum, mut mixed) = (0.0, None);
        for (weight, part) in parts.iter().filter(|(weight, _)| *weight > 0.0) {
            let part = self.model(part)?;
            sum += weight;
            mixed = Some(match mixed {
                None => part,
                Some(before) => self.mix(before, part, &Scalar::Constant(weight / sum))?,
            });
        }
        let Some(mixed) = mixed else { return self.diffuse(&ColorParam::constant([0.0; 3])) };
        if sum >= 1.0 - 1e-6 {
            return Ok(mixed);
        }
        let black = self.diffuse(&ColorParam::constant([0.0; 3]))?;
        self.mix(mixed, black, &Scalar::Constant(1.0 - sum))
    }

    fn share(&mut self, param: &ColorParam) -> Result<Named<[f32; 3]>, ExportError> {
        Ok(match self.beside.share(param)? {
            Color::Texture(source) => Named::Texture(self.texture("spectrum", &source, |out, name, rgb| {
                out.rgb(name, rgb);
            })),
            plain => {
                if matches!(plain, Color::Vertex(_)) {
                    self.note("vertex colours are left out");
                }
                Named::Constant(plain.plain().unwrap_or_default())
            }
        })
    }

    fn scalar(&mut self, scalar: &Scalar) -> Named<f32> {
        match scalar {
            Scalar::Constant(x) => Named::Constant(*x),
            Scalar::Texture(source) => Named::Texture(self.texture("float", source, |out, name, x| {
                out.float(name, x);
            })),
        }
    }

    /// Writes a texture; returns its name. v counts upwards there: (u, v) of ours is (u, 1 − v).
    fn texture<T: Copy>(&mut self, kind: &str, source: &Source<T>, put: impl Fn(&mut Words, &str, T)) -> String {
        let name = format!("texture-{}-{}", self.index, self.textures);
        self.textures += 1;
        let (m, t) = (source.transform.matrix2, source.transform.translation);
        if m.x_axis.y != 0.0 || m.y_axis.x != 0.0 {
            self.note("its textures are scaled and moved, but not turned");
        }
        let (a, d) = (m.x_axis.x, m.y_axis.y);
        match &source.pattern {
            Pattern::Image { file, linear, wrap, nearest } => {
                if wrap[0] != wrap[1] || wrap[0] == Wrap::Mirror {
                    self.note("its texture wraps along both axes alike, and is not mirrored");
                }
                let wrap = if wrap[0] == Wrap::Clamp { "clamp" } else { "repeat" };
                let out =
                    self.out.line(&format!("Texture \"{name}\" \"{kind}\" \"imagemap\"")).string("filename", file);
                let out = out.string("encoding", if *linear { "linear" } else { "sRGB" }).string("wrap", wrap);
                out.string("filter", if *nearest { "point" } else { "bilinear" });
                // The row is 1 − (what is looked up).
                out.float("uscale", a).float("udelta", t.x).float("vscale", d).float("vdelta", 1.0 - d - t.y);
            }
            Pattern::Checker { even, odd, scale } => {
                let [su, sv] = *scale;
                let out = self.out.line(&format!("Texture \"{name}\" \"{kind}\" \"checkerboard\""));
                put(out, "tex1", *even);
                put(out, "tex2", *odd);
                out.float("uscale", su * a).float("udelta", su * t.x);
                out.float("vscale", -sv * d).float("vdelta", sv * (d + t.y));
            }
        }
        name
    }
}
