//! Functions of UV: images and checkers, in linear RGBA.
//!
//! # Filters
//!
//! Between texels an image is bilinear or constant, as the author says: this is the function L or f that is integrated. That is
//! all the filtering there is. A pixel on which many texels fall is no special case: each of its samples looks the image up
//! at its own point, so that the mean over samples estimates the integral over the pixel, ∫ w(x) L(x) dx with the pixel
//! filter w, without bias: it neither aliases nor blurs, and its error is known. A mip level would put a mean over some
//! square of texels in the place of each sample: another function, and a wrong one wherever what is looked up enters the
//! light not linearly (roughness, normals, coverage). So `minFilter` of glTF is not used, and levels beside the
//! first are not read. Row I1 of the battery holds this against the closed form.

mod image;

use crate::desc::{self, Alpha, ScalarParam, TextureRef};
use glam::{Vec2, Vec3, Vec4};
use image::ImageTexture;

/// The textures of a scene. Pixels are shared with the description, not copied, and keep their 8 or 16 bits.
#[derive(Clone, Debug, Default)]
pub struct Textures {
    textures: Vec<Texture>,
}

#[derive(Clone, Debug)]
enum Texture {
    Image(ImageTexture),
    Checker { even: Vec4, odd: Vec4, scale: Vec2 },
}

impl Textures {
    /// All textures of a scene whose indices are in range, as readers guarantee.
    pub fn new(scene: &desc::Scene) -> Self {
        let compile = |texture: &desc::Texture| match *texture {
            desc::Texture::Image { image, srgb, wrap, nearest } => {
                Texture::Image(ImageTexture::new(scene.images[image].clone(), srgb, wrap, nearest))
            }
            desc::Texture::Checker { even, odd, scale } => Texture::Checker {
                even: Vec3::from(even).extend(1.0),
                odd: Vec3::from(odd).extend(1.0),
                scale: scale.into(),
            },
        };
        Self { textures: scene.textures.iter().map(compile).collect() }
    }

    /// Linear RGBA at a point with these texture coordinates. What is not finite counts as 0.
    #[inline]
    pub fn lookup(&self, t: &TextureRef, uv: &[Vec2; 2]) -> Vec4 {
        let uv = t.transform.transform_point2(uv[t.uv_set.min(1)]);
        let finite = |x: f32| if x.is_finite() { x } else { 0.0 };
        self.textures[t.texture].at(Vec2::new(finite(uv.x), finite(uv.y)))
    }

    /// A number in \[0, 1\] at a point with these texture coordinates; NaN counts as 0.
    #[inline]
    pub fn scalar(&self, p: &ScalarParam, uv: &[Vec2; 2]) -> f32 {
        let texture = match &p.texture {
            None => 1.0,
            Some((t, channel)) => self.lookup(t, uv).to_array()[(*channel).min(3)],
        };
        (p.factor * texture).max(0.0).clamp(0.0, 1.0)
    }

    /// Probability that a surface is there, at a point with these texture coordinates and this vertex colour: 1 where it is
    /// opaque, 0 or 1 for masks, coverage × vertex alpha in between.
    pub fn coverage(&self, alpha: &Alpha, uv: &[Vec2; 2], color: Vec4) -> f32 {
        let vertex = if color.w.is_finite() { color.w.clamp(0.0, 1.0) } else { 1.0 };
        match alpha {
            Alpha::Opaque => 1.0,
            Alpha::Mask { coverage, cutoff } => f32::from(self.scalar(coverage, uv) * vertex >= *cutoff),
            Alpha::Blend { coverage } => self.scalar(coverage, uv) * vertex,
        }
    }

    /// Linear RGBA averaged over the texture's unit square (of a checker: over the plane). Looks at every pixel.
    pub fn mean(&self, texture: usize) -> Vec4 {
        match &self.textures[texture] {
            Texture::Image(image) => image.mean(),
            Texture::Checker { even, odd, .. } => 0.5 * (*even + *odd),
        }
    }

    /// Steps per unit of u and v: texels of an image, squares of a checker.
    pub fn resolution(&self, texture: usize) -> Vec2 {
        match &self.textures[texture] {
            Texture::Image(image) => image.size(),
            Texture::Checker { scale, .. } => scale.abs(),
        }
    }

    /// Bytes of pixels; images that several textures share count for each.
    pub fn memory(&self) -> usize {
        self.textures.iter().map(|t| if let Texture::Image(image) = t { image.memory() } else { 0 }).sum()
    }

    /// Number of textures.
    pub fn len(&self) -> usize {
        self.textures.len()
    }

