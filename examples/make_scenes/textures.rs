//! Small images by noise and patterns.

use image::{Rgb, RgbImage};
use radianza::sampler::hash;

/// A number in [0, 1) for a point of the integer lattice.
fn lattice(x: i64, y: i64, seed: u64) -> f64 {
    (hash(&[x as u64, y as u64, seed]) >> 11) as f64 / (1u64 << 53) as f64
}

/// Value noise in [0, 1) with cells of size 1, repeating after `period` cells.
fn noise(x: f64, y: f64, period: i64, seed: u64) -> f64 {
    let (x0, y0) = (x.floor(), y.floor());
    let fade = |t: f64| t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    let (s, t) = (fade(x - x0), fade(y - y0));
    let at = |i: i64, j: i64| lattice((x0 as i64 + i).rem_euclid(period), (y0 as i64 + j).rem_euclid(period), seed);
    let row = |j| at(0, j) + s * (at(1, j) - at(0, j));
    row(0) + t * (row(1) - row(0))
}

/// Octaves of noise, each of half the size and half the height, in [0, 1); (x, y) in [0, 1)², repeating.
fn octaves(x: f64, y: f64, first: i64, count: u32, seed: u64) -> f64 {
    let total: f64 = (0..count).map(|o| 0.5f64.powi(o as i32 + 1)).sum();
    let sum: f64 = (0..count)
        .map(|o| {
            let n = first << o;
            noise(x * n as f64, y * n as f64, n, seed + o as u64) * 0.5f64.powi(o as i32 + 1)
        })
        .sum();
    sum / total
}

/// An image of a function of (u, v) at pixel centres, RGB in [0, 1] as stored.
fn draw(width: u32, height: u32, color: impl Fn(f64, f64) -> [f64; 3]) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| {
        let rgb = color((x as f64 + 0.5) / width as f64, (y as f64 + 0.5) / height as f64);
        Rgb(rgb.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8))
    })
}

fn mix(a: [f64; 3], b: [f64; 3], t: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * t)
}

/// Floorboards along u, eight of them across v, each with its own tone, grain and joint.
pub(super) fn planks(size: u32) -> RgbImage {
    draw(size, size, |u, v| {
        let board = (v * 8.0).floor();
        let across = v * 8.0 - board;
        let tone = lattice(board as i64, 0, 1);
        let joint = (u + lattice(board as i64, 1, 1)).fract();
        let grain = octaves((u * 0.25 + tone).fract(), v, 16, 3, 7 + board as u64);
        let gap = across < 0.03 || !(0.004..=0.996).contains(&joint);
        let wood = mix([0.52, 0.34, 0.2], [0.72, 0.53, 0.34], 0.6 * tone + 0.4 * grain);
        if gap { mix(wood, [0.12, 0.08, 0.05], 0.8) } else { wood }
    })
}

/// A woven rug: diamonds within a border.
pub(super) fn rug(size: u32) -> RgbImage {
    let (red, blue, cream) = ([0.55, 0.13, 0.12], [0.13, 0.2, 0.38], [0.86, 0.8, 0.66]);
    draw(size, size, |u, v| {
        let edge = u.min(v).min(1.0 - u).min(1.0 - v);
        let diamond = ((u * 6.0).fract() - 0.5).abs() + ((v * 6.0).fract() - 0.5).abs();
        let pattern = match diamond {
            d if d < 0.18 => cream,
            d if d < 0.38 => blue,
            _ => red,
        };
        let color = if edge < 0.03 {
            blue
        } else if edge < 0.06 {
            cream
        } else {
            pattern
        };
        let thread = if (u * size as f64) as u32 % 2 == (v * size as f64) as u32 % 2 { 1.0 } else { 0.88 };
        color.map(|c| c * thread)
    })
}

/// Rings and bands: something to hang on a wall.
pub(super) fn painting(width: u32, height: u32) -> RgbImage {
    let palette = [[0.9, 0.75, 0.3], [0.8, 0.3, 0.2], [0.2, 0.4, 0.55], [0.93, 0.9, 0.82], [0.15, 0.16, 0.2]];
    draw(width, height, |u, v| {
        let (x, y) = (u * width as f64 / height as f64, v);
        let ring = |cx: f64, cy: f64, r: f64| ((x - cx).hypot(y - cy) / r * 5.0) as usize;
        let rings = [ring(0.45, 0.45, 0.38), ring(1.05, 0.6, 0.33)];
        let ground = ((y * 3.0 + 0.3 * (3.0 * x).sin()) as usize + 2) % 4;
        let index = rings.iter().copied().find(|&r| r < 5).unwrap_or(ground);
        palette[index]
    })
}

/// Normals of rough plaster, tangent space, stored as (n + 1)/2.
pub(super) fn plaster_normals(size: u32) -> RgbImage {
    let height = |u: f64, v: f64| octaves(u.rem_euclid(1.0), v.rem_euclid(1.0), 6, 3, 40) * 0.05;
    draw(size, size, |u, v| {
        let h = 0.5 / size as f64;
        let slope = |a: f64, b: f64| (a - b) / (2.0 * h);
        let du = slope(height(u + h, v), height(u - h, v));
        let dv = slope(height(u, v + h), height(u, v - h));
        // v grows downwards, the green of a normal map upwards.
        let n = glam::dvec3(-du, dv, 1.0).normalize();
        [n.x, n.y, n.z].map(|c| 0.5 * (c + 1.0))
    })
}

/// Roughness (green) and metalness (blue) of a scratched metal, as glTF stores them.
pub(super) fn scratches(size: u32) -> RgbImage {
    draw(size, size, |u, v| {
        let worn = octaves(u, v, 4, 3, 90);
        let scratch = noise((u + 0.3 * v).rem_euclid(1.0) * 64.0, v * 2.0, 64, 91);
        [0.0, 0.45 + 0.3 * worn + if scratch > 0.85 { 0.2 } else { 0.0 }, 1.0]
    })
}

/// White above, black below.
pub(super) fn upper_half() -> RgbImage {
    RgbImage::from_fn(1, 2, |_, y| Rgb([if y == 0 { 255 } else { 0 }; 3]))
}
