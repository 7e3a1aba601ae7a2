//! OpenEXR: the first layer with a colour in it.

use super::{Decoded, Pixels, check_finite, check_size};
use ::exr::meta::MetaData;
use ::exr::meta::header::Header;
use ::exr::prelude::*;
use std::io::Cursor;

/// Names of the channels that make the picture.
struct Channels {
    /// Red, green, blue; or one luminance.
    color: Color,
    /// Coverage; 1 where the layer has no such channel.
    alpha: Text,
}

enum Color {
    Rgb([Text; 3]),
    Luminance(Text),
}

/// Pixels under construction: the display window.
struct Canvas {
    size: [usize; 2],
    /// Position of the data window in the display window.
    offset: [i64; 2],
    pixels: Vec<[f32; 4]>,
}

impl Canvas {
    /// Keeps a pixel of the data window, if the display window has it.
    fn set(&mut self, at: Vec2<usize>, [r, g, b, a]: [f32; 4]) {
        let x = at.x() as i64 + self.offset[0];
        let y = at.y() as i64 + self.offset[1];
        if (0..self.size[0] as i64).contains(&x) && (0..self.size[1] as i64).contains(&y) {
            // Associated to unassociated alpha. Where nothing covers, what is there glows, and stays.
            let scale = if a > 0.0 && a < 1.0 { 1.0 / a } else { 1.0 };
            self.pixels[y as usize * self.size[0] + x as usize] = [r * scale, g * scale, b * scale, a];
        }
    }
}

/// OpenEXR to linear floats.
pub(super) fn decode(bytes: &[u8]) -> Decoded {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|e| e.to_string())?;
    let (header, Channels { color, alpha }) = choose(&meta.headers)?;

    // Check both windows: the data window is what the decoder allocates for, the display window what is kept.
    let display = header.shared_attributes.display_window;
    check_size(header.layer_size.x() as u64, header.layer_size.y() as u64, 16)?;
    let size = check_size(display.size.x() as u64, display.size.y() as u64, 16)?;
    let place = header.own_attributes.layer_position;
    let canvas = || Canvas {
        size: size.map(|s| s as usize),
        offset: [0, 1].map(|i| {
            let (data, display) = [(place.x(), display.position.x()), (place.y(), display.position.y())][i];
            i64::from(data) - i64::from(display)
        }),
        pixels: vec![[0.0; 4]; size[0] as usize * size[1] as usize],
    };

    // One thread: a worker that panicked could not be caught.
    let levels = read().no_deep_data().largest_resolution_level().specific_channels();
    let file = Cursor::new(bytes);
    let pixels = match color {
        Color::Rgb([r, g, b]) => levels
            .required(r)
            .required(g)
            .required(b)
            .optional(alpha, 1.0)
            .collect_pixels(|_, _| canvas(), |c: &mut Canvas, at, (r, g, b, a)| c.set(at, [r, g, b, a]))
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_buffered(file)
            .map(|image| image.layer_data.channel_data.pixels),
        Color::Luminance(y) => levels
            .required(y)
            .optional(alpha, 1.0)
            .collect_pixels(|_, _| canvas(), |c: &mut Canvas, at, (y, a)| c.set(at, [y, y, y, a]))
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_buffered(file)
            .map(|image| image.layer_data.channel_data.pixels),
    };
    let pixels = pixels.map_err(|e| e.to_string())?.pixels;
    check_finite(size, &pixels)?;
    Ok((size, Pixels::Rgba32F(pixels)))
}

/// The layer and channels that make the picture: R, G, B; or Y; or the first `name.R`, `name.G`, `name.B`.
fn choose(headers: &[Header]) -> std::result::Result<(&Header, Channels), String> {
    let flat = || headers.iter().filter(|h| !h.deep);
    let find = |names: &[String]| flat().find(|h| names.iter().all(|n| channel(h, n).is_some()));
    let under = |prefix: &str| ["R", "G", "B", "A", "Y"].map(|c| format!("{prefix}{c}"));

    let prefixes =
        flat().flat_map(|h| &h.channels.list).filter_map(|c| c.name.to_string().strip_suffix('R').map(String::from));
    for prefix in std::iter::once(String::new()).chain(prefixes) {
        let [r, g, b, a, y] = under(&prefix);
        let (header, color) = match (find(&[r.clone(), g.clone(), b.clone()]), find(std::slice::from_ref(&y))) {
            (Some(header), _) => (header, Color::Rgb([r, g, b].map(|n| Text::from(&*n)))),
            (None, Some(header)) => (header, Color::Luminance(Text::from(&*y))),
            (None, None) => continue,
        };
        if header.channels.list.iter().any(|c| c.sampling != Vec2(1, 1)) {
            return Err(
                "its channels are subsampled (luminance and chroma), which is not honoured; save it as RGB".into()
            );
        }
        return Ok((header, Channels { color, alpha: Text::from(&*a) }));
    }
    if flat().next().is_none() {
        return Err("it holds deep data only, which is not honoured".into());
    }
    let found: Vec<_> = flat().flat_map(|h| &h.channels.list).map(|c| c.name.to_string()).collect();
    Err(format!("its channels are {}; expected R, G and B, or Y", found.join(", ")))
}

/// The channel called `name`.
fn channel<'a>(header: &'a Header, name: &str) -> Option<&'a ChannelDescription> {
    header.channels.list.iter().find(|c| c.name == *name)
}
