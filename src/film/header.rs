//! What an image says about itself: enough to render it again, bit for bit, and to know whether to trust it.

use crate::desc::{Filter, Integrator, SamplerKind, Strategy};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// The JSON text in the attribute `radianza` of every EXR. It holds nothing that differs between two runs of the same
/// command (no time, no machine), so that equal images are equal files.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// Program and version.
    pub software: String,
    /// The scene file.
    pub scene: Origin,
    /// The image that replaced the scene's environment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub environment: Option<Origin>,
    /// Time of the animations \[s\], if one was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<f64>,
    /// The variant that was chosen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub variant: Option<String>,
    /// Index and name of the camera.
    pub camera: (usize, String),
    /// Width and height of the whole image.
    pub size: [u32; 2],
    /// Pixels rendered: x0, y0, x1, y1, upper ends excluded.
    pub crop: [u32; 4],
    /// Sample indices of every pixel, upper end excluded.
    pub samples: [u64; 2],
    /// Samples per independent replicate.
    pub replicate: u32,
    /// Which part of the rendering equation.
    pub integrator: Integrator,
    /// How the hemisphere was sampled.
    pub strategy: Strategy,
    /// Where the numbers came from.
    pub sampler: SamplerKind,
    /// Seed of the sampler.
    pub seed: u64,
    /// Most reflections and refractions of a path.
    pub max_depth: Option<u32>,
    /// Pixel filter.
    pub filter: Filter,
    /// What the scene's files say of themselves (XMP packets in JSON-LD), uninterpreted.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub metadata: Vec<serde_json::Value>,
    /// Why the image is not an unbiased estimate of the whole equation; empty where it is.
    pub biased: Vec<String>,
    /// Samples of which some layer's value was not finite or negative and counts as 0.
    pub non_finite: u64,
}

/// A file, and its content's hash.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    /// Name for people.
    pub name: String,
    /// SHA-256 of the file, hexadecimal; of the file alone, not of what it refers to.
    pub sha256: String,
}

impl Origin {
    /// Of a file with this content.
    pub fn new(name: impl Into<String>, content: &[u8]) -> Self {
        let sha256 = Sha256::digest(content).iter().map(|byte| format!("{byte:02x}")).collect();
        Self { name: name.into(), sha256 }
    }
}

impl Header {
    /// As JSON in ASCII.
    pub fn to_json(&self) -> String {
        // Strings, numbers and lists always serialise.
        let json = serde_json::to_string(self).unwrap_or_default();
        ascii(&json)
    }
}

/// JSON with everything beyond ASCII as `\u` escapes, since EXR attributes have no encoding.
fn ascii(json: &str) -> String {
    let mut out = String::with_capacity(json.len());
    for c in json.chars() {
        if c.is_ascii() {
            out.push(c);
        } else {
            c.encode_utf16(&mut [0; 2]).iter().for_each(|unit| out.push_str(&format!("\\u{unit:04x}")));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_survives_as_ascii() -> Result<(), serde_json::Error> {
        let text = ascii("{\"name\":\"Zürich 🌍\"}");
        assert!(text.is_ascii());
        let value: serde_json::Value = serde_json::from_str(&text)?;
        assert_eq!(value["name"], "Zürich 🌍");
        Ok(())
    }

    #[test]
    fn hash_is_sha256() {
        // FIPS 180-2, appendix B.1.
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(Origin::new("", b"abc").sha256, abc);
    }
}
