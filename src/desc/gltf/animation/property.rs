//! Properties that can be animated (glTF 2.0 Asset Object Model).

use serde_json::{Value, json};

/// What a property is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// So many numbers.
    Vector(usize),
    /// A unit quaternion.
    Rotation,
    /// A number for each morph target.
    Weights,
    /// A truth value.
    Flag,
}

/// Why a property is not animated.
pub(super) enum Unfit {
    /// The document is wrong.
    Wrong(String),
    /// Nothing is there to be animated.
    Ignored(String),
}

/// A property of the document.
pub(super) struct Property {
    /// JSON pointer.
    pub pointer: String,
    pub kind: Kind,
}

/// What pointers may animate; `*` is an index.
const PROPERTIES: [(&str, Kind); 50] = [
    ("/nodes/*/translation", Kind::Vector(3)),
    ("/nodes/*/rotation", Kind::Rotation),
    ("/nodes/*/scale", Kind::Vector(3)),
    ("/nodes/*/weights", Kind::Weights),
    ("/nodes/*/weights/*", Kind::Vector(1)),
    ("/nodes/*/extensions/KHR_node_visibility/visible", Kind::Flag),
    ("/meshes/*/weights", Kind::Weights),
    ("/meshes/*/weights/*", Kind::Vector(1)),
    ("/cameras/*/orthographic/xmag", Kind::Vector(1)),
    ("/cameras/*/orthographic/ymag", Kind::Vector(1)),
    ("/cameras/*/orthographic/znear", Kind::Vector(1)),
    ("/cameras/*/orthographic/zfar", Kind::Vector(1)),
    ("/cameras/*/perspective/aspectRatio", Kind::Vector(1)),
    ("/cameras/*/perspective/yfov", Kind::Vector(1)),
    ("/cameras/*/perspective/znear", Kind::Vector(1)),
    ("/cameras/*/perspective/zfar", Kind::Vector(1)),
    ("/extensions/KHR_lights_punctual/lights/*/color", Kind::Vector(3)),
    ("/extensions/KHR_lights_punctual/lights/*/intensity", Kind::Vector(1)),
    ("/extensions/KHR_lights_punctual/lights/*/range", Kind::Vector(1)),
    ("/extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", Kind::Vector(1)),
    ("/extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", Kind::Vector(1)),
    ("/materials/*/alphaCutoff", Kind::Vector(1)),
    ("/materials/*/emissiveFactor", Kind::Vector(3)),
    ("/materials/*/normalTexture/scale", Kind::Vector(1)),
    ("/materials/*/occlusionTexture/strength", Kind::Vector(1)),
    ("/materials/*/pbrMetallicRoughness/baseColorFactor", Kind::Vector(4)),
    ("/materials/*/pbrMetallicRoughness/metallicFactor", Kind::Vector(1)),
    ("/materials/*/pbrMetallicRoughness/roughnessFactor", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_anisotropy/anisotropyStrength", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_anisotropy/anisotropyRotation", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_clearcoat/clearcoatFactor", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor", Kind::Vector(3)),
    ("/materials/*/extensions/KHR_materials_dispersion/dispersion", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_emissive_strength/emissiveStrength", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_ior/ior", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_iridescence/iridescenceFactor", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_iridescence/iridescenceIor", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_sheen/sheenColorFactor", Kind::Vector(3)),
    ("/materials/*/extensions/KHR_materials_sheen/sheenRoughnessFactor", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_specular/specularFactor", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_specular/specularColorFactor", Kind::Vector(3)),
    ("/materials/*/extensions/KHR_materials_transmission/transmissionFactor", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_volume/attenuationColor", Kind::Vector(3)),
    ("/materials/*/extensions/KHR_materials_volume/attenuationDistance", Kind::Vector(1)),
    ("/materials/*/extensions/KHR_materials_volume/thicknessFactor", Kind::Vector(1)),
];

/// The transform of any texture of a material.
const TRANSFORM: &str = "/extensions/KHR_texture_transform/";

impl Property {
    /// The property that a pointer names.
    pub(super) fn of_pointer(pointer: &str) -> Result<Self, Unfit> {
        let transform = pointer.rsplit_once(TRANSFORM).filter(|(texture, _)| texture.starts_with("/materials/"));
        let kind = match transform {
            Some((_, "offset" | "scale")) => Some(Kind::Vector(2)),
            Some((_, "rotation")) => Some(Kind::Vector(1)),
            Some(_) => None,
            None => PROPERTIES.iter().find(|(pattern, _)| matches(pattern, pointer)).map(|(_, kind)| *kind),
        };
        match kind {
            Some(kind) => Ok(Self { pointer: pointer.into(), kind }),
            None => Err(Unfit::Ignored(format!("`{pointer}` is nothing that can be animated"))),
        }
    }

    /// The node one of whose weights this is.
    fn node_of_weight(&self) -> Option<&str> {
        self.pointer.rsplit_once('/')?.0.strip_suffix("/weights").filter(|node| node.starts_with("/nodes/"))
    }

    /// How many weights [`Property::write`] copies from a mesh.
    pub(super) fn copies(&self, document: &Value) -> usize {
        self.node_of_weight().and_then(|node| inherited(document, node)).map_or(0, |(count, _)| count)
    }

    /// Gives it a value. Only what stands in an object or list of the document has one.
    pub(super) fn write(&self, document: &mut Value, numbers: &[f64]) -> Result<(), Unfit> {
        if let Some(x) = numbers.iter().find(|x| !x.is_finite()) {
            return Err(Unfit::Wrong(format!("gives `{}` the value {x}; expected finite numbers", self.pointer)));
        }
        let value = match self.kind {
            Kind::Flag => json!(numbers[0] != 0.0),
            Kind::Vector(1) => json!(numbers[0]),
            Kind::Vector(_) | Kind::Rotation | Kind::Weights => json!(numbers),
        };
        let absent = || Unfit::Ignored(format!("`{}` is not in the document and cannot be animated", self.pointer));
        let (parent, key) = self.pointer.rsplit_once('/').ok_or_else(absent)?;
        // One weight of a node that inherits them: the others become its own.
        if let Some((node, (count, stated))) = self.node_of_weight().and_then(|n| Some((n, inherited(document, n)?))) {
            let weights = stated.map_or_else(|| json!(vec![0.0; count]), |list| json!(list));
            if let Some(Value::Object(node)) = document.pointer_mut(node) {
                node.insert("weights".into(), weights);
            }
        }
        match document.pointer_mut(parent) {
            Some(Value::Object(object)) => {
                object.insert(key.into(), value);
            }
            Some(Value::Array(list)) => {
                *key.parse().ok().and_then(|i: usize| list.get_mut(i)).ok_or_else(absent)? = value;
            }
            _ => return Err(absent()),
        }
        Ok(())
    }
}

/// The weights that a node inherits: their number, and the list of its mesh, if that has one.
fn inherited<'d>(document: &'d Value, node: &str) -> Option<(usize, Option<&'d Vec<Value>>)> {
    let node = document.pointer(node).filter(|node| node.get("weights").is_none())?;
    let mesh = document.get("meshes")?.get(usize::try_from(node.get("mesh")?.as_u64()?).ok()?)?;
    let stated = mesh.get("weights").and_then(Value::as_array);
    let targets = || mesh.pointer("/primitives/0/targets").and_then(Value::as_array).map(Vec::len);
    Some((stated.map(Vec::len).or_else(targets)?, stated))
}

/// Whether a pointer has the segments of a pattern.
fn matches(pattern: &str, pointer: &str) -> bool {
    let index = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
    let (mut a, mut b) = (pattern.split('/'), pointer.split('/'));
    loop {
        match (a.next(), b.next()) {
            (None, None) => return true,
            (Some("*"), Some(segment)) if index(segment) => {}
            (Some(x), Some(y)) if x == y => {}
            _ => return false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pointers_are_matched_whole() {
        assert!(matches("/nodes/*/weights/*", "/nodes/12/weights/3"));
        for pointer in [
            "/nodes/12/weights",
            "/nodes//weights/3",
            "/nodes/-1/weights/3",
            "nodes/1/weights/3",
            "/nodes/1/weights/3/",
        ] {
            assert!(!matches("/nodes/*/weights/*", pointer), "{pointer}");
        }
        let kind = |pointer: &str| Property::of_pointer(pointer).ok().map(|p| p.kind);
        let texture = "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform";
        assert_eq!(kind(&format!("{texture}/offset")), Some(Kind::Vector(2)));
        assert_eq!(kind(&format!("{texture}/texCoord")), None);
        assert_eq!(kind("/accessors/0/count"), None);
        assert_eq!(kind("/nodes/0/matrix"), None);
    }
}
