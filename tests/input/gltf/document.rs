//! Small glTF documents, built piece by piece.

use radianza::desc::{Error, Mesh, Scene, Shape, gltf};
use serde_json::{Value, json};
use std::path::Path;

pub(crate) const U8: u32 = 5121;
pub(crate) const U16: u32 = 5123;
pub(crate) const U32: u32 = 5125;
pub(crate) const F32: u32 = 5126;

/// A document and its one buffer.
#[derive(Clone)]
pub(crate) struct Document {
    pub(crate) json: Value,
    pub(crate) bin: Vec<u8>,
}

impl Document {
    /// One mesh of one primitive with these positions, in one node of one scene.
    pub(crate) fn mesh(positions: &[[f32; 3]]) -> Self {
        let mut d = Self {
            json: json!({
                "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
                "meshes": [{ "primitives": [{ "attributes": {} }] }],
                "buffers": [], "bufferViews": [], "accessors": [],
            }),
            bin: Vec::new(),
        };
        d.attribute("POSITION", "VEC3", positions);
        d
    }

    /// A right triangle in the plane z = 0.
    pub(crate) fn triangle() -> Self {
        Self::mesh(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    }

    /// The triangle with this material, and UV for its textures.
    pub(crate) fn material(material: Value) -> Self {
        let mut d = Self::triangle();
        d.attribute("TEXCOORD_0", "VEC2", &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        d.set("/materials", json!([material]));
        d.set("/meshes/0/primitives/0/material", json!(0));
        d
    }

    /// Puts `value` at a JSON pointer, whose parents are made where they are missing.
    pub(crate) fn set(&mut self, pointer: &str, value: Value) -> &mut Self {
        let mut at = &mut self.json;
        for key in pointer.split('/').skip(1) {
            at = match at {
                Value::Array(list) => {
                    let i: usize = key.parse().unwrap();
                    if i == list.len() {
                        list.push(json!({}));
                    }
                    &mut list[i]
                }
                _ => &mut at[key],
            };
        }
        *at = value;
        self
    }

    /// Takes the member at a JSON pointer away.
    pub(crate) fn remove(&mut self, pointer: &str) -> &mut Self {
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        self.json.pointer_mut(parent).unwrap().as_object_mut().unwrap().remove(key).unwrap();
        self
    }

    fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    /// A new view of these bytes, at a multiple of 4.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = json!({ "buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len() });
        self.bin.extend(bytes);
        self.push("bufferViews", view)
    }

    /// A new accessor of a new view of these bytes.
    pub(crate) fn accessor(&mut self, component: u32, kind: &str, count: usize, bytes: &[u8]) -> usize {
        let view = self.view(bytes);
        self.push("accessors", json!({ "bufferView": view, "componentType": component, "type": kind, "count": count }))
    }

    /// A float attribute of the first primitive; returns its accessor.
    pub(crate) fn attribute<const N: usize>(&mut self, name: &str, kind: &str, values: &[[f32; N]]) -> usize {
        let bytes = bytes_of(values.as_flattened());
        let accessor = self.accessor(F32, kind, values.len(), &bytes);
        self.json["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
        accessor
    }

    /// Indices of the first primitive; returns their accessor.
    pub(crate) fn indices(&mut self, component: u32, indices: &[u32]) -> usize {
        let width = match component {
            U8 => 1,
            U16 => 2,
            _ => 4,
        };
        let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()[..width].to_vec()).collect();
        let accessor = self.accessor(component, "SCALAR", indices.len(), &bytes);
        self.json["meshes"][0]["primitives"][0]["indices"] = json!(accessor);
        accessor
    }

    /// A texture with a PNG of these RGBA pixels; returns its index.
    pub(crate) fn texture(&mut self, size: [u32; 2], pixels: &[[u8; 4]]) -> usize {
        let view = self.view(&png(size, pixels));
        for list in ["images", "textures"] {
            if self.json[list].is_null() {
                self.json[list] = json!([]);
            }
        }
        let image = self.push("images", json!({ "bufferView": view, "mimeType": "image/png" }));
        self.push("textures", json!({ "source": image }))
    }

    /// The document's text, with its buffer's length in it.
    pub(crate) fn text(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if json["buffers"] == json!([]) {
            json["buffers"] = json!([{ "byteLength": self.bin.len() }]);
        }
        serde_json::to_vec(&json).unwrap()
    }

    /// As a binary file.
    pub(crate) fn glb(&self) -> Vec<u8> {
        glb(&self.text(), &self.bin)
    }

    pub(crate) fn read(&self) -> Result<Scene, Error> {
        parse(&self.glb())
    }

    /// Reads it, and takes the only mesh.
    pub(crate) fn read_mesh(&self) -> Mesh {
        mesh(&self.read().unwrap(), 0).clone()
    }

    /// Reads it, and asserts that it fails here with this in the message.
    #[track_caller]
    pub(crate) fn fails(&self, place: &str, message: &str) {
        match self.read() {
            Ok(_) => panic!("no error; expected one at {place} that says {message:?}"),
            Err(e) => {
                assert_eq!(e.place, place, "{e}");
                assert!(e.message.contains(message), "{e}; expected {message:?}");
            }
        }
    }
}

/// Packs a text and a buffer into a binary file.
pub(crate) fn glb(text: &[u8], bin: &[u8]) -> Vec<u8> {
    let mut body = Vec::new();
    for (kind, data, pad) in [(b"JSON", text, b' '), (b"BIN\0", bin, 0)] {
        let size = data.len().next_multiple_of(4);
        body.extend((size as u32).to_le_bytes());
        body.extend(kind);
        body.extend(data);
        body.resize(body.len() + size - data.len(), pad);
    }
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((body.len() as u32 + 12).to_le_bytes());
    file.extend(body);
    file
}

/// Reads bytes that refer to no other file.
pub(crate) fn parse(bytes: &[u8]) -> Result<Scene, Error> {
    let file = Path::new("test.glb");
    gltf::parse(bytes, file, &|name, place| Err(Error::missing(file, place, format!("`{name}` is not there"))))
}

/// A PNG file of these RGBA pixels.
pub(crate) fn png(size: [u32; 2], pixels: &[[u8; 4]]) -> Vec<u8> {
    let mut file = std::io::Cursor::new(Vec::new());
    let image = image::RgbaImage::from_raw(size[0], size[1], pixels.as_flattened().to_vec()).unwrap();
    image.write_to(&mut file, image::ImageFormat::Png).unwrap();
    file.into_inner()
}

pub(crate) fn bytes_of(floats: &[f32]) -> Vec<u8> {
    floats.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// Shape `index`, which is a mesh.
pub(crate) fn mesh(scene: &Scene, index: usize) -> &Mesh {
    match &scene.shapes[index] {
        Shape::Mesh(mesh) => mesh,
        other => panic!("{other:?} is no mesh"),
    }
}

/// Whether a note holds all of these words.
pub(crate) fn noted(scene: &Scene, words: &str) -> bool {
    scene.notes.iter().any(|n| n.contains(words))
}
