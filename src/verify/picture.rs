//! What a failing image looks like.

use super::agreement::Estimated;
use super::replicated::Replicated;
use super::{Exhibit, Picture};
use crate::stats::z;

/// A check with a p below this is shown, whether or not it fails at the significance of its run.
pub const SUSPECT: f64 = 1e-6;

/// White at 0, red where too bright, blue where too dark, full colour at `full` and beyond; yellow for no number.
fn signed(x: f64, full: f64) -> [f32; 3] {
    let t = (x / full).clamp(-1.0, 1.0) as f32;
    match t {
        t if t.is_nan() => [1.0, 1.0, 0.0],
        t if t >= 0.0 => [1.0, 1.0 - t, 1.0 - t],
        t => [1.0 + t, 1.0 + t, 1.0],
    }
}

/// The estimate over the answer, and how many standard errors each pixel is off.
pub fn of_expected(name: &str, image: &Replicated, exact: [f64; 3]) -> [Exhibit; 2] {
    let channel = (0..3).fold(0, |best, c| if exact[c] > exact[best] { c } else { best });
    let scale = if exact[channel] > 0.0 { exact[channel] } else { 1.0 };
    let pixels = image.pixels();
    let ratio = pixels.iter().map(|m| [(0.5 * m[channel].mean() / scale) as f32; 3]).collect();
    let zs = pixels.iter().map(|m| signed(m[channel].z(exact[channel]), 6.0)).collect();
    [
        picture(format!("{name}: half of estimate/exact (grey is right)"), image.size, ratio),
        picture(format!("{name}: z of each pixel, −6 blue to +6 red"), image.size, zs),
    ]
}

/// How many standard errors each pixel is off 0, by the green channel.
pub fn of_difference(name: &str, difference: &Estimated) -> Exhibit {
    let zs = difference.pixels.iter().map(|rgb| signed(z(rgb[1].mean, 0.0, rgb[1].se), 6.0)).collect();
    picture(format!("{name}: z of each pixel's difference, −6 blue to +6 red"), difference.size, zs)
}

fn picture(title: String, size: [usize; 2], pixels: Vec<[f32; 3]>) -> Exhibit {
    Exhibit::Picture(Picture { title, size: size.map(|n| n as u32), pixels })
}
