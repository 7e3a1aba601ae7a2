//! Scattering models as BSDF plugins.
//!
//! `alpha` is that of the microfacets in both; `principled` has the perceptual roughness, α = r², as glTF. Its microfacets
//! scatter once: what rough surfaces scatter more often, here added, is lost there. Opaque models are `twosided`.

use super::super::ExportError;
use super::super::beside::Beside;
use super::super::fit;
use super::super::form::{Placed, medium_of};
use super::super::micro::Micro;
use super::super::picture::Map;
use super::super::value::{Color, Scalar};
use super::layered;
use super::xml::Element;
use crate::bsdf::MIN_ALPHA;
use crate::desc::{Alpha, ColorParam, Dispersion, Fresnel, Model, Roughness, Wrap};

/// Least share of σ_a of a lane.
const CLEAR: f32 = 1e-6;

/// α of what is smooth, in a blend.
const NARROW: f32 = 1e-3;

/// A note on rough metal and glass.
const AGAIN: &str = "what its microfacets scatter more than once is a factor on what they scatter once";

/// Least α of `principled`.
const PRINCIPLED_ALPHA: f32 = 1e-3;

/// The whole material, named for its index.
pub(super) fn element(index: usize, placed: &[Placed], beside: &mut Beside) -> Result<Element, ExportError> {
    let material = &beside.scene.materials[index];
    let turned = beside.turns_normals(placed, index);
    let mut writer = Writer { beside, name: &material.name, blended: false };
    let mut bsdf = writer.model(&material.model)?;
    if let Some(map) = &material.normal_map {
        if let Some(source) = writer.beside.normals(map, turned)? {
            bsdf = Element::bsdf("normalmap").normals("normalmap", &source).child(bsdf);
        }
        writer.note("where a normal map sends light into the surface, Mitsuba drops it");
    }
    bsdf = match &material.alpha {
        Alpha::Opaque => bsdf,
        Alpha::Mask { coverage, cutoff } => {
            writer.note("its mask is cut texel by texel, not between them");
            let opacity = writer.beside.scalar(coverage, Map::AtLeast(*cutoff))?;
            Element::bsdf("mask").scalar("opacity", &opacity).child(bsdf)
        }
        Alpha::Blend { coverage } => {
            let opacity = writer.beside.scalar(coverage, Map::Same)?;
            Element::bsdf("mask").scalar("opacity", &opacity).child(bsdf)
        }
    };
    if material.interior.dispersion != Dispersion::None {
        writer.note("it does not disperse");
    }
    if material.interior.priority != 0 {
        writer.note("overlapping interiors have no priorities");
    }
    Ok(bsdf.with("id", format_args!("material-{index}")))
}

/// Media inside of all materials that have one.
pub(super) fn media(beside: &Beside) -> Vec<Element> {
    let materials = beside.scene.materials.iter().enumerate();
    let media = materials.filter_map(|(i, m)| medium_of(m, i).map(|id| (id, m.interior.absorption)));
    media
        .map(|(id, absorption)| {
            let medium = Element::plugin("medium", "homogeneous").with("id", id);
            // Colours end at 1 there; the rest is a factor.
            let most = absorption.into_iter().fold(0.0, f32::max);
            // What is drawn by a lane that absorbs nothing is no number.
            let share = absorption.map(|x| (x / most).max(CLEAR));
            medium.rgb("sigma_t", share).float("scale", most).rgb("albedo", [0.0; 3])
        })
        .collect()
}

/// Writes one material.
pub(super) struct Writer<'a, 'b> {
    pub(super) beside: &'a mut Beside<'b>,
    pub(super) name: &'a str,
    /// It is a part of a blend.
    pub(super) blended: bool,
}

impl Writer<'_, '_> {
    /// Notes something of this material.
    pub(super) fn note(&mut self, text: &str) {
        self.beside.note(format!("material `{}`: {text}", self.name));
    }

