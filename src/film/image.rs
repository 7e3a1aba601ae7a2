//! Named layers of f32 channels: what image files hold.

use std::collections::BTreeMap;

/// Channels of one layer by name (`R`, `G`, `B`, `A`, `X`, `Y`, `Z`, `N`), each row by row over the image's window.
pub type Channels = BTreeMap<String, Vec<f32>>;

/// An image as files hold it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Image {
    /// Width and height of the whole image.
    pub size: [u32; 2],
    /// Pixels that are held: x0, y0, x1, y1, upper ends excluded.
    pub window: [u32; 4],
    /// Layers by name; the one that is seen first is [`Image::BEAUTY`].
    pub layers: BTreeMap<String, Channels>,
    /// What the image says about itself: JSON, or empty.
    pub header: String,
}

impl Image {
    /// Name of the layer whose channels have no prefix in a file.
    pub const BEAUTY: &str = "beauty";

    /// Width and height of the window.
    pub fn window_size(&self) -> [usize; 2] {
        let [x0, y0, x1, y1] = self.window;
        [(x1 - x0) as usize, (y1 - y0) as usize]
    }

    /// R, G and B of a layer, or its Y three times; `None` if it has neither.
    pub fn rgb(&self, layer: &str) -> Option<[&[f32]; 3]> {
        let layer = self.layers.get(layer)?;
        let channel = |name: &str| layer.get(name).or_else(|| layer.get("Y")).map(Vec::as_slice);
        Some([channel("R")?, channel("G")?, channel("B")?])
    }

    /// Adds an RGB layer, row by row.
    pub fn insert_rgb(&mut self, layer: &str, pixels: impl IntoIterator<Item = [f32; 3]>) {
        self.insert(layer, &["R", "G", "B"], pixels);
    }

    /// Adds channels to a layer, at most three, row by row.
    pub fn insert(&mut self, layer: &str, names: &[&str], pixels: impl IntoIterator<Item = [f32; 3]>) {
        let mut channels = vec![Vec::new(); names.len().min(3)];
        for pixel in pixels {
            for (channel, x) in channels.iter_mut().zip(pixel) {
                channel.push(x);
            }
        }
        let named = names.iter().map(|name| (*name).to_string()).zip(channels);
        self.layers.entry(layer.into()).or_default().extend(named);
    }
}
