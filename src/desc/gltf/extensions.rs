//! Which extensions are known, and what becomes of them: one table, for what is refused, what is noted and what
//! `radianza info --conformance` says.

use super::Source;
use super::notes::Notes;
use crate::desc::Error;
use Status::{Approximated, Carried, Honoured, Ignored};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::path::Path;

/// What becomes of an extension here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// What it says reaches the picture, as it says it.
    Honoured,
    /// It reaches the picture, otherwise than it says: how.
    Approximated(&'static str),
    /// It says nothing about the picture; the image's header keeps it.
    Carried,
    /// The file is read as if it were absent.
    Ignored,
}

/// An extension that is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extension {
    /// Its name in `extensionsUsed`.
    pub name: &'static str,
    /// What it adds to a file.
    pub adds: &'static str,
    /// What becomes of that.
    pub status: Status,
}

/// An extension that a file names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Use {
    /// Its name.
    pub name: String,
    /// Whether it is in `extensionsRequired`.
    pub required: bool,
}

const fn row(name: &'static str, status: Status, adds: &'static str) -> Extension {
    Extension { name, adds, status }
}

/// Every extension of glTF 2.0 that Khronos has ratified, and others that files use.
pub const EXTENSIONS: &[Extension] = &[
    row("EXT_lights_ies", Honoured, "measured distributions of lights"),
    row("EXT_lights_image_based", Honoured, "an environment of prefiltered images"),
    row("EXT_mesh_gpu_instancing", Honoured, "many places of a mesh in one node"),
    row("EXT_meshopt_compression", Honoured, "compressed buffers"),
    row("EXT_texture_avif", Ignored, "images in AVIF"),
    row("EXT_texture_webp", Honoured, "images in WebP"),
    row("KHR_animation_pointer", Honoured, "animation of any property"),
    row("KHR_draco_mesh_compression", Honoured, "compressed geometry"),
    row("KHR_lights_punctual", Honoured, "point, spot and directional lights"),
    row("KHR_materials_anisotropy", Honoured, "highlights that are longer one way"),
    row("KHR_materials_clearcoat", Honoured, "a clear coat over the material"),
    row("KHR_materials_diffuse_transmission", Honoured, "light scattered through thin sheets"),
    row("KHR_materials_dispersion", Honoured, "an index of refraction over wavelength"),
    row("KHR_materials_emissive_strength", Honoured, "emission above 1"),
    row("KHR_materials_ior", Honoured, "the index of refraction"),
    row("KHR_materials_iridescence", Honoured, "interference in a thin film"),
    row("KHR_materials_pbrSpecularGlossiness", Honoured, "the older model of specular and glossiness"),
    row("KHR_materials_sheen", Honoured, "the soft rim of cloth"),
    row("KHR_materials_specular", Honoured, "strength and colour of the dielectric reflection"),
    row("KHR_materials_transmission", Honoured, "light refracted through the surface"),
    row(
        "KHR_materials_unlit",
        Approximated(
            "the material emits its base colour on both sides, reflects nothing, and lights what is around it",
        ),
        "materials without lighting",
    ),
    row("KHR_materials_variants", Honoured, "other materials for the same meshes"),
    row("KHR_materials_volume", Honoured, "what light passes inside closed meshes"),
    row("KHR_mesh_quantization", Honoured, "vertices of fewer bits"),
    row("KHR_node_visibility", Honoured, "nodes that are not shown"),
    row("KHR_texture_basisu", Honoured, "images in KTX2 with Basis Universal"),
    row("KHR_texture_transform", Honoured, "texture coordinates that are moved, turned and scaled"),
    row("KHR_xmp", Carried, "metadata, as written before KHR_xmp_json_ld"),
    row("KHR_xmp_json_ld", Carried, "metadata: authors, rights, dates"),
    row("MSFT_texture_dds", Ignored, "images in DDS"),
];

/// What is known of the extension `name`.
pub fn extension(name: &str) -> Option<&'static Extension> {
    EXTENSIONS.iter().find(|extension| extension.name == name)
}

/// Whether a file that requires the extension `name` is read as it means.
pub fn honoured(name: &str) -> bool {
    extension(name).is_some_and(|extension| extension.status != Ignored)
}

