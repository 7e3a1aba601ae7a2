//! Places on a material that show its extremes.

use crate::desc::parameter::Value;
use crate::desc::{Material, Pixels, ScalarParam, Scene, Shape, Texture, TextureRef};
use glam::{Vec2, Vec4};

/// Where on a surface a material is looked at.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Place {
    /// In words: `least roughness`; empty where the material is the same everywhere.
    pub name: String,
    /// Texture coordinates, both sets.
    pub uv: [Vec2; 2],
    /// Vertex colour.
    pub color: Vec4,
}

/// Something that a material reads from a texture.
struct Reading {
    what: &'static str,
    texture: TextureRef,
    /// One channel, or the sum of red, green and blue.
    channel: Option<usize>,
}

/// Most pixels of an image that are looked at.
const MOST_PIXELS: usize = 1 << 22;

/// Places of `material`, the most telling first: for every texture that its scattering reads, a texel of about the mean
/// value, and those of the least and the greatest; for vertex colours, those of the meshes that wear it. All other
/// textures are read at the same coordinates.
pub(super) fn places(scene: &Scene, material: &Material, index: usize) -> Vec<Place> {
    let (readings, vertex_color) = readings(material);
    let mut places: Vec<Place> = Vec::new();
    let found: Vec<_> = readings.iter().filter_map(|r| Some((r.what, extremes(scene, r)?))).collect();
    for (which, word) in ["mean", "greatest", "least"].into_iter().enumerate() {
        for (what, uv) in &found {
            let place = Place { name: format!("{word} {what}"), uv: [uv[which]; 2], color: Vec4::ONE };
            if !places.iter().any(|p| p.uv == place.uv) {
                places.push(place);
            }
        }
    }
    if vertex_color {
        places.extend(colors(scene, index));
    }
    if places.is_empty() {
        places.push(Place { name: String::new(), uv: [Vec2::ZERO; 2], color: Vec4::ONE });
    }
    places
}

/// What the scattering of a material reads from textures, colours first, and whether vertex colours vary it.
fn readings(material: &Material) -> (Vec<Reading>, bool) {
    let (mut colors, mut numbers, mut vertex_color) = (Vec::new(), Vec::new(), false);
    material.model.clone().visit(&mut |parameter| {
        let what = parameter.name;
        match parameter.value {
            Value::Color(color) => {
                vertex_color |= color.vertex_color;
                colors.extend(color.texture.map(|texture| Reading { what, texture, channel: None }));
            }
            Value::Scalar(ScalarParam { texture, .. }) | Value::Between(texture) => {
                numbers.extend(texture.map(|(texture, c)| Reading { what, texture, channel: Some(c) }));
            }
            Value::Rgb(_) | Value::Number(_) | Value::Directions(_) | Value::Normals(_) => {}
        }
    });
    colors.extend(numbers);
    (colors, vertex_color)
}

/// Texture coordinates where a reading is about its mean, the greatest and the least; `None` where no coordinates lead
/// there.
fn extremes(scene: &Scene, reading: &Reading) -> Option<[Vec2; 3]> {
    let uv = match scene.textures.get(reading.texture.texture)? {
        Texture::Checker { even, odd, scale } => {
            let of = |rgb: &[f32; 3]| reading.channel.map_or(rgb.iter().sum::<f32>(), |c| rgb[c.min(2)]);
            let square = |i: f32| Vec2::new((i + 0.5) / scale[0], 0.5 / scale[1]);
            let (greatest, least) = if of(odd) > of(even) { (1.0, 0.0) } else { (0.0, 1.0) };
            [square(greatest), square(greatest), square(least)]
        }
        Texture::Image { image, .. } => {
            let image = scene.images.get(*image)?;
            let [width, height] = image.size.map(|n| n as usize);
            let value = |i: usize| match &image.pixels {
                Pixels::Rgba8(pixels) => sum(pixels[i].map(f32::from), reading.channel),
                Pixels::Rgba16(pixels) => sum(pixels[i].map(f32::from), reading.channel),
                Pixels::Rgba32F(pixels) => sum(pixels[i], reading.channel),
            };
            // Every pixel, or of great images some of each row and column.
            let step = (width * height).div_ceil(MOST_PIXELS) | 1;
            let all = || (0..width * height).step_by(step).map(|i| (i, value(i))).filter(|(_, v)| v.is_finite());
            let (n, total) = all().fold((0.0, 0.0), |(n, total), (_, v)| (n + 1.0, total + f64::from(v)));
            let mean = (total / n) as f32;
            let mean = all().min_by(|a, b| (a.1 - mean).abs().total_cmp(&(b.1 - mean).abs()))?;
            let greatest = all().max_by(|a, b| a.1.total_cmp(&b.1))?;
            let least = all().min_by(|a, b| a.1.total_cmp(&b.1))?;
            let centre = |(i, _): (usize, f32)| {
                Vec2::new(((i % width) as f32 + 0.5) / width as f32, ((i / width) as f32 + 0.5) / height as f32)
            };
            [mean, greatest, least].map(centre)
        }
    };
    let back = reading.texture.transform.inverse();
    let uv = uv.map(|uv| back.transform_point2(uv));
    uv.iter().all(|uv| uv.is_finite()).then_some(uv)
}

