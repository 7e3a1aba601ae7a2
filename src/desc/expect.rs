//! Exact answers in scene files: the closed-form test runner compares every render of such a file with them.

use super::{Integrator, SamplerKind, Strategy};

/// The image must agree with this, by z-test.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Expect {
    /// Exact RGB radiance of every pixel of the region, or one number for all three.
    pub radiance: Option<Value>,
    /// Exact RGB of named layers (`emission`, `D`, `S`, `DD`, `SD`, `DS`, `SS`).
    pub layers: std::collections::BTreeMap<String, Value>,
    /// Pixels that it holds for: x0, y0, x1, y1 (upper ends excluded); all without.
    pub region: Option<[u32; 4]>,
    /// Integrators that must agree; `path` without.
    pub integrators: Vec<Integrator>,
    /// Strategies that must agree; all five without.
    pub strategies: Vec<Strategy>,
    /// Samplers that must agree; both without.
    pub samplers: Vec<SamplerKind>,
    /// Samples per pixel to test with; as many as a pilot finds necessary without.
    pub spp: Option<u32>,
    /// Most reflections, where the answer is of a truncated series.
    pub max_depth: Option<u32>,
    /// Largest relative error of the answer itself (a truncated series, a numerical integral); 0 without.
    pub tolerance: f64,
    /// The formula, for the report.
    pub formula: String,
}

/// One number for all channels, or RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// One number for R, G and B.
    Grey(f64),
    /// R, G, B.
    Rgb([f64; 3]),
}

impl Value {
    /// As RGB.
    pub fn rgb(self) -> [f64; 3] {
        match self {
            Self::Grey(x) => [x; 3],
            Self::Rgb(rgb) => rgb,
        }
    }
}
