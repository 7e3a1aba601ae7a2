//! Random images, and the ways of looking into them.

use super::draw::Draw;
use crate::desc::{Image, NormalMap, Pixels, ScalarParam, Scene, Texture, TextureRef, Wrap};
use glam::{Affine2, Vec2, Vec3};
use std::sync::Arc;

/// Images that the textures of a scene look into, by their number in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Images {
    /// Colours, with a coverage of 0, 1 and between in alpha.
    colors: usize,
    /// Numbers from a half to 1 in every channel, of 16 bits.
    numbers: usize,
    /// Unit normals, bent by up to 50 degrees.
    normals: usize,
}

impl Images {
    /// Adds them to a scene.
    pub(super) fn new(scene: &mut Scene, draw: &mut Draw) -> Self {
        let mut add = |name: &str, size: [u32; 2], pixels: Pixels| {
            scene.images.push(Arc::new(Image { name: name.into(), size, pixels }));
            scene.images.len() - 1
        };
        let byte = |x: f32| (255.0 * x.clamp(0.0, 1.0)).round() as u8;
        let color = |draw: &mut Draw| {
            let [r, g, b] = draw.rgb(0.1, 1.0).map(byte);
            let alpha = match draw.below(3) {
                0 => 0,
                1 => 255,
                _ => byte(draw.unit()),
            };
            [r, g, b, alpha]
        };
        let number = |draw: &mut Draw| std::array::from_fn(|_| (65535.0 * draw.between(0.5, 1.0)) as u16);
        let normal = |draw: &mut Draw| {
            let n = (Vec3::Z + draw.within(Vec3::new(0.8, 0.8, 0.0))).normalize();
            let [x, y, z] = (0.5 * (n + Vec3::ONE)).to_array().map(byte);
            [x, y, z, 255]
        };
        Self {
            colors: add("colors.png", [8, 4], Pixels::Rgba8((0..32).map(|_| color(draw)).collect())),
            numbers: add("numbers.png", [4, 8], Pixels::Rgba16((0..32).map(|_| number(draw)).collect())),
            normals: add("normals.png", [8, 8], Pixels::Rgba8((0..64).map(|_| normal(draw)).collect())),
        }
    }

    /// A look into the colours.
    pub(super) fn color(&self, scene: &mut Scene, draw: &mut Draw, uv_set: usize) -> TextureRef {
        look(scene, draw, uv_set, self.colors, true)
    }

    /// A number below `factor` from a channel of the numbers.
    pub(super) fn number(&self, scene: &mut Scene, draw: &mut Draw, uv_set: usize, factor: f32) -> ScalarParam {
        let channel = draw.below(4);
        ScalarParam { factor, texture: Some((look(scene, draw, uv_set, self.numbers, false), channel)) }
    }

    /// The alpha of the colours.
    pub(super) fn coverage(&self, scene: &mut Scene, draw: &mut Draw, uv_set: usize) -> ScalarParam {
        ScalarParam { factor: 1.0, texture: Some((look(scene, draw, uv_set, self.colors, false), 3)) }
    }

    /// A normal map.
    pub(super) fn normals(&self, scene: &mut Scene, draw: &mut Draw, uv_set: usize) -> NormalMap {
        let scale = draw.between(0.3, 1.0);
        NormalMap { texture: look(scene, draw, uv_set, self.normals, false), scale }
    }
}

/// A checker of two colours.
pub(super) fn checker(scene: &mut Scene, draw: &mut Draw, uv_set: usize) -> TextureRef {
    let scale = [draw.between(1.0, 8.0), draw.between(1.0, 8.0)];
    add(scene, draw, uv_set, Texture::Checker { even: [0.9, 0.6, 0.3], odd: [0.2, 0.5, 0.8], scale })
}

fn look(scene: &mut Scene, draw: &mut Draw, uv_set: usize, image: usize, srgb: bool) -> TextureRef {
    let wrap = [0, 1].map(|_| draw.pick(&[Wrap::Repeat, Wrap::Mirror, Wrap::Clamp]));
    let nearest = draw.chance(0.3);
    add(scene, draw, uv_set, Texture::Image { image, srgb, wrap, nearest })
}

/// Adds a texture, placed at random half of the time.
fn add(scene: &mut Scene, draw: &mut Draw, uv_set: usize, texture: Texture) -> TextureRef {
    scene.textures.push(texture);
    let transform = match draw.chance(0.5) {
        true => Affine2::IDENTITY,
        false => Affine2::from_scale_angle_translation(
            Vec2::new(draw.between(0.5, 2.0), draw.between(0.5, 2.0)),
            draw.between(-1.0, 1.0),
            Vec2::new(draw.unit(), draw.unit()),
        ),
    };
    TextureRef { texture: scene.textures.len() - 1, uv_set, transform }
}
