//! glTF's models.
//!
//! A dielectric base is made of two lobes by `coated.rs`, a metal is `principled` or, where that
//! loses light, `roughconductor`. The mixture of the two by metalness, and of
//! what they transmit, is `blendbsdf`. Sheen and coats are `principled` as a whole.

use super::super::ExportError;
use super::super::fit;
use super::super::micro::Micro;
use super::super::picture::Map;
use super::super::value::{Color, Scalar};
use super::coated::coated;
use super::material::{Writer, blend, stretch, two_sided};
use super::xml::Element;
use crate::desc::{Fresnel, MetallicRoughness, Roughness, SpecularGlossiness, Transmission};

/// The model of glTF 2.0 with what of its extensions can be said.
pub(super) fn metallic_roughness(w: &mut Writer, m: &MetallicRoughness) -> Result<Element, ExportError> {
    if m.iridescence.is_some() {
        w.note("its iridescent film is left out");
    }
    let base = w.share(&m.base_color)?;
    let metallic = w.beside.scalar(&m.metallic, Map::Same)?;
    let f0 = reflectance(w, m);
    let layers = &m.layers;
    let rough = roughness(w, m);
    let mixed = |s: &Scalar| s.constant().is_none_or(|x| x > 0.0 && x < 1.0);
    let sent = m.transmission.as_ref().map(|t| w.beside.scalar(&t.factor, Map::Same)).transpose()?;
    w.blended |= mixed(&metallic) || sent.is_some_and(|t| mixed(&t));
    let opaque = if layers.sheen.is_some() || layers.clearcoat.is_some() {
        two_sided(principled(w, m, &base, &metallic, f0)?)
    } else {
        let plastic = |w: &mut Writer| coated(w, &m.base_color, &rough, [f0; 3]);
        let metal = |w: &mut Writer| w.conductor(&Fresnel::Schlick { f0: m.base_color }, &rough, "ggx");
        match metallic.constant() {
            Some(x) if x <= 0.0 => through(w, m, plastic, f0, &base, &rough)?,
            Some(x) if x >= 1.0 => metal(w)?,
            _ => {
                let rest = through(w, m, plastic, f0, &base, &rough)?;
                blend(rest, metal(w)?, &metallic)
            }
        }
    };
    Ok(opaque)
}

/// Roughness with the anisotropy, whose direction is the tangent.
fn roughness(w: &mut Writer, m: &MetallicRoughness) -> Roughness {
    let Some(a) = &m.layers.anisotropy else { return Roughness::Perceptual(m.roughness) };
    if a.rotation != 0.0 || a.direction.is_some() {
        w.note("the direction of its anisotropy is the tangent");
    }
    Roughness::Stretched { roughness: m.roughness, strength: a.strength }
}

/// F₀ of the dielectric, as one number.
fn reflectance(w: &mut Writer, m: &MetallicRoughness) -> f32 {
    let full = if m.ior > 0.0 { ((m.ior - 1.0) / (m.ior + 1.0)).powi(2) } else { 1.0 };
    let tint = m.specular_color.factor;
    let mean = tint.iter().sum::<f32>() / 3.0;
    let grey = tint.iter().all(|x| (x - mean).abs() < 1e-3);
    if m.specular.texture.is_some() || m.specular_color.texture.is_some() || !grey {
        w.note("its dielectric reflection is grey and the same all over");
    }
    (full * mean * m.specular.factor.clamp(0.0, 1.0)).min(0.98)
}

/// What is no metal: opaque, or transmitting, or both.
fn through(
    w: &mut Writer,
    m: &MetallicRoughness,
    plastic: impl FnOnce(&mut Writer) -> Result<Element, ExportError>,
    f0: f32,
    base: &Color,
    rough: &Roughness,
) -> Result<Element, ExportError> {
    let sent = m.transmission.as_ref().filter(|t| t.factor.factor > 0.0);
    let clear = match sent {
        Some(Transmission { thin: true, .. }) => Some(sheet(w, m, f0, base)?),
        Some(_) => Some(w.dielectric(m.ior, rough, &m.base_color)?),
        None => None,
    };
    let share = match sent {
        Some(t) => w.beside.scalar(&t.factor, Map::Same)?,
        None => Scalar::Constant(0.0),
    };
    if let (Some(clear), Some(1.0)) = (&clear, share.constant()) {
        return Ok(clear.clone());
    }
    let mut opaque = plastic(w)?;
    if let Some(t) = m.diffuse_transmission.as_ref().filter(|t| t.factor.factor > 0.0) {
        w.note("what it transmits diffusely is not dimmed by its surface's reflection");
        let (color, share) = (w.share(&t.color)?, w.beside.scalar(&t.factor, Map::Same)?);
        let sheet = Element::bsdf("principledthin").color("base_color", &color).float("roughness", 1.0);
        opaque = blend(opaque, sheet.float("diff_trans", 2.0), &share);
    }
    Ok(match clear {
        Some(clear) => blend(opaque, clear, &share),
        None => opaque,
    })
}

