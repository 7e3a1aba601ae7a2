//! The list of layers: what a film can keep of every sample, and what images call it.
//!
//! All that knows of layers follows this list: what is added to a pixel and how it is averaged, `--layers` and its help, the names
//! of channels in files. A new layer is an entry here, and a row in the README's table; what
//! samples do not have yet is also a field of [`PixelSample`](super::PixelSample) and a sum in `sample.rs`.

use super::Image;
use super::sample::SampleSums;
use crate::spectrum::Spectrum;

/// Names of the transport classes, by the last two reflections before the eye. SD: specular, then diffuse, then the eye:
/// a caustic.
pub const CLASSES: [&str; 7] = ["emission", "D", "S", "DD", "SD", "DS", "SS"];

/// Radiance of one sample by transport class, in the order of [`CLASSES`].
pub type ByClass = [Spectrum; CLASSES.len()];

/// What of the samples' sums a layer keeps.
pub(super) type Of = fn(&SampleSums) -> [f64; 3];

/// How the samples of a pixel become its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Mean over all samples with its standard error, from the spread of independent replicates. What paths bring to other
    /// pixels than their own (splats) is added to it.
    Estimate,
    /// Mean over all samples.
    Mean,
    /// Mean over the samples that met a surface; 0 where none did.
    MeanWhereMet,
    /// Number of samples.
    Count,
}

/// A quantity of up to three channels that a film keeps of each pixel.
#[derive(Debug)]
pub struct Layer {
    /// Name in the film; of all layers unique.
    pub name: &'static str,
    /// Layer of images that holds its channels.
    pub image: &'static str,
    /// Names of its channels, at most three.
    pub channels: &'static [&'static str],
    /// How it is averaged.
    pub kind: Kind,
    /// Whether values may be negative.
    pub signed: bool,
    /// What of the samples' sums it keeps; channels beyond its own are ignored.
    pub(super) of: Of,
}

impl PartialEq for Layer {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// Layers that are asked for by one name.
#[derive(Debug)]
pub struct Group {
    /// Name on the command line.
    pub name: &'static str,
    /// What it shows, for people.
    pub about: &'static str,
    /// Whether films keep it without being asked, and images hold it by default.
    pub always: bool,
    /// What it consists of.
    pub layers: &'static [Layer],
}

impl PartialEq for Group {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Group {
    /// Radiance and coverage.
    pub const BEAUTY: &'static Self = &GROUPS[0];

    /// The group of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        GROUPS.iter().find(|group| group.name == name)
    }

    /// Whether the standard errors of all estimates in the image are asked for by this name.
    pub fn is_errors(&self) -> bool {
        self.name == ERRORS
    }
}

/// Name of the layer that is radiance, and of the group of standard errors, which has no sums of its own.
pub(super) const RADIANCE: &str = "radiance";
pub(super) const ERRORS: &str = "stderr";

/// Name of the group of transport classes, for which paths are watched.
pub const TRANSPORT: &str = "transport";

const RGB: &[&str] = &["R", "G", "B"];

/// Everything that a film can keep and an image can hold.
pub static GROUPS: [Group; 7] = [
    Group {
        name: "beauty",
        about: "radiance R, G, B [W/sr/m²] and coverage A",
        always: true,
        layers: &[
            Layer {
                name: RADIANCE,
                image: Image::BEAUTY,
                channels: RGB,
                kind: Kind::Estimate,
                signed: false,
                of: |sums| sums.radiance,
            },
            Layer {
                name: "alpha",
                image: Image::BEAUTY,
                channels: &["A"],
                kind: Kind::Mean,
                signed: false,
                of: |sums| [sums.alpha; 3],
            },
        ],
    },
    Group {
        name: ERRORS,
        about: "standard error of radiance, stderr.R, and of transport classes, stderr.SD.R",
        always: true,
        layers: &[],
    },
    Group {
        name: "albedo",
        about: "reflectance of the first surface",
        always: true,
        layers: &[Layer {
            name: "albedo",
            image: "albedo",
            channels: RGB,
            kind: Kind::Mean,
            signed: false,
            of: |sums| sums.albedo,
        }],
    },
    Group {
        name: "normal",
        about: "shading normal of the first surface, world space",
        always: true,
        layers: &[Layer {
            name: "normal",
            image: "normal",
            channels: &["X", "Y", "Z"],
            kind: Kind::MeanWhereMet,
            signed: true,
            of: |sums| sums.normal,
        }],
    },
    Group {
        name: "depth",
        about: "distance to the first surface [m], 0 where there is none",
        always: true,
        layers: &[Layer {
            name: "depth",
            image: "depth",
            channels: &["Z"],
            kind: Kind::MeanWhereMet,
            signed: false,
            of: |sums| [sums.depth; 3],
        }],
    },
    Group {
        name: "samples",
        about: "samples taken",
        always: true,
        layers: &[Layer {
            name: "samples",
            image: "samples",
            channels: &["N"],
            kind: Kind::Count,
            signed: false,
            of: |_| [1.0; 3],
        }],
    },
    Group {
        name: TRANSPORT,
        about: "radiance by the last two reflections before the eye: emission, D, S, DD, SD, DS, SS",
        always: false,
        layers: &[
            class(0, |sums| sums.classes[0]),
            class(1, |sums| sums.classes[1]),
            class(2, |sums| sums.classes[2]),
            class(3, |sums| sums.classes[3]),
            class(4, |sums| sums.classes[4]),
            class(5, |sums| sums.classes[5]),
            class(6, |sums| sums.classes[6]),
        ],
    },
];

/// The layer of a transport class. A class is what is left of a sum without others, so that rounding may make it negative.
const fn class(index: usize, of: Of) -> Layer {
    Layer { name: CLASSES[index], image: CLASSES[index], channels: RGB, kind: Kind::Estimate, signed: true, of }
}

/// The layer of this name.
pub(super) fn layer(name: &str) -> Option<&'static Layer> {
    GROUPS.iter().flat_map(|group| group.layers).find(|layer| layer.name == name)
}