    pub(super) fn model(&mut self, model: &Model) -> Result<Element, ExportError> {
        Ok(match model {
            Model::Diffuse { reflectance } => two_sided(diffuse(&self.share(reflectance)?)),
            Model::Phong { reflectance, exponent } => {
                self.note("Mitsuba has no Phong lobe; this is Beckmann's of the width √(2/(n + 2))");
                let alpha = (2.0 / (exponent.max(0.0) + 2.0)).sqrt();
                let metal =
                    Element::bsdf("roughconductor").string("material", "none").string("distribution", "beckmann");
                let metal = metal.float("alpha", alpha.max(MIN_ALPHA));
                two_sided(metal.color("specular_reflectance", &self.share(reflectance)?))
            }
            Model::Mirror { reflectance } => {
                let micro = self.micro(&Roughness::Alpha([0.0; 2]))?;
                let mirror = microfacets(&micro, "ggx").string("material", "none");
                two_sided(mirror.color("specular_reflectance", &self.share(reflectance)?))
            }
            Model::Dielectric { ior, roughness, tint } => self.dielectric(*ior, roughness, tint)?,
            Model::Conductor { fresnel, roughness } => self.conductor(fresnel, roughness, "ggx")?,
            Model::CookTorrance { fresnel, roughness } => self.conductor(fresnel, roughness, "beckmann")?,
            Model::Mix(parts) => self.mixture(parts)?,
            Model::MetallicRoughness(m) => layered::metallic_roughness(self, m)?,
            Model::SpecularGlossiness(m) => layered::specular_glossiness(self, m)?,
            Model::Absorb => diffuse(&Color::Constant([0.0; 3])),
            other => {
                let (plainer, lost) = other.plainer();
                self.note(&format!("Mitsuba has {lost}"));
                self.model(&plainer)?
            }
        })
    }

    /// Mitsuba wraps both axes alike.
    pub(super) fn share(&mut self, param: &ColorParam) -> Result<Color, ExportError> {
        if let Some(crate::desc::Texture::Image { wrap: [Wrap::Repeat, b] | [b, Wrap::Repeat], .. }) =
            param.texture.map(|t| &self.beside.scene.textures[t.texture])
            && *b != Wrap::Repeat
        {
            self.note("its texture wraps along both axes as along the first");
        }
        self.beside.share(param)
    }

    pub(super) fn micro(&mut self, roughness: &Roughness) -> Result<Micro, ExportError> {
        let micro = self.beside.micro(roughness, self.name)?;
        if self.blended && micro == Micro::Smooth {
            self.note(
                "what is perfectly smooth in a blend is of α = 0.001: Mitsuba 3.9 weighs its directions as densities",
            );
            return Ok(Micro::Constant([NARROW; 2]));
        }
        Ok(micro)
    }

    /// One α that stands for all.
    pub(super) fn alpha_of(&self, micro: &Micro) -> f32 {
        match micro {
            Micro::Smooth => 0.0,
            Micro::Constant([x, y]) => (x * y).sqrt(),
            Micro::Varying(alpha) => self.beside.mean(alpha),
        }
    }

    /// Notes what microfacets lose that scatter once.
    pub(super) fn loses(&mut self, micro: &Micro) {
        if micro.loses() {
            self.note("light that its microfacets scatter more than once is lost in Mitsuba: it is darker");
        }
    }

    pub(super) fn dielectric(
        &mut self,
        ior: f32,
        roughness: &Roughness,
        tint: &ColorParam,
    ) -> Result<Element, ExportError> {
        let micro = self.micro(roughness)?;
        let glass = |kind: &str| Element::bsdf(kind).float("int_ior", ior).float("ext_ior", 1.0);
        // Rough interfaces between equals are none.
        if micro == Micro::Smooth || (ior - 1.0).abs() < 2e-3 {
            let tint = self.share(tint)?;
            return Ok(glass("dielectric").color("specular_transmittance", &tint));
        }
        let rough = alphas(glass("roughdielectric").string("distribution", "ggx"), &micro);
        if !micro.loses() {
            let tint = self.share(tint)?;
            return Ok(rough.color("specular_transmittance", &tint));
        }
        self.note(AGAIN);
        let again = fit::glass_again(self.alpha_of(&micro), ior);
        let tint = ColorParam { factor: tint.factor.map(|x| x.clamp(0.0, 1.0) * again), ..*tint };
        let tint = self.beside.radiance(&tint)?;
        let rough = rough.unbounded("specular_reflectance", &Color::Constant([again; 3]));
        Ok(rough.unbounded("specular_transmittance", &tint))
    }

    pub(super) fn conductor(
        &mut self,
        fresnel: &Fresnel,
        roughness: &Roughness,
        distribution: &str,
    ) -> Result<Element, ExportError> {
        let micro = self.micro(roughness)?;
        let f0 = match fresnel {
            Fresnel::Complex { eta, k } => return Ok(self.metal(*eta, *k, &micro, distribution)),
            Fresnel::Schlick { f0 } => self.share(f0)?,
        };
        // `principled` has Schlick's approximation, and scatters once.
        if let (Micro::Constant(alpha), "ggx") = (&micro, distribution)
            && (!micro.loses() || f0.constant().is_none())
            && let Some((roughness, anisotropy)) = stretch(*alpha)
        {
            self.loses(&micro);
            return Ok(two_sided(principled_metal(&f0, &Scalar::Constant(roughness), anisotropy)));
        }
        if let Some(f0) = f0.constant() {
            self.note("Schlick's reflectance is that of a metal with the same at normal incidence and in the mean");
            let lanes = f0.map(fit::metal);
            return Ok(self.metal(lanes.map(|l| l[0]), lanes.map(|l| l[1]), &micro, distribution));
        }
        self.loses(&micro);
        if let (Roughness::Perceptual(r), "ggx", Micro::Varying(_)) = (roughness, distribution, &micro) {
            let r = self.beside.scalar(r, Map::Same)?;
            return Ok(two_sided(principled_metal(&f0, &r, 0.0)));
        }
        self.note("its textured reflectance does not rise towards grazing angles");
        let metal = microfacets(&micro, distribution).string("material", "none");
        Ok(two_sided(metal.color("specular_reflectance", &f0)))
    }

