//! Look-ups in images.

use crate::desc::{Image, Pixels, Wrap};
use glam::{DVec4, Vec2, Vec4};
use std::sync::{Arc, LazyLock};

/// An image with its way of looking into it. UV (0, 0) is the outer corner of the first pixel; texel i has its centre
/// at (i + ½)/n.
#[derive(Clone, Debug)]
pub(super) struct ImageTexture {
    image: Arc<Image>,
    /// Code → linear, of RGB and of alpha, as long as a channel has codes.
    rgb: &'static [f32],
    alpha: &'static [f32],
    wrap: [Wrap; 2],
    nearest: bool,
}

/// Codes → linear: proportional, and by the sRGB curve (IEC 61966-2-1). Of 8 bits and of 16.
static DECODE_8: LazyLock<[Vec<f32>; 2]> = LazyLock::new(|| curves(255));
static DECODE_16: LazyLock<[Vec<f32>; 2]> = LazyLock::new(|| curves(65_535));

fn curves(greatest: u32) -> [Vec<f32>; 2] {
    let codes = || (0..=greatest).map(|i| f64::from(i) / f64::from(greatest));
    let srgb = |c: f64| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
    [codes().map(|c| c as f32).collect(), codes().map(|c| srgb(c) as f32).collect()]
}

impl ImageTexture {
    /// Bytes of pixels.
    pub(super) fn memory(&self) -> usize {
        self.image.pixels.memory()
    }

    /// Texels across and down.
    pub(super) fn size(&self) -> Vec2 {
        Vec2::from(self.image.size.map(|n| n as f32))
    }

    pub(super) fn new(image: Arc<Image>, srgb: bool, wrap: [Wrap; 2], nearest: bool) -> Self {
        let curves = match image.pixels {
            Pixels::Rgba8(_) | Pixels::Rgba32F(_) => &DECODE_8,
            Pixels::Rgba16(_) => &DECODE_16,
        };
        Self { image, rgb: &curves[srgb as usize], alpha: &curves[0], wrap, nearest }
    }

    /// Linear RGBA at finite coordinates.
    #[inline]
    pub(super) fn at(&self, uv: Vec2) -> Vec4 {
        match &self.image.pixels {
            Pixels::Rgba8(pixels) => self.filtered(pixels, uv, |codes| self.decoded(codes)),
            Pixels::Rgba16(pixels) => self.filtered(pixels, uv, |codes| self.decoded(codes)),
            Pixels::Rgba32F(pixels) => self.filtered(pixels, uv, Vec4::from),
        }
    }

    /// Linear RGBA of codes.
    #[inline(always)]
    fn decoded(&self, [r, g, b, a]: [impl Into<usize>; 4]) -> Vec4 {
        Vec4::new(self.rgb[r.into()], self.rgb[g.into()], self.rgb[b.into()], self.alpha[a.into()])
    }

    /// Bilinear or constant between these `pixels`.
    #[inline(always)]
    fn filtered<P: Copy>(&self, pixels: &[P], uv: Vec2, linear: impl Fn(P) -> Vec4) -> Vec4 {
        let [width, height] = self.image.size.map(|n| n as i32);
        let texel = |x: usize, y: usize| linear(pixels[y * width as usize + x]);
        let x = into_period(uv.x, self.wrap[0]) * width as f32;
        let y = into_period(uv.y, self.wrap[1]) * height as f32;
        if self.nearest {
            return texel(wrap(x as i32, width, self.wrap[0]), wrap(y as i32, height, self.wrap[1]));
        }

        // The four texels whose centres surround the point.
        let (x, y) = (x - 0.5, y - 0.5);
        let [x0, y0] = [x, y].map(floor);
        let (s, t) = (x - x0 as f32, y - y0 as f32);
        let columns = [0, 1].map(|i| wrap(x0 + i, width, self.wrap[0]));
        let rows = [0, 1].map(|i| wrap(y0 + i, height, self.wrap[1]));
        let row = |y| texel(columns[0], y).lerp(texel(columns[1], y), s);
        row(rows[0]).lerp(row(rows[1]), t)
    }

