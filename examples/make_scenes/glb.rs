//! Binary glTF, put together list by list.

use super::Result;
use super::lathe::Mesh;
use glam::Vec3;
use image::{ImageFormat, RgbImage};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::io::Cursor;

/// The lists of a glTF document and its binary chunk.
#[derive(Default)]
pub(super) struct Builder {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    images: Vec<Value>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
}

impl Builder {
    /// Appends bytes as a buffer view; returns its index.
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        self.views.push(json!({ "buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len() }));
        self.binary.extend(bytes);
        self.views.len() - 1
    }

    fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize, range: Option<[Vec3; 2]>) -> usize {
        let view = self.view(bytes);
        let mut accessor = json!({ "bufferView": view, "componentType": component, "type": kind, "count": count });
        if let Some([min, max]) = range {
            accessor["min"] = json!(min.to_array());
            accessor["max"] = json!(max.to_array());
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// A texture of an embedded PNG; texture, image and index are the same number.
    pub(super) fn texture(&mut self, image: &RgbImage) -> Result<usize> {
        let mut png = Cursor::new(Vec::new());
        image.write_to(&mut png, ImageFormat::Png)?;
        let view = self.view(png.get_ref());
        self.images.push(json!({ "bufferView": view, "mimeType": "image/png" }));
        Ok(self.images.len() - 1)
    }

    pub(super) fn material(&mut self, material: Value) -> usize {
        self.materials.push(material);
        self.materials.len() - 1
    }

    pub(super) fn mesh(&mut self, name: &str, mesh: &Mesh, material: usize) -> usize {
        const FLOAT: u32 = 5126;
        const UNSIGNED_SHORT: u32 = 5123;
        let bytes3 =
            |list: &[Vec3]| list.iter().flat_map(|v| v.to_array()).flat_map(f32::to_le_bytes).collect::<Vec<_>>();
        let min = mesh.positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let max = mesh.positions.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        let n = mesh.positions.len();
        let positions = self.accessor(&bytes3(&mesh.positions), FLOAT, "VEC3", n, Some([min, max]));
        let normals = self.accessor(&bytes3(&mesh.normals), FLOAT, "VEC3", n, None);
        let uv: Vec<u8> = mesh.uv.iter().flat_map(|v| v.to_array()).flat_map(f32::to_le_bytes).collect();
        let uv = self.accessor(&uv, FLOAT, "VEC2", n, None);
        let indices: Vec<u8> = mesh.indices.iter().copied().flat_map(u16::to_le_bytes).collect();
        let indices = self.accessor(&indices, UNSIGNED_SHORT, "SCALAR", mesh.indices.len(), None);
        self.meshes.push(json!({ "name": name, "primitives": [{
            "attributes": { "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uv },
            "indices": indices, "material": material }] }));
        self.meshes.len() - 1
    }

    /// Extensions of the only primitive of a mesh.
    pub(super) fn extend_primitive(&mut self, mesh: usize, extensions: Value) {
        self.meshes[mesh]["primitives"][0]["extensions"] = extensions;
    }

    pub(super) fn node(&mut self, node: Value) -> usize {
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// Header, JSON chunk, binary chunk (glTF 2.0, section 4.4), with a perspective camera and the document's extensions.
    pub(super) fn finish(mut self, roots: &[usize], view: &Value, extensions: Value) -> Result<Vec<u8>> {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let textures: Vec<Value> = (0..self.images.len()).map(|i| json!({ "source": i })).collect();
        let mut document = json!({
            "asset": { "version": "2.0", "generator": "examples/make_scenes" },
            "scene": 0, "scenes": [{ "nodes": roots }], "nodes": self.nodes, "meshes": self.meshes,
            "materials": self.materials, "textures": textures, "images": self.images, "accessors": self.accessors,
            "bufferViews": self.views, "buffers": [{ "byteLength": self.binary.len() }],
            "cameras": [{ "type": "perspective", "perspective": view }],
            "extensions": extensions,
        });
        for key in ["textures", "images"] {
            if document[key].as_array().is_some_and(Vec::is_empty) {
                document.as_object_mut().map(|lists| lists.remove(key));
            }
        }
        let mut used = BTreeSet::new();
        extensions_of(&document, &mut used);
        document["extensionsUsed"] = json!(used);
        let mut text = serde_json::to_vec(&document)?;
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut file = Vec::new();
        let length = 12 + 8 + text.len() + 8 + self.binary.len();
        for word in [0x4654_6c67, 2, u32::try_from(length)?, u32::try_from(text.len())?, 0x4e4f_534a] {
            file.extend(word.to_le_bytes());
        }
        file.extend(&text);
        for word in [u32::try_from(self.binary.len())?, 0x004e_4942] {
            file.extend(word.to_le_bytes());
        }
        file.extend(&self.binary);
        Ok(file)
    }
}

/// Names of all extensions that stand somewhere in a value.
fn extensions_of(value: &Value, used: &mut BTreeSet<String>) {
    let inner: Vec<&Value> = match value {
        Value::Object(map) => {
            if let Some(Value::Object(extensions)) = map.get("extensions") {
                used.extend(extensions.keys().cloned());
            }
            map.values().collect()
        }
        Value::Array(list) => list.iter().collect(),
        _ => Vec::new(),
    };
    inner.into_iter().for_each(|value| extensions_of(value, used));
}