    /// A metal of these indices, of a reflectance that makes up for what it scatters more than once.
    fn metal(&mut self, eta: [f32; 3], k: [f32; 3], micro: &Micro, distribution: &str) -> Element {
        let metal = microfacets(micro, distribution).rgb("eta", eta).rgb("k", k);
        if distribution != "ggx" || !micro.loses() {
            self.loses(micro);
            return two_sided(metal);
        }
        self.note(AGAIN);
        let f0 = [0, 1, 2].map(|i| fit::normal_reflectance(eta[i], k[i]));
        let factor = fit::scattered_again(self.alpha_of(micro), f0);
        two_sided(metal.unbounded("specular_reflectance", &Color::Constant(factor)))
    }

    /// Σ wᵢ fᵢ by blending two at a time; what the weights lack is black.
    fn mixture(&mut self, parts: &[(f32, Model)]) -> Result<Element, ExportError> {
        let (mut sum, mut mixed) = (0.0, None);
        self.blended = true;
        for (weight, part) in parts.iter().filter(|(weight, _)| *weight > 0.0) {
            let part = self.model(part)?;
            sum += weight;
            mixed = Some(match mixed {
                None => part,
                Some(before) => blend(before, part, &Scalar::Constant(weight / sum)),
            });
        }
        let black = diffuse(&Color::Constant([0.0; 3]));
        Ok(match mixed {
            None => black,
            Some(mixed) if sum < 1.0 - 1e-6 => blend(mixed, black, &Scalar::Constant(1.0 - sum)),
            Some(mixed) => mixed,
        })
    }
}

/// A metal without its indices.
fn microfacets(micro: &Micro, distribution: &str) -> Element {
    match micro {
        Micro::Smooth => Element::bsdf("conductor"),
        rough => alphas(Element::bsdf("roughconductor").string("distribution", distribution), rough),
    }
}

/// `weight` of `b`, the rest of `a`.
pub(super) fn blend(a: Element, b: Element, weight: &Scalar) -> Element {
    match weight.constant() {
        Some(w) if w <= 0.0 => a,
        Some(w) if w >= 1.0 => b,
        _ => Element::bsdf("blendbsdf").scalar("weight", weight).child(a).child(b),
    }
}

pub(super) fn two_sided(bsdf: Element) -> Element {
    Element::bsdf("twosided").child(bsdf)
}

pub(super) fn diffuse(reflectance: &Color) -> Element {
    Element::bsdf("diffuse").color("reflectance", reflectance)
}

/// GGX with Schlick's reflectance.
pub(super) fn principled_metal(f0: &Color, roughness: &Scalar, anisotropy: f32) -> Element {
    let metal = Element::bsdf("principled").color("base_color", f0).float("metallic", 1.0);
    let metal = metal.scalar("roughness", roughness);
    if anisotropy > 0.0 { metal.float("anisotropic", anisotropy) } else { metal }
}

/// Perceptual roughness and anisotropy of `principled`, α = r²/√(1 − 0.9 a) and r² √(1 − 0.9 a); `None` where it has none.
pub(super) fn stretch([x, y]: [f32; 2]) -> Option<(f32, f32)> {
    let anisotropy = (1.0 - y / x) / 0.9;
    (x.min(y) >= PRINCIPLED_ALPHA && (0.0..=1.0).contains(&anisotropy)).then(|| ((x * y).sqrt().sqrt(), anisotropy))
}

pub(super) fn alphas(bsdf: Element, micro: &Micro) -> Element {
    match micro {
        Micro::Smooth => bsdf,
        Micro::Constant([x, y]) if x == y => bsdf.float("alpha", *x),
        Micro::Constant([x, y]) => bsdf.float("alpha_u", *x).float("alpha_v", *y),
        Micro::Varying(alpha) => bsdf.scalar("alpha", alpha),
    }
}
