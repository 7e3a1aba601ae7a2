//! The glTF reader: every feature on a document built for it, hostile files, mutated files, and real ones.

#[path = "gltf/assets.rs"]
mod assets;
#[path = "gltf/compressed.rs"]
mod compressed;
#[path = "gltf/document.rs"]
mod document;
#[path = "gltf/files.rs"]
mod files;
#[path = "gltf/formats.rs"]
mod formats;
#[path = "gltf/geometry.rs"]
mod geometry;
#[path = "gltf/hostile.rs"]
mod hostile;
#[path = "gltf/layers.rs"]
mod layers;
#[path = "gltf/lights.rs"]
mod lights;
#[path = "gltf/materials.rs"]
mod materials;
#[path = "gltf/mutations.rs"]
mod mutations;
#[path = "gltf/optics.rs"]
mod optics;
#[path = "gltf/pose.rs"]
mod pose;
#[path = "gltf/quantized.rs"]
mod quantized;
#[path = "gltf/skinned.rs"]
mod skinned;
#[path = "common/skip.rs"]
mod skip;
#[path = "gltf/tangents.rs"]
mod tangents;
#[path = "gltf/textures.rs"]
mod textures;
#[path = "gltf/variants.rs"]
mod variants;
#[path = "gltf/world.rs"]
mod world;
