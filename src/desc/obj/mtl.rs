//! Material libraries of OBJ files. The format describes Phong's model of 1975; what it says is carried to the models
//! here as follows.
//!
//! * `illum 4`, `6`, `7`, `9` (refraction): dielectric with index `Ni` and tint `Tf`;
//! * `illum 3`, `5` or `8` (ray-traced reflection) on black `Kd`: mirror of reflectance `Ks`;
//! * `Pr` or `Pm`: metallic-roughness of base colour `Kd`;
//! * `Ks` not black and `illum` ≥ 2 or absent: metallic-roughness of base colour `Kd` whose reflectance at normal
//!   incidence is `Ks` and whose GGX α = √(2/(`Ns` + 2)) has the width of the Phong lobe (Walter et al. 2007);
//! * everything else: diffuse of reflectance `Kd`.
//!
//! `Ke` is emitted radiance, `d`, `Tr` and `map_d` coverage, `norm` a normal map. Reflectances above 1 are cut at 1.

use super::numbers;
use crate::desc::files::{self, Folder};
use crate::desc::image_file::Grant;
use crate::desc::{
    Alpha, ColorParam, Emission, Error, Image, Layers, Material, MetallicRoughness, Model, NormalMap, Roughness,
    ScalarParam, Scene, Sides, Texture, TextureRef, Wrap, image_file,
};
use glam::Affine2;
use std::path::Path;

/// A material as written.
#[derive(Clone, Debug, Default)]
struct Statements {
    name: String,
    kd: Option<[f32; 3]>,
    ks: [f32; 3],
    ke: [f32; 3],
    tf: Option<[f32; 3]>,
    ns: f32,
    ni: Option<f32>,
    d: Option<f32>,
    illum: Option<u32>,
    pr: Option<f32>,
    pm: Option<f32>,
    map_kd: Option<TextureRef>,
    map_ke: Option<TextureRef>,
    map_d: Option<TextureRef>,
    norm: Option<TextureRef>,
}

/// Materials by name, in order; their textures are appended to the scene.
pub(super) fn parse(
    text: &str,
    path: &Path,
    folder: &Folder,
    pixels: &Grant,
    scene: &mut Scene,
) -> Result<Vec<(String, Material)>, Error> {
    let mut materials: Vec<Statements> = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or("").trim();
        let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        if word == "newmtl" {
            materials.push(Statements { name: rest.trim().into(), ..Statements::default() });
        } else if let Some(material) = materials.last_mut() {
            let mut texture = |srgb| texture(rest, srgb, folder, pixels, scene);
            statement(material, word, rest, &mut texture)
                .map_err(|message| Error::invalid(path, (i + 1).to_string(), format!("`{word}`: {message}")))?;
        }
    }
    Ok(materials.into_iter().map(|m| (m.name.clone(), m.material(scene))).collect())
}

/// Reads one statement; those that have no meaning here are passed over.
fn statement(
    m: &mut Statements,
    word: &str,
    rest: &str,
    texture: &mut dyn FnMut(bool) -> Result<TextureRef, String>,
) -> Result<(), String> {
    let one = || numbers(rest, 1..=1).map(|n| n[0]);
    match word {
        "Kd" => m.kd = Some(rgb(rest)?),
        "Ks" => m.ks = rgb(rest)?,
        "Ke" => m.ke = rgb(rest)?,
        "Tf" => m.tf = Some(rgb(rest)?),
        "Ns" => m.ns = one()?.max(0.0),
        "Ni" => m.ni = Some(one()?),
        "d" => m.d = Some(numbers(rest.trim_start_matches("-halo"), 1..=1)?[0]),
        "Tr" => m.d = Some(1.0 - one()?),
        "Pr" => m.pr = Some(one()?),
        "Pm" => m.pm = Some(one()?),
        "illum" => m.illum = Some(one()? as u32),
        "map_Kd" => m.map_kd = Some(texture(true)?),
        "map_Ke" => m.map_ke = Some(texture(true)?),
        "map_d" => m.map_d = Some(texture(false)?),
        "norm" => m.norm = Some(texture(false)?),
        _ => {}
    }
    Ok(())
}

/// One number or three, each at least 0.
fn rgb(text: &str) -> Result<[f32; 3], String> {
    let n = numbers(text, 1..=3)?;
    if let Some(x) = n.iter().find(|x| **x < 0.0) {
        return Err(format!("found {x}, expected numbers ≥ 0"));
    }
    Ok(match n[..] {
        [r, g, b] => [r, g, b],
        _ => [n[0]; 3],
    })
}

