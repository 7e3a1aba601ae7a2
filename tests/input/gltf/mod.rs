//! The glTF reader: every feature on a document built for it, hostile files, mutated files, and real ones.

mod assets;
mod compressed;
mod document;
mod files;
mod formats;
mod geometry;
mod hostile;
mod layers;
mod lights;
mod materials;
mod mutations;
mod optics;
mod pose;
mod quantized;
mod skinned;
mod tangents;
mod textures;
mod variants;
mod world;