fn sum(rgba: [f32; 4], channel: Option<usize>) -> f32 {
    channel.map_or(rgba[0] + rgba[1] + rgba[2], |c| rgba[c.min(3)])
}

/// The brightest and the darkest vertex that wears the material.
fn colors(scene: &Scene, material: usize) -> Vec<Place> {
    let worn = scene.objects.iter().filter(|o| o.material == material);
    let meshes = worn.filter_map(|o| match scene.shapes.get(o.shape) {
        Some(Shape::Mesh(mesh)) => Some(&mesh.colors),
        _ => None,
    });
    let all: Vec<Vec4> = meshes.flatten().copied().filter(|c| c.is_finite()).collect();
    let key = |c: &&Vec4| c.truncate().element_sum();
    let brightest = all.iter().max_by(|a, b| key(a).total_cmp(&key(b)));
    let darkest = all.iter().min_by(|a, b| key(a).total_cmp(&key(b)));
    let place = |(name, color): (&str, &Vec4)| Place { name: name.into(), uv: [Vec2::ZERO; 2], color: *color };
    let mut places: Vec<Place> = [("brightest vertex colour", brightest), ("darkest vertex colour", darkest)]
        .into_iter()
        .filter_map(|(name, color)| Some((name, color?)))
        .map(place)
        .collect();
    places.dedup_by(|a, b| a.color == b.color);
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::desc::{ColorParam, Fresnel, Image, Model, Roughness, Wrap};
    use crate::texture::Textures;
    use glam::Affine2;
    use std::sync::Arc;

    #[test]
    fn extreme_texels_are_found_through_a_transform() {
        let pixels = Pixels::Rgba8(vec![[9, 10, 0, 255], [9, 200, 0, 255], [9, 90, 0, 255], [9, 100, 0, 255]]);
        let texture = TextureRef {
            texture: 0,
            uv_set: 1,
            transform: Affine2::from_scale_angle_translation(Vec2::new(2.0, 3.0), 0.3, Vec2::new(0.1, -4.0)),
        };
        let rough = Roughness::Perceptual(ScalarParam { factor: 1.0, texture: Some((texture, 1)) });
        let f0 = ColorParam::constant([1.0; 3]);
        let material = Material::new("m", Model::Conductor { fresnel: Fresnel::Schlick { f0 }, roughness: rough });
        let scene = Scene {
            images: vec![Arc::new(Image { name: "i".into(), size: [2, 2], pixels })],
            textures: vec![Texture::Image { image: 0, srgb: false, wrap: [Wrap::Repeat; 2], nearest: false }],
            ..Scene::default()
        };
        let textures = Textures::new(&scene);
        let found = places(&scene, &material, 0);
        let names: Vec<&str> = found.iter().map(|p| &*p.name).collect();
        assert_eq!(names, ["mean roughness", "greatest roughness", "least roughness"]);
        for (place, value) in found.iter().zip([100.0, 200.0, 10.0]) {
            let found = textures.lookup(&texture, &place.uv).y;
            assert!((found * 255.0 - value).abs() < 0.1, "{place:?}: {found}");
        }
    }
}
