//! `[render]` and `[expect]`.

use super::keys::{Named, keys};
use super::number::{Count, Exact, Number};
use super::read::{At, Fault, Node, Read, suggest};
use super::schema::Defs;
use super::words::words;
use super::write::{Write, array};
use crate::desc::{Expect, Filter, Integrator, RenderSettings, SamplerKind, Strategy, Tonemap, Value};
use ::toml::de::DeValue;
use serde_json::{Value as Json, json};
use std::ops::Range;

keys! {
    /// Suggestions of a scene file, which the command line may override.
    struct RenderTable {
        /// Samples per pixel.
        spp: Option<Count>,
        /// Which part of the rendering equation is solved: "raycast" (emission alone), "local" (and direct light), "whitted" (and perfect reflection and refraction) or "path" (everything). Default "path".
        integrator: Option<Integrator>,
        /// How the hemisphere is sampled: "uniform", "cosine", "bsdf", "light" or "mis". Default "mis".
        strategy: Option<Strategy>,
        /// Where the numbers come from: "independent", "sobol" or "lattice". Default "lattice".
        sampler: Option<SamplerKind>,
        /// Seed of the sampler.
        seed: Option<u64>,
        /// Most reflections and refractions of a path; none by default. A limit makes the image darker: it is biased.
        max_depth: Option<u32>,
        /// Pixel filter: "box", "gaussian" or "blackman-harris". Default "blackman-harris".
        filter: Option<Filter>,
        /// Tone curve of the PNG: "linear", "log", "reinhard" or "agx". Default "agx".
        tonemap: Option<Tonemap>,
        /// Exposure of the PNG in stops.
        exposure: Option<Number>,
    }
}

words! {
    Integrator: "raycast" => Integrator::Raycast, "local" => Integrator::Local, "whitted" => Integrator::Whitted, "path" => Integrator::Path;
    Strategy: "uniform" => Strategy::Uniform, "cosine" => Strategy::Cosine, "bsdf" => Strategy::Bsdf, "light" => Strategy::Light, "mis" => Strategy::Mis;
    SamplerKind: "independent" => SamplerKind::Independent, "sobol" => SamplerKind::Sobol, "lattice" => SamplerKind::Lattice;
    Filter: "box" => Filter::Box, "gaussian" => Filter::Gaussian, "blackman-harris" => Filter::BlackmanHarris;
    Tonemap: "linear" => Tonemap::Linear, "log" => Tonemap::Log, "reinhard" => Tonemap::Reinhard, "agx" => Tonemap::Agx;
}

impl RenderTable {
    /// The settings.
    pub(super) fn build(&self) -> RenderSettings {
        let Self { spp, integrator, strategy, sampler, seed, max_depth, filter, tonemap, exposure } = *self;
        let (spp, exposure) = (spp.map(|n| n.0), exposure.map(|x| x.0));
        RenderSettings { spp, integrator, strategy, sampler, seed, max_depth, filter, tonemap, exposure }
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(settings: &RenderSettings) -> Self {
        let RenderSettings { spp, integrator, strategy, sampler, seed, max_depth, filter, tonemap, exposure } =
            *settings;
        let (spp, exposure) = (spp.map(Count), exposure.map(Number));
        Self { spp, integrator, strategy, sampler, seed, max_depth, filter, tonemap, exposure }
    }
}

keys! {
    /// What the image must agree with, by z-test.
    struct ExpectTable {
        /// Exact RGB radiance of every pixel of the region, or one number for all three.
        radiance: Option<Value>,
        /// Exact RGB of named layers (`emission`, `D`, `S`, `DD`, `SD`, `DS`, `SS`).
        layers: Named<Value>,
        /// Pixels that it holds for: x0, y0, x1, y1 (upper ends excluded). Default: all.
        region: Option<At<[u32; 4]>>,
        /// Integrators that must agree. Default ["path"].
        integrators: Vec<Integrator> = Vec::new(),
        /// Strategies that must agree. Default: all.
        strategies: Vec<Strategy> = Vec::new(),
        /// Samplers that must agree. Default: all.
        samplers: Vec<SamplerKind> = Vec::new(),
        /// Samples per pixel to test with. Default: as many as a pilot finds necessary.
        spp: Option<Count>,
        /// Most reflections, where the answer is of a truncated series.
        max_depth: Option<u32>,
        /// Largest relative error of the answer itself (a truncated series, a numerical integral). Default 0.
        tolerance: Exact = Exact(0.0),
        /// The formula, for the report. Default: empty.
        formula: String = String::new(),
    }
}

impl Read for Value {
    fn read(node: &Node<'_>) -> Result<Self, Fault> {
        match node.get_ref() {
            DeValue::Array(_) => <[Exact; 3]>::read(node).map(|rgb| Self::Rgb(rgb.map(|x| x.0))),
            _ => Exact::read(node).map(|x| Self::Grey(x.0)),
        }
    }
    fn one() -> String {
        format!("{} or {}", Exact::one(), <[Exact; 3]>::one())
    }
    fn many() -> String {
        Exact::many()
    }
    fn schema(defs: &mut Defs) -> Json {
        json!({ "anyOf": [Exact::schema(defs), <[Exact; 3]>::schema(defs)] })
    }
}

impl Write for Value {
    fn text(&self) -> String {
        match self {
            Self::Grey(x) => Exact(*x).text(),
            Self::Rgb(rgb) => array(&rgb.map(Exact)),
        }
    }
}

impl ExpectTable {
    /// The expectation. `at` is the place of its table.
    pub(super) fn build(&self, at: &Range<usize>) -> Result<Expect, Fault> {
        const LAYERS: [&str; 7] = ["emission", "D", "S", "DD", "SD", "DS", "SS"];
        if let Some(entry) = self.layers.entries.iter().find(|entry| !LAYERS.contains(&entry.name.as_str())) {
            let hint = suggest(&entry.name, LAYERS);
            return Err(Fault::new(&entry.at, format!("unknown layer `{}`; {hint}", entry.name)));
        }
        if self.radiance.is_none() && self.layers.entries.is_empty() {
            return Err(Fault::new(at, "nothing is expected; give `radiance` or `layers`"));
        }
        if let Some(At { at, value: [x0, y0, x1, y1] }) = &self.region
            && (x0 >= x1 || y0 >= y1)
        {
            let message = format!("`region` is [{x0}, {y0}, {x1}, {y1}], expected [x0, y0, x1, y1], x0 < x1, y0 < y1");
            return Err(Fault::new(at, message));
        }
        Ok(Expect {
            radiance: self.radiance,
            layers: self.layers.entries.iter().map(|entry| (entry.name.clone(), entry.value)).collect(),
            region: self.region.as_ref().map(|r| r.value),
            integrators: self.integrators.clone(),
            strategies: self.strategies.clone(),
            samplers: self.samplers.clone(),
            spp: self.spp.map(|n| n.0),
            max_depth: self.max_depth,
            tolerance: self.tolerance.0,
            formula: self.formula.clone(),
        })
    }

    /// The inverse of [`Self::build`].
    pub(super) fn of(expect: &Expect) -> Self {
        let e = expect.clone();
        Self {
            radiance: e.radiance,
            layers: Named::of(e.layers),
            region: e.region.map(At::nowhere),
            integrators: e.integrators,
            strategies: e.strategies,
            samplers: e.samplers,
            spp: e.spp.map(Count),
            max_depth: e.max_depth,
            tolerance: Exact(e.tolerance),
            formula: e.formula,
        }
    }
}
