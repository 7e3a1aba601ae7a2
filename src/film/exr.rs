//! OpenEXR: one part, float32, ZIP; layers by the prefix of their channels (`stderr.R`), which is how Nuke, tev, Blender
//! and OpenImageIO list and select them. The header is one text attribute: several custom attributes would be stored
//! in an order that changes from run to run, and equal images shall be equal files.

use super::file::write_atomic;
use super::{Channels, Image};
use exr::meta::attribute::Chromaticities;
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, Compression, Encoding, FlatSamples, ImageAttributes,
    IntegerBounds, Layer as Part, LayerAttributes, LineOrder, ReadChannels, ReadLayers, Text, Vec2, WritableImage,
    read,
};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, BufWriter, Seek, Write};
use std::path::Path;

/// Name of the text attribute that holds the header.
const ATTRIBUTE: &str = "radianza";

/// A deflated byte stands for at most 1032 bytes; a header that promises more pixels than the file can hold is refused
/// before anything is allocated for them.
const MAX_RATIO: u64 = 1032;

/// Why an image could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// No such file, or no access.
    #[error("cannot be read: {0}")]
    Missing(io::Error),
    /// Not an OpenEXR file, or a damaged one.
    #[error("is not a sound OpenEXR image: {0}")]
    Invalid(String),
    /// A kind of OpenEXR file that is not honoured.
    #[error("is an OpenEXR image of a kind that is not read: {0}")]
    Unsupported(String),
}

/// Writes the image, whole or not at all. Equal images give equal bytes.
pub fn write_exr(path: &Path, image: &Image) -> io::Result<()> {
    write_atomic(path, |file| encode(file, image))
}

fn encode(file: &mut File, image: &Image) -> io::Result<()> {
    let invalid = |message: &str| io::Error::new(io::ErrorKind::InvalidInput, message);
    let [w, h] = image.window_size();
    if w == 0 || h == 0 {
        return Err(invalid("an image without pixels"));
    }
    // Name the channels: `R` of the beauty, `stderr.R` of others.
    let mut channels = Vec::new();
    for (layer, channel, data) in image.layers.iter().flat_map(|(l, c)| c.iter().map(move |(n, d)| (l, n, d))) {
        let name = if layer == Image::BEAUTY { channel.clone() } else { format!("{layer}.{channel}") };
        let name = Text::new_or_none(&name).ok_or_else(|| invalid("a channel name beyond Latin-1"))?;
        if data.len() != w * h {
            return Err(invalid("a channel that does not fill the window"));
        }
        channels.push(AnyChannel::new(name, FlatSamples::F32(data.clone())));
    }

    // Say what the numbers are: linear BT.709 in this window of the whole image.
    let position = Vec2(image.window[0] as i32, image.window[1] as i32);
    let mut own = LayerAttributes { layer_position: position, ..LayerAttributes::default() };
    own.software_name = Text::new_or_none(concat!("radianza ", env!("CARGO_PKG_VERSION")));
    if let (false, Some(text)) = (image.header.is_empty(), Text::new_or_none(&image.header)) {
        own.other.insert(ATTRIBUTE.into(), AttributeValue::Text(text));
    }
    let display = IntegerBounds::from_dimensions(Vec2(image.size[0] as usize, image.size[1] as usize));
    let mut shared = ImageAttributes::new(display);
    shared.chromaticities = Some(Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.30, 0.60),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.3290),
    });

    // Write, and flush here: a full disk must not go unnoticed in a destructor.
    let encoding =
        Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    let part = Part::new(Vec2(w, h), own, encoding, AnyChannels::sort(channels.into_iter().collect()));
    let out = exr::prelude::Image::new(shared, part);
    let mut buffer = BufWriter::new(file);
    out.write().to_buffered(&mut buffer).map_err(|e| match e {
        exr::error::Error::Io(e) => e,
        other => io::Error::other(other.to_string()),
    })?;
    buffer.flush()
}

/// Reads all layers of an OpenEXR file with flat pixels, of one part or of several with one window. Parts after the
/// first prefix their layers by their own name. A window that leaves the image is taken as the whole image.
pub fn read_exr(path: &Path) -> Result<Image, ReadError> {
    let mut file = BufReader::new(File::open(path).map_err(ReadError::Missing)?);
    let length = file.seek(io::SeekFrom::End(0)).and_then(|n| file.rewind().map(|()| n)).map_err(ReadError::Missing)?;
    let chunks = exr::block::read(file, false).map_err(refused)?;
    // Refuse what the file cannot hold.
    for header in chunks.headers() {
        if header.deep {
            return Err(ReadError::Unsupported("deep pixels".into()));
        }
        let pixels = header.layer_size.width() as u64 * header.layer_size.height() as u64;
        let bytes = pixels.saturating_mul(header.channels.bytes_per_pixel as u64);
        if bytes > length.saturating_mul(MAX_RATIO) {
            return Err(ReadError::Invalid(format!("{bytes} bytes of pixels in a file of {length}")));
        }
    }
    let reader = read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
    collect(reader.from_chunks(chunks).map_err(refused)?)
}

fn refused(e: exr::error::Error) -> ReadError {
    match e {
        exr::error::Error::Io(e) => ReadError::Invalid(e.to_string()),
        exr::error::Error::NotSupported(message) => ReadError::Unsupported(message.into()),
        other => ReadError::Invalid(other.to_string()),
    }
}

fn collect(source: exr::prelude::FlatImage) -> Result<Image, ReadError> {
    let Some(first) = source.layer_data.first() else {
        return Err(ReadError::Invalid("no parts".into()));
    };
    let bounds = first.absolute_bounds();
    let (size, window) = windows(source.attributes.display_window, bounds);
    let header = match first.attributes.other.get(ATTRIBUTE.as_bytes()) {
        Some(AttributeValue::Text(text)) => text.to_string(),
        _ => String::new(),
    };
    let mut layers: BTreeMap<String, Channels> = BTreeMap::new();
    for (index, part) in source.layer_data.iter().enumerate() {
        if part.absolute_bounds() != bounds {
            return Err(ReadError::Unsupported("parts with different windows".into()));
        }
        let prefix = match (index, &part.attributes.layer_name) {
            (1.., Some(name)) => format!("{name}."),
            _ => String::new(),
        };
        for channel in &part.channel_data.list {
            let name = format!("{prefix}{}", channel.name);
            let (layer, channel_name) = name.rsplit_once('.').unwrap_or((Image::BEAUTY, &name));
            let data = channel.sample_data.values_as_f32().collect();
            layers.entry(layer.into()).or_default().insert(channel_name.into(), data);
        }
    }
    Ok(Image { size, window, layers, header })
}

/// Size of the whole image, and the window that is held, from the file's display and data windows.
fn windows(display: IntegerBounds, data: IntegerBounds) -> ([u32; 2], [u32; 4]) {
    let whole = |bounds: IntegerBounds| [bounds.size.width() as u32, bounds.size.height() as u32];
    let [w, h] = whole(data);
    let x = i64::from(data.position.x()) - i64::from(display.position.x());
    let y = i64::from(data.position.y()) - i64::from(display.position.y());
    let [dw, dh] = whole(display).map(i64::from);
    if x < 0 || y < 0 || x + i64::from(w) > dw || y + i64::from(h) > dh {
        return ([w, h], [0, 0, w, h]);
    }
    (whole(display), [x as u32, y as u32, x as u32 + w, y as u32 + h])
}
