//! Six faces of a cube as one equirectangular image.

use super::image_file::srgb_to_linear;
use super::{Image, Pixels};
use glam::Vec3;
use std::f32::consts::{PI, TAU};

/// Largest face of which every pixel has a share of its own.
const MAX_FACE: u32 = 1024;

/// Directions per axis that a pixel is averaged over.
const FINE: usize = 3;

/// Right, down and forward of the faces +x, −x, +y, −y, +z, −z as one sees them from inside.
const FACES: [[Vec3; 3]; 6] = [
    [Vec3::Z, Vec3::NEG_Y, Vec3::X],
    [Vec3::NEG_Z, Vec3::NEG_Y, Vec3::NEG_X],
    [Vec3::NEG_X, Vec3::Z, Vec3::Y],
    [Vec3::NEG_X, Vec3::NEG_Z, Vec3::NEG_Y],
    [Vec3::NEG_X, Vec3::NEG_Y, Vec3::Z],
    [Vec3::X, Vec3::NEG_Y, Vec3::NEG_Z],
];

/// Width and height of the panorama of faces with this side: as many pixels around as the equator has.
pub fn panorama_size(face: u32) -> [u32; 2] {
    let side = face.clamp(1, MAX_FACE);
    [4 * side, 2 * side]
}

/// The image of six faces, in the order +x, −x, +y, −y, +z, −z, all seen from inside and upright (+y up; the upper edge of
/// +y is its −z side, that of −y its +z side). 8-bit pixels hold the sRGB codes of radiance × alpha; the error says what is
/// wrong with the faces.
pub fn panorama(faces: &[&Image]) -> Result<Image, String> {
    let [first, ..] = faces else { return Err("has no faces; expected six".into()) };
    let side = first.size[0];
    if faces.len() != 6 || faces.iter().any(|face| face.size != [side; 2]) {
        let sizes: Vec<_> = faces.iter().map(|face| format!("{} × {}", face.size[0], face.size[1])).collect();
        return Err(format!("has faces of {} pixels; expected six squares of one size", sizes.join(", ")));
    }
    let faces: Vec<Vec<Vec3>> = faces.iter().map(|face| decode(&face.pixels)).collect();
    let size = panorama_size(side);
    let mut pixels = Vec::with_capacity(size[0] as usize * size[1] as usize);
    for row in 0..size[1] {
        for column in 0..size[0] {
            let mut sum = Vec3::ZERO;
            for k in 0..FINE * FINE {
                let [s, t] = [k % FINE, k / FINE].map(|i| (i as f32 + 0.5) / FINE as f32);
                let phi = TAU * ((column as f32 + s) / size[0] as f32 - 0.5);
                let theta = PI * (row as f32 + t) / size[1] as f32;
                let w = Vec3::new(theta.sin() * phi.sin(), theta.cos(), -theta.sin() * phi.cos());
                sum += look_up(&faces, side as usize, w);
            }
            let mean = sum / (FINE * FINE) as f32;
            pixels.push(mean.extend(1.0).to_array());
        }
    }
    Ok(Image { name: "cube map".into(), size, pixels: Pixels::Rgba32F(pixels) })
}

/// Radiance of the pixel that the direction meets.
fn look_up(faces: &[Vec<Vec3>], side: usize, w: Vec3) -> Vec3 {
    let a = w.abs();
    let axis = if a.x >= a.y && a.x >= a.z {
        0
    } else if a.y >= a.z {
        1
    } else {
        2
    };
    let face = 2 * axis + usize::from(w[axis] < 0.0);
    let [right, down, forward] = FACES[face];
    let depth = w.dot(forward);
    let bin = |x: f32| (((x / depth * 0.5 + 0.5) * side as f32) as usize).min(side - 1);
    faces[face][bin(w.dot(down)) * side + bin(w.dot(right))]
}

fn decode(pixels: &Pixels) -> Vec<Vec3> {
    let over_alpha = |[r, g, b, a]: [f32; 4]| if a > 0.0 { Vec3::new(r, g, b) / a } else { Vec3::ZERO };
    match (pixels.are_codes(), srgb_to_linear(pixels.clone())) {
        (true, Pixels::Rgba32F(linear)) => linear.into_iter().map(over_alpha).collect(),
        (_, Pixels::Rgba32F(linear)) => linear.into_iter().map(|[r, g, b, _]| Vec3::new(r, g, b)).collect(),
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn face(f: impl Fn(u32, u32) -> f32) -> Image {
        let pixels = (0..16).map(|i| [f(i % 4, i / 4), 0.0, 0.0, 1.0]).collect();
        Image { name: String::new(), size: [4, 4], pixels: Pixels::Rgba32F(pixels) }
    }

    /// Faces meet where they should: their images are those of one smooth function, x + 2y + 4z along the cube.
    #[test]
    fn faces_are_seen_from_inside() {
        let smooth = |w: Vec3| 20.0 + w.dot(Vec3::new(1.0, 2.0, 4.0));
        let faces: Vec<Image> = FACES
            .iter()
            .map(|[right, down, forward]| {
                let at = |i: u32| (i as f32 + 0.5) / 2.0 - 1.0;
                face(|x, y| smooth((*forward + *right * at(x) + *down * at(y)).normalize()))
            })
            .collect();
        let image = panorama(&faces.iter().collect::<Vec<_>>()).unwrap();
        assert_eq!(image.size, [16, 8]);
        let Pixels::Rgba32F(pixels) = &image.pixels else { unreachable!() };
        for row in 0..8 {
            for column in 0..16 {
                let phi = TAU * ((column as f32 + 0.5) / 16.0 - 0.5);
                let theta = PI * (row as f32 + 0.5) / 8.0;
                let w = Vec3::new(theta.sin() * phi.sin(), theta.cos(), -theta.sin() * phi.cos());
                assert!((pixels[row * 16 + column][0] - smooth(w)).abs() < 1.0, "{w}");
            }
        }
        for [right, down, forward] in FACES {
            assert_eq!(right.cross(down), forward, "seen from inside, not from outside");
        }
    }

    #[test]
    fn codes_are_divided_by_alpha() {
        let [r, ..] = decode(&Pixels::Rgba8(vec![[255, 0, 0, 51]]))[0].to_array();
        assert!((r - 5.0).abs() < 1e-5);
        assert!(panorama(&[&face(|_, _| 0.0)]).is_err_and(|e| e.contains("six squares")));
    }
}