    /// True where there is none.
    pub fn is_empty(&self) -> bool {
        self.textures.is_empty()
    }
}

impl Texture {
    #[inline]
    fn at(&self, uv: Vec2) -> Vec4 {
        match self {
            Self::Image(image) => image.at(uv),
            Self::Checker { even, odd, scale } => {
                let square = (uv * scale).floor();
                // Parity in floats: squares far away have no i32. Beyond f32 it is infinite, and even.
                let parity = |x: f32| x - 2.0 * (0.5 * x).floor();
                if parity(square.x) + parity(square.y) == 1.0 { *odd } else { *even }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::desc::{Image, Pixels, Wrap};
    use glam::{Affine2, vec2};
    use proptest::prelude::*;
    use std::sync::Arc;

    fn textures(texture: desc::Texture, size: [u32; 2], pixels: Pixels) -> Textures {
        let image = Arc::new(Image { name: "test".into(), size, pixels });
        Textures::new(&desc::Scene { textures: vec![texture], images: vec![image], ..Default::default() })
    }

    fn whole(uv_set: usize) -> TextureRef {
        TextureRef { texture: 0, uv_set, transform: Affine2::IDENTITY }
    }

    #[test]
    fn srgb_is_decoded_before_it_is_filtered() {
        let texture = |srgb| desc::Texture::Image { image: 0, srgb, wrap: [Wrap::Clamp; 2], nearest: false };
        let pixels = || Pixels::Rgba8(vec![[0, 0, 188, 0], [255, 0, 188, 255]]);
        let middle = |srgb| textures(texture(srgb), [2, 1], pixels()).lookup(&whole(0), &[vec2(0.5, 0.3); 2]);
        // IEC 61966-2-1: 188/255 → 0.502886…
        let expected = Vec4::new(0.5, 0.0, 0.502_886_5, 0.5);
        assert!(middle(true).abs_diff_eq(expected, 1e-6), "{}", middle(true));
        assert!(middle(false).abs_diff_eq(Vec4::new(0.5, 0.0, 188.0 / 255.0, 0.5), 1e-6));
        let mean = textures(texture(true), [2, 1], pixels()).mean(0);
        assert!(mean.abs_diff_eq(expected, 1e-6), "{mean}");
    }

    #[test]
    fn checker_alternates_on_both_sides_of_zero() {
        let checker = desc::Texture::Checker { even: [1.0; 3], odd: [0.0; 3], scale: [2.0, 4.0] };
        let t = textures(checker, [1, 1], Pixels::Rgba32F(vec![[0.0; 4]]));
        let red = |u, v| t.lookup(&whole(1), &[Vec2::ZERO, vec2(u, v)]).x;
        assert_eq!(
            [red(0.1, 0.1), red(0.6, 0.1), red(0.6, 0.3), red(-0.1, 0.1), red(-0.1, -0.1)],
            [1., 0., 1., 0., 1.]
        );
        assert_eq!(t.mean(0), Vec4::new(0.5, 0.5, 0.5, 1.0));
    }

    #[test]
    fn coordinates_are_transformed() {
        let checker = desc::Texture::Checker { even: [1.0; 3], odd: [0.0; 3], scale: [1.0, 1.0] };
        let t = textures(checker, [1, 1], Pixels::Rgba32F(vec![[0.0; 4]]));
        let moved = TextureRef { transform: Affine2::from_translation(vec2(1.0, 0.0)), ..whole(0) };
        assert_eq!(t.lookup(&moved, &[vec2(0.5, 0.5); 2]).x, 0.0);
    }

    proptest! {
        #[test]
        fn any_coordinates_survive(bits in any::<[u32; 2]>(), wrap in 0..3usize, nearest in any::<bool>()) {
            let wrap = [[Wrap::Repeat, Wrap::Mirror, Wrap::Clamp][wrap]; 2];
            let uv = [Vec2::from(bits.map(f32::from_bits)); 2];
            let image = desc::Texture::Image { image: 0, srgb: true, wrap, nearest };
            let pixels = Pixels::Rgba32F((0..15).map(|i| [i as f32; 4]).collect());
            let found = textures(image, [3, 5], pixels).lookup(&whole(0), &uv);
            prop_assert!(found.cmpge(Vec4::ZERO).all() && found.cmple(Vec4::splat(14.0)).all(), "{uv:?}: {found}");
            let checker = desc::Texture::Checker { even: [1.0; 3], odd: [0.0; 3], scale: [1e30, 3.0] };
            let found = textures(checker, [3, 5], Pixels::Rgba32F(vec![[0.0; 4]; 15])).lookup(&whole(0), &uv);
            prop_assert!(found.is_finite());
        }
    }
}
