//! Pixels in the page.

use super::super::one_line;
use crate::desc::Tonemap;
use crate::film::Display;
use crate::verify::Picture;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use maud::{Markup, html};

/// Longest side; larger pictures are made smaller.
const SIDE: u32 = 320;

/// What stands for a pixel that is not a number.
pub(super) const NONE: [u8; 3] = [255, 0, 255];

pub(super) fn draw(picture: &Picture) -> Markup {
    let [w, h] = picture.size;
    let block = w.max(h).div_ceil(SIDE).max(1);
    let size = [w.div_ceil(block), h.div_ceil(block)];
    let places = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
    let display = Display::new(Tonemap::Linear, 0.0);
    let bytes: Vec<u8> = places.flat_map(|at| code(&display, mean(picture, at, block))).collect();
    let bad = picture.pixels.iter().filter(|rgb| !rgb.iter().all(|c| c.is_finite())).count();
    html! {
        (png(size, &bytes, "picture", &one_line(&picture.title)))
        p {
            (w) "×" (h) " pixels"
            @if block > 1 { ", " (block) "×" (block) " of them to one here" }
            @if bad > 0 { "; " (bad) " are not finite (magenta)" }
            "."
        }
    }
}

/// Of the block of pixels; not a number where one of them is none.
fn mean(picture: &Picture, [x, y]: [u32; 2], block: u32) -> [f32; 3] {
    let [w, h] = picture.size;
    let (mut sum, mut n) = ([0.0; 3], 0.0);
    for y in y * block..((y + 1) * block).min(h) {
        for x in x * block..((x + 1) * block).min(w) {
            let pixel = picture.pixels.get((y * w + x) as usize).copied().unwrap_or([f32::NAN; 3]);
            (sum, n) = (std::array::from_fn(|i| sum[i] + pixel[i]), n + 1.0);
        }
    }
    sum.map(|c| c / n)
}

/// As a screen shows it: clipped, with the sRGB curve.
fn code(display: &Display, rgb: [f32; 3]) -> [u8; 3] {
    if rgb.iter().all(|c| c.is_finite()) { display.code(rgb) } else { NONE }
}

/// An image element that carries its own bytes.
pub(super) fn png(size: [u32; 2], rgb: &[u8], class: &str, alt: &str) -> Markup {
    let mut bytes = Vec::new();
    let [w, h] = size;
    match PngEncoder::new(&mut bytes).write_image(rgb, w, h, ExtendedColorType::Rgb8) {
        Ok(()) => html! {
            img class=(class) width=(w) height=(h) alt=(alt) src={ "data:image/png;base64," (STANDARD.encode(&bytes)) };
        },
        Err(_) => html! { p { "A picture without pixels." } },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes() {
        let display = Display::new(Tonemap::Linear, 0.0);
        let codes = [[0.0, 1.0, 2.0], [0.5, -1.0, 0.0], [f32::NAN, 0.0, 0.0]].map(|rgb| code(&display, rgb));
        assert_eq!(codes, [[0, 255, 255], [188, 0, 0], NONE]);
    }

    #[test]
    fn large_pictures_shrink_and_keep_what_is_no_number() {
        let mut pixels = vec![[0.25; 3]; 700 * 3];
        pixels[3] = [f32::INFINITY; 3];
        let picture = Picture { title: "wide".into(), size: [700, 3], pixels };
        let text = draw(&picture).into_string();
        assert!(
            text.contains("width=\"234\"") && text.contains("3×3 of them") && text.contains("1 are not finite"),
            "{text}"
        );
        assert_eq!(mean(&picture, [0, 0], 3), [0.25; 3]);
        assert!(!mean(&picture, [1, 0], 3)[0].is_finite());
    }

    #[test]
    fn an_empty_picture_is_said_to_be_one() {
        assert!(
            draw(&Picture { title: "".into(), size: [0, 0], pixels: vec![] }).into_string().contains("without pixels")
        );
    }
}