/// A thin wall that does not bend light.
fn sheet(w: &mut Writer, m: &MetallicRoughness, f0: f32, base: &Color) -> Result<Element, ExportError> {
    match w.micro(&Roughness::Perceptual(m.roughness))? {
        Micro::Smooth => {
            // Two faces reflect 2R/(1 + R) there, and F₀ in all here.
            w.note("its thin wall reflects as two faces do that together have its reflectance at normal incidence");
            let wall =
                Element::bsdf("thindielectric").float("int_ior", fit::index(f0 / (2.0 - f0))).float("ext_ior", 1.0);
            Ok(wall.color("specular_transmittance", base))
        }
        _ => {
            w.note("its rough thin wall is that of principledthin");
            let roughness = w.beside.scalar(&m.roughness, Map::Same)?;
            let wall = Element::bsdf("principledthin").color("base_color", base).scalar("roughness", &roughness);
            Ok(wall.float("spec_trans", 1.0).float("eta", fit::index(f0)))
        }
    }
}

/// All of it in Disney's model, for what only that has.
fn principled(
    w: &mut Writer,
    m: &MetallicRoughness,
    base: &Color,
    metallic: &Scalar,
    f0: f32,
) -> Result<Element, ExportError> {
    w.note("with its layers it is Disney's model, which has other diffuse, sheen and coat lobes");
    let mut bsdf = Element::bsdf("principled").color("base_color", base).scalar("metallic", metallic);
    bsdf = bsdf.float("eta", fit::index(f0).max(1.001));
    // The longest that it has is ten to one.
    let rough = roughness(w, m);
    let stretched = match w.micro(&rough)? {
        Micro::Constant([x, y]) if x != y => stretch([x, y.max(0.1001 * x)]),
        _ => None,
    };
    bsdf = match stretched {
        Some((roughness, anisotropy)) => bsdf.float("roughness", roughness).float("anisotropic", anisotropy),
        None => {
            let roughness = w.beside.scalar(&m.roughness, Map::Same)?;
            bsdf.scalar("roughness", &roughness)
        }
    };
    if let Some(sheen) = &m.layers.sheen {
        let color = sheen.color.factor;
        bsdf = bsdf.float("sheen", color.iter().copied().fold(0.0, f32::max).clamp(0.0, 1.0));
        w.note("its sheen is white and as wide as Disney's");
    }
    if let Some(coat) = &m.layers.clearcoat {
        w.note("its clear coat is Disney's, a quarter as strong, without a normal map");
        let factor = w.beside.scalar(&coat.factor, Map::Same)?;
        // α runs from 0.1 to 0.001 there.
        let gloss = (0.1 - coat.roughness.factor.powi(2)) / 0.099;
        bsdf = bsdf.scalar("clearcoat", &factor).float("clearcoat_gloss", gloss.clamp(0.0, 1.0));
    }
    if m.transmission.as_ref().is_some_and(|t| t.factor.factor > 0.0) || m.diffuse_transmission.is_some() {
        w.note("what it transmits is left out");
    }
    Ok(bsdf)
}

/// KHR_materials_pbrSpecularGlossiness: a coat of this F₀.
pub(super) fn specular_glossiness(w: &mut Writer, m: &SpecularGlossiness) -> Result<Element, ExportError> {
    if m.specular.texture.is_some() {
        w.note("its specular colour is the same all over");
    }
    coated(w, &m.diffuse, &Roughness::Glossiness(m.glossiness), m.specular.factor)
}