/// `[-option values] file`: the scene's texture of this file. Options are passed over.
fn texture(text: &str, srgb: bool, folder: &Folder, pixels: &Grant, scene: &mut Scene) -> Result<TextureRef, String> {
    let mut rest = text.trim();
    while rest.starts_with('-') {
        // An option takes the words up to the next option that are numbers or a switch; the file follows.
        rest = rest.split_once(char::is_whitespace).map_or("", |(_, r)| r.trim_start());
        while let Some((word, after)) = rest.split_once(char::is_whitespace) {
            if word.parse::<f32>().is_err() && !matches!(word, "on" | "off" | "r" | "g" | "b" | "m" | "l" | "z") {
                break;
            }
            rest = after.trim_start();
        }
    }
    let name = files::plain(&rest.replace('\\', "/"));
    let image = match scene.images.iter().position(|i| i.name == name) {
        Some(image) => image,
        None => {
            let bytes = folder.read(&name, "").map_err(|e| e.message)?;
            let image: Image = image_file::decode(&name, &bytes).map_err(|e| format!("`{name}` {e}"))?;
            pixels.read(bytes.len());
            pixels.pay(image.pixels.memory()).map_err(|e| format!("`{name}`: {e}"))?;
            scene.images.push(image.into());
            scene.images.len() - 1
        }
    };
    let srgb = srgb && scene.images[image].pixels.are_codes();
    let wanted = Texture::Image { image, srgb, wrap: [Wrap::Repeat; 2], nearest: false };
    let texture = scene.textures.iter().position(|t| *t == wanted).unwrap_or_else(|| {
        scene.textures.push(wanted);
        scene.textures.len() - 1
    });
    Ok(TextureRef { texture, uv_set: 0, transform: Affine2::IDENTITY })
}

impl Statements {
    /// The material that the statements mean.
    fn material(&self, scene: &mut Scene) -> Material {
        let mut cut = false;
        let mut reflectance = |c: [f32; 3]| {
            c.map(|x| {
                cut |= x > 1.0;
                x.min(1.0)
            })
        };
        let (kd, ks) = (reflectance(self.kd.unwrap_or([0.8; 3])), reflectance(self.ks));
        let tint = reflectance(self.tf.unwrap_or([1.0; 3]));
        if cut {
            scene.notes.push(format!("material `{}`: reflectances above 1 were cut at 1", self.name));
        }
        // A texture stands in place of the constant where that is black, as exporters write it.
        let factor = if self.map_kd.is_some() && kd == [0.0; 3] { [1.0; 3] } else { kd };
        let base = ColorParam { factor, texture: self.map_kd, vertex_color: true };
        let black = |c: [f32; 3]| c == [0.0; 3];

        let alpha = (2.0 / (self.ns + 2.0)).sqrt();
        let model = match self.illum {
            Some(4 | 6 | 7 | 9) => Model::Dielectric {
                ior: self.ni.filter(|n| *n > 0.0).unwrap_or(1.5),
                roughness: Roughness::Perceptual(ScalarParam::constant(0.0)),
                tint: ColorParam::constant(if black(tint) { [1.0; 3] } else { tint }),
            },
            Some(3 | 5 | 8) if black(base.factor) => Model::Mirror { reflectance: ColorParam::constant(ks) },
            _ if self.pr.is_some() || self.pm.is_some() => {
                let unit = |x: Option<f32>, default: f32| ScalarParam::constant(x.unwrap_or(default).clamp(0.0, 1.0));
                gloss(base, unit(self.pm, 0.0), unit(self.pr, 0.5), [1.0; 3])
            }
            Some(0 | 1) => Model::Diffuse { reflectance: base },
            _ if black(ks) => Model::Diffuse { reflectance: base },
            _ => {
                let roughness = ScalarParam::constant(alpha.sqrt());
                gloss(base, ScalarParam::constant(0.0), roughness, ks.map(|k| k / 0.04))
            }
        };

        let mut material = Material::new(self.name.clone(), model);
        let glow = if self.map_ke.is_some() && black(self.ke) { [1.0; 3] } else { self.ke };
        if !black(glow) {
            let radiance = ColorParam { factor: glow, texture: self.map_ke, vertex_color: false };
            material.emission = Some(Emission { radiance, sides: Sides::Front, coat: None });
        }
        material.normal_map = self.norm.map(|texture| NormalMap { texture, scale: 1.0 });
        let refracts = matches!(material.model, Model::Dielectric { .. });
        let coverage =
            ScalarParam { factor: self.d.unwrap_or(1.0).clamp(0.0, 1.0), texture: self.map_d.map(|t| (t, 0)) };
        if !refracts && (coverage.factor < 1.0 || coverage.texture.is_some()) {
            material.alpha = Alpha::Blend { coverage };
        }
        material
    }
}

/// Metallic-roughness whose dielectric reflects 0.04 × `specular_color` at normal incidence.
fn gloss(base_color: ColorParam, metallic: ScalarParam, roughness: ScalarParam, specular_color: [f32; 3]) -> Model {
    Model::MetallicRoughness(Box::new(MetallicRoughness {
        base_color,
        metallic,
        roughness,
        ior: 1.5,
        specular: ScalarParam::constant(1.0),
        specular_color: ColorParam::constant(specular_color),
        transmission: None,
        layers: Layers::default(),
        diffuse_transmission: None,
        iridescence: None,
    }))
}