    /// Mean over all texels.
    pub(super) fn mean(&self) -> Vec4 {
        let [width, height] = self.image.size.map(|n| n as usize);
        let sum: DVec4 =
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| self.texel(x, y).as_dvec4()).sum();
        (sum / (width * height) as f64).as_vec4()
    }

    /// Linear RGBA of one texel.
    fn texel(&self, x: usize, y: usize) -> Vec4 {
        let i = y * self.image.size[0] as usize + x;
        match &self.image.pixels {
            Pixels::Rgba8(pixels) => self.decoded(pixels[i]),
            Pixels::Rgba16(pixels) => self.decoded(pixels[i]),
            Pixels::Rgba32F(pixels) => Vec4::from(pixels[i]),
        }
    }
}

/// A coordinate of the texture's plane to the same place within [0, 1], or [0, 2] where it is mirrored: whatever its
/// size, the product with the number of texels then stays in range.
#[inline]
fn into_period(u: f32, mode: Wrap) -> f32 {
    match mode {
        Wrap::Repeat => u - floor_of_any(u),
        Wrap::Mirror => u - 2.0 * floor_of_any(0.5 * u),
        Wrap::Clamp => u.clamp(0.0, 1.0),
    }
}

/// The greatest integer not above `x`, which an i32 can say. By a cast: `f32::floor` is a call where there is no SSE 4.1.
#[inline(always)]
fn floor(x: f32) -> i32 {
    let whole = x as i32;
    whole - i32::from(whole as f32 > x)
}

/// The greatest integer not above any finite `x`.
#[inline(always)]
fn floor_of_any(x: f32) -> f32 {
    // From 2²³ on all are whole.
    if x.abs() < 8_388_608.0 { floor(x) as f32 } else { x }
}

/// Texel index of a coordinate brought [`into_period`], which may lie one outside it, to [0, n).
#[inline]
fn wrap(i: i32, n: i32, mode: Wrap) -> usize {
    let i = match mode {
        Wrap::Repeat if i < 0 => i + n,
        Wrap::Repeat if i >= n => i - n,
        Wrap::Repeat => i,
        Wrap::Mirror => {
            let i = if i < n { i } else { 2 * n - 1 - i };
            if i < 0 { -1 - i } else { i }
        }
        Wrap::Clamp => i.clamp(0, n - 1),
    };
    i as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A column of n texels of value 0, 1, …
    fn ramp(n: u32, mode: Wrap, nearest: bool) -> impl Fn(f32) -> f32 {
        let pixels = Pixels::Rgba32F((0..n).map(|i| [i as f32; 4]).collect());
        let image = Arc::new(Image { name: String::new(), size: [1, n], pixels });
        let texture = ImageTexture::new(image, false, [mode; 2], nearest);
        move |v| texture.at(Vec2::new(0.3, v)).y
    }

    #[test]
    fn texel_centres_have_the_texel_s_value() {
        for mode in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
            let at = ramp(4, mode, false);
            for i in 0..4 {
                assert_eq!(at((i as f32 + 0.5) / 4.0), i as f32);
            }
            assert_eq!(at(0.5), 1.5);
        }
    }

    #[test]
    fn outside_is_repeated_mirrored_or_clamped() {
        let (repeat, mirror, clamp) =
            (ramp(4, Wrap::Repeat, false), ramp(4, Wrap::Mirror, false), ramp(4, Wrap::Clamp, false));
        assert_eq!([repeat(1.375), repeat(-0.625), repeat(0.0), repeat(1.0)], [1.0, 1.0, 1.5, 1.5]);
        assert_eq!([mirror(1.375), mirror(-0.375), mirror(2.375), mirror(0.0), mirror(2.0)], [2.0, 1.0, 1.0, 0.0, 0.0]);
        assert_eq!([clamp(1.375), clamp(-0.625), clamp(0.0), clamp(0.25)], [3.0, 0.0, 0.0, 0.5]);
    }

    #[test]
    fn nearest_takes_the_texel_that_covers_the_point() {
        let (repeat, mirror, clamp) =
            (ramp(4, Wrap::Repeat, true), ramp(4, Wrap::Mirror, true), ramp(4, Wrap::Clamp, true));
        assert_eq!([repeat(0.2), repeat(0.3), repeat(0.99), repeat(-0.1), repeat(1.0)], [0.0, 1.0, 3.0, 3.0, 0.0]);
        assert_eq!([mirror(1.1), mirror(-0.1), clamp(1.0), clamp(7.0), clamp(-7.0)], [3.0, 0.0, 3.0, 3.0, 0.0]);
    }
}
