//! Files beside a written scene, from which its meshes and images are read to the bit.

use crate::desc::{Image, Mesh, Pixels};
use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Layer, LayerAttributes, Vec2, WritableImage};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use std::io::Cursor;

/// Ending and content of a file that holds the image; `None` where no format gives back its pixels: OpenEXR multiplies
/// colours by alpha, which is not undone to the bit.
pub(super) fn image(image: &Image) -> Option<(&'static str, Vec<u8>)> {
    let [width, height] = image.size;
    let png = |bytes: &[u8], color| {
        let mut out = Vec::new();
        PngEncoder::new(&mut out).write_image(bytes, width, height, color).ok().map(|()| ("png", out))
    };
    match &image.pixels {
        Pixels::Rgba8(pixels) => png(pixels.as_flattened(), ExtendedColorType::Rgba8),
        Pixels::Rgba16(pixels) => {
            // The encoder takes the machine's byte order.
            let bytes: Vec<u8> = pixels.as_flattened().iter().flat_map(|code| code.to_ne_bytes()).collect();
            png(&bytes, ExtendedColorType::Rgba16)
        }
        Pixels::Rgba32F(pixels) => {
            if pixels.iter().any(|p| p[3] > 0.0 && p[3] < 1.0) {
                return None;
            }
            exr(image.size, pixels).map(|bytes| ("exr", bytes))
        }
    }
}

/// An OpenEXR of these channels, compressed without loss.
fn exr(size: [u32; 2], pixels: &[[f32; 4]]) -> Option<Vec<u8>> {
    let samples = |c: usize| FlatSamples::F32(pixels.iter().map(|p| p[c]).collect());
    let channels = ["R", "G", "B", "A"].into_iter().enumerate();
    let channels = channels.map(|(c, name)| AnyChannel::new(name, samples(c))).collect();
    let size = Vec2(size[0] as usize, size[1] as usize);
    let channels = AnyChannels::sort(channels);
    let layer = Layer::new(size, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, channels);
    let mut out = Cursor::new(Vec::new());
    exr::prelude::Image::from_layer(layer).write().non_parallel().to_buffered(&mut out).ok()?;
    Some(out.into_inner())
}

/// A binary PLY of everything that the mesh has. Texture coordinates have names of their own, `u0 v0 u1 v1`, under which
/// v counts downwards as here.
pub(super) fn ply(mesh: &Mesh) -> Vec<u8> {
    let Mesh { positions, indices, normals, tangents, uv, colors } = mesh;
    let mut properties = vec!["x", "y", "z"];
    for (present, names) in [
        (!normals.is_empty(), &["nx", "ny", "nz"][..]),
        (!tangents.is_empty(), &["tx", "ty", "tz", "tw"]),
        (!uv[0].is_empty(), &["u0", "v0"]),
        (!uv[1].is_empty(), &["u1", "v1"]),
        (!colors.is_empty(), &["red", "green", "blue", "alpha"]),
    ] {
        properties.extend(names.iter().filter(|_| present));
    }
    let mut out = String::from("ply\nformat binary_little_endian 1.0\n");
    out += &format!("element vertex {}\n", positions.len());
    properties.iter().for_each(|name| out += &format!("property float {name}\n"));
    out += &format!("element face {}\nproperty list uchar uint vertex_indices\nend_header\n", indices.len());

    let mut out = out.into_bytes();
    let mut put = |numbers: &[f32]| numbers.iter().for_each(|x| out.extend(x.to_le_bytes()));
    for i in 0..positions.len() {
        put(&positions[i].to_array());
        normals.get(i).iter().for_each(|n| put(&n.to_array()));
        tangents.get(i).iter().for_each(|t| put(&t.to_array()));
        uv.iter().filter_map(|uv| uv.get(i)).for_each(|uv| put(&uv.to_array()));
        colors.get(i).iter().for_each(|c| put(&c.to_array()));
    }
    for triangle in indices {
        out.push(3);
        triangle.iter().for_each(|i| out.extend(i.to_le_bytes()));
    }
    out
}