impl Extension {
    /// One word.
    pub fn word(&self) -> &'static str {
        match self.status {
            Honoured => "honoured",
            Approximated(_) => "approximated",
            Carried => "carried",
            Ignored => "ignored",
        }
    }
}

impl Use {
    /// What becomes of it, in one word.
    pub fn word(&self) -> &'static str {
        extension(&self.name).map_or("ignored", Extension::word)
    }

    /// What becomes of it, in a sentence.
    pub fn sentence(&self) -> String {
        match extension(&self.name) {
            None => "unknown; the file is read as if it were absent".into(),
            Some(Extension { adds, status, .. }) => match status {
                Honoured => adds.to_string(),
                Approximated(how) => format!("{adds}: {how}"),
                Carried => format!("{adds}; in the header of every image"),
                Ignored => format!("{adds}; the file is read as if it were absent"),
            },
        }
    }
}

/// Refuses a document that requires what is not honoured, and notes what it only uses.
pub(super) fn check(document: &Value, file: &Path, notes: &mut Notes) -> Result<(), Error> {
    let required = names(document, "extensionsRequired", file)?;
    let refused: Vec<_> = required.iter().enumerate().filter(|(_, name)| !honoured(name)).collect();
    if let Some((first, _)) = refused.first() {
        let list: Vec<_> = refused.iter().map(|(_, name)| format!("`{name}`")).collect();
        let message = format!("requires {}, which is not honoured yet", list.join(", "));
        return Err(Error::unsupported(file, format!("/extensionsRequired/{first}"), message));
    }
    for name in names(document, "extensionsUsed", file)?.into_iter().filter(|name| !honoured(name)) {
        let what = extension(name).map_or(String::new(), |e| format!(" ({})", e.adds));
        notes.say(format!("`{name}` is not honoured yet{what}; the file is read as if it were absent"));
    }
    Ok(())
}

/// The extensions that a document names, in its order, each once; what is required is used, whether it says so or not.
pub(super) fn uses(document: &Value, file: &Path) -> Result<Vec<Use>, Error> {
    let required = names(document, "extensionsRequired", file)?;
    let mut uses: Vec<Use> = Vec::new();
    for &name in names(document, "extensionsUsed", file)?.iter().chain(&required) {
        if !uses.iter().any(|known| known.name == name) {
            uses.push(Use { name: name.into(), required: required.contains(&name) });
        }
    }
    Ok(uses)
}

impl Source<'_> {
    /// What the extension `name` says of the object at `place`, whose untyped extensions `others` are.
    pub(super) fn extension<T: DeserializeOwned>(
        &self,
        others: Option<&Map<String, Value>>,
        name: &str,
        place: &str,
    ) -> Result<Option<T>, Error> {
        let Some(value) = others.and_then(|others| others.get(name)) else { return Ok(None) };
        match T::deserialize(value) {
            Ok(extension) => Ok(Some(extension)),
            Err(e) => Err(self.invalid(format!("{place}/extensions/{name}"), e.to_string())),
        }
    }

    /// Whether the document says that it uses the extension `name`.
    pub(super) fn uses(&self, name: &str) -> bool {
        self.root.extensions_used.iter().chain(&self.root.extensions_required).any(|used| used == name)
    }
}

/// The list of strings under `key`; empty where the document has none.
fn names<'a>(document: &'a Value, key: &str, file: &Path) -> Result<Vec<&'a str>, Error> {
    let Some(list) = document.get(key) else { return Ok(Vec::new()) };
    let Value::Array(list) = list else {
        return Err(Error::invalid(file, format!("/{key}"), format!("is {}; expected a list of names", kind(list))));
    };
    let name = |(i, value): (usize, &'a Value)| {
        let wrong = || Error::invalid(file, format!("/{key}/{i}"), format!("is {}; expected a name", kind(value)));
        value.as_str().ok_or_else(wrong)
    };
    list.iter().enumerate().map(name).collect()
}

/// What sort of JSON value it is, for messages.
pub(super) fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "a truth value",
        Value::Number(_) => "a number",
        Value::String(_) => "a string",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_stands_once_and_in_order() {
        assert!(EXTENSIONS.is_sorted_by(|a, b| a.name < b.name));
        assert!(honoured("KHR_materials_ior") && honoured("KHR_xmp_json_ld") && !honoured("KHR_node_visibilit"));
        assert!(!honoured("ACME_cloud"));
    }
}
