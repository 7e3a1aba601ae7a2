//! Estimators of the rendering equation, and the ladder of its restrictions.
//!
//! | method | what is summed |
//! | --- | --- |
//! | [`raycast`] | Le at the first surface |
//! | [`local`] | Le and direct light |
//! | [`whitted`] | the same behind any chain of perfect reflections and refractions |
//! | [`path`] | everything |
//!
//! All share [`direct_light`], the MIS weight and the directions of [`strategy`].

mod classes;
pub mod local;
mod medium;
pub mod path;
pub mod raycast;
pub mod replay;
mod solver;
pub mod strategy;
mod walk;
pub mod whitted;

pub use classes::Classes;
pub use solver::Solver;
pub use strategy::SampledBy;
pub use walk::{Event, Numbers, Walk};

use crate::bsdf::Pdf;
use crate::desc::{Integrator, Strategy};
use crate::film::PixelSample;
use crate::light::LightSampleContext;
use crate::math::Ray;
use crate::sampler::Sampler;
use crate::scene::{CosineEval, MediaAbout, Scene, Shading, Vertex};
use crate::spectrum::Spectrum;

/// What an estimator needs to know beside the ray.
#[derive(Clone, Debug)]
pub struct Method<'a> {
    /// What is traced.
    pub scene: &'a Scene,
    /// Which part of the equation.
    pub integrator: Integrator,
    /// How the hemisphere is sampled.
    pub strategy: Strategy,
    /// Most reflections and refractions of a path.
    pub max_depth: u32,
    /// The media about the camera, of whose rays each may begin elsewhere.
    pub media: MediaAbout,
    /// What was prepared before the first ray.
    pub solver: Solver,
}

impl Method<'_> {
    /// Most smooth thin sheets that light sampling looks through from a vertex at `depth`: as many as the path has
    /// reflections left, and none where only paths of one reflection are summed.
    #[inline]
    fn most_sheets(&self, depth: u32) -> u32 {
        if self.integrator == Integrator::Path { self.max_depth - depth - 1 } else { 0 }
    }
}

/// Someone who watches a path: the split by transport class, a replay, a test. The estimators report each piece of
/// radiance once, and each vertex; with `()` all of it compiles to nothing.
pub trait Observer {
    /// Whether `classes` are tracked for this observer; they cost a division a vertex.
    const CLASSES: bool = false;
    /// A ray is about to be traced.
    fn ray(&mut self) {}
    /// `radiance` was added to the pixel after reflections of these `classes`.
    fn light(&mut self, _radiance: Spectrum, _classes: &Classes) {}
    /// The path met a surface.
    fn vertex(&mut self, _depth: u32, _ray: &Ray, _vertex: &Vertex, _shading: Option<&Shading>, _beta: Spectrum) {}
    /// The path left the scene.
    fn escaped(&mut self, _depth: u32, _ray: &Ray, _beta: Spectrum) {}
    /// A direction was drawn: with what density, and the throughput after it.
    fn sampled(&mut self, _sampled_by: SampledBy, _beta: Spectrum) {}
}

impl Observer for () {}

/// Keeps the radiance of every transport class.
#[derive(Clone, Copy, Default)]
pub struct ByClass(pub [Spectrum; 7]);

impl Observer for ByClass {
    const CLASSES: bool = true;
    fn light(&mut self, radiance: Spectrum, classes: &Classes) {
        classes.split(radiance, &mut self.0);
    }
}

/// Counts rays.
#[derive(Clone, Copy, Default)]
pub struct RayCount(pub u64);

impl Observer for RayCount {
    #[inline]
    fn ray(&mut self) {
        self.0 += 1;
    }
}

/// Two who watch together; the first hears of light, the second of rays.
impl Observer for (ByClass, RayCount) {
    const CLASSES: bool = true;
    fn ray(&mut self) {
        self.1.ray();
    }
    fn light(&mut self, radiance: Spectrum, classes: &Classes) {
        self.0.light(radiance, classes);
    }
}

/// Radiance along a camera ray, with what the film keeps of the first surface.
pub fn radiance<O: Observer>(method: &Method, ray: &Ray, sampler: &mut Sampler, watch: &mut O) -> PixelSample {
    match method.integrator {
        Integrator::Raycast => raycast::estimate(method, ray, sampler, watch),
        Integrator::Local => local::estimate(method, ray, sampler, watch),
        Integrator::Whitted => whitted::estimate(method, ray, sampler, watch),
        Integrator::Path => path::estimate(method, ray, sampler, watch),
    }
}

/// What the film keeps of the first surface.
fn first_surface(sample: &mut PixelSample, ray: &Ray, shading: &Shading) {
    let vertex = shading.vertex;
    sample.alpha = 1.0;
    sample.depth = (vertex.surface.p - ray.o).length();
    sample.normal = if vertex.front { shading.frame.n } else { -shading.frame.n }.into();
    sample.albedo = shading.albedo();
}

/// β times the radiance that the light sampler finds for a vertex: one light, one shadow ray,
///
/// ```text
/// ∫ f(x, ωi, ωo) Le(x, ωi) |cos θi| dωi  ≈  f Le |cos θi| w / pdf
/// ```
///
/// w = 1 where only lights are sampled, the power heuristic of the light's and the BSDF's density where both are.
/// Strategies that sample directions alone still need this for lights that no direction finds (points, parallel
/// light).
pub fn direct_light<O: Observer>(
    method: &Method,
    walk: &Walk,
    shading: &Shading,
    u: &Numbers,
    watch: &mut O,
) -> Spectrum {
    let scene = method.scene;
    let receiver = shading.receiver();
    let Some((index, light)) = scene.lights.sample(&receiver, u.light_choice, u.light, &scene.textures) else {
        return Spectrum::ZERO;
    };
    // f |cos θ|, and the density of the other sampler.
    let CosineEval { f_cos, specular, pdf } = shading.eval(light.wi);
    // How much of this light is the light sampler's share?
    let share = match (light.pdf, method.strategy) {
        (Pdf::Discrete(p), _) => 1.0 / p,
        (Pdf::SolidAngle(light_pdf), Strategy::Mis) => power_heuristic(light_pdf, pdf) / light_pdf,
        (Pdf::SolidAngle(light_pdf), Strategy::Light) => 1.0 / light_pdf,
        (Pdf::SolidAngle(_), Strategy::Uniform | Strategy::Cosine | Strategy::Bsdf) => return Spectrum::ZERO,
    };
    if f_cos.is_black() {
        return Spectrum::ZERO;
    }
    // The shadow ray.
    watch.ray();
    let media = shading.interface.crossed(shading.vertex, light.wi).unwrap_or(&walk.media);
    let seen = scene.visibility(shading.vertex, index, &light, media, method.most_sheets(walk.depth));
    if seen.share.is_black() {
        return Spectrum::ZERO;
    }
    let mut arriving = light.le * seen.share * share;
    if !media.is_empty() {
        arriving *= scene.media.transmittance(media, light.distance);
    }
    let light = walk.beta * (f_cos * arriving);
    if O::CLASSES {
        // Each sheet on the way is a specular transmission.
        let classes = (0..seen.sheets).fold(walk.classes.reflected(f_cos, specular), |c, _| c.reflected(f_cos, f_cos));
        watch.light(light, &classes);
    }
    light
}

/// Weight of light that a drawn direction met, where `light_pdf` is the density with which the light sampler would
/// have drawn the same direction.
fn weight_of_hit(strategy: Strategy, sampled_by: SampledBy, light_pdf: impl FnOnce(&LightSampleContext) -> f32) -> f32 {
    match (sampled_by, strategy) {
        (SampledBy::Camera | SampledBy::Delta, _) => 1.0,
        (_, Strategy::Uniform | Strategy::Cosine | Strategy::Bsdf) => 1.0,
        (SampledBy::Smooth { pdf, from }, Strategy::Mis) => power_heuristic(pdf, light_pdf(&from)),
        (SampledBy::Smooth { from, .. }, Strategy::Light) => f32::from(light_pdf(&from) == 0.0),
    }
}

/// Power heuristic with β = 2 for one sample each (Veach 1997, section 9.2.2): a²/(a² + b²), without overflow.
pub fn power_heuristic(a: f32, b: f32) -> f32 {
    if a == f32::INFINITY {
        return 1.0;
    }
    if a == 0.0 {
        return 0.0;
    }
    let ratio = b / a;
    1.0 / (1.0 + ratio * ratio)
}

/// Le that the ray's end sends back, weighted for how the ray was drawn; with the light it belongs to.
#[inline(always)]
fn emitted(method: &Method, vertex: &Vertex, sampled_by: SampledBy) -> Spectrum {
    vertex.light.map_or(Spectrum::ZERO, |light| emitted_by(method, light, vertex, sampled_by))
}

/// [`emitted`] by this light.
#[inline(never)]
fn emitted_by(method: &Method, light: u32, vertex: &Vertex, sampled_by: SampledBy) -> Spectrum {
    let scene = method.scene;
    let le = scene.emission(vertex);
    if le.is_black() {
        return Spectrum::ZERO;
    }
    let s = &vertex.surface;
    le * weight_of_hit(method.strategy, sampled_by, |from| scene.lights.pdf_hit(light, from, s.p, s.ng))
}

/// Light from infinity along a ray that met nothing.
fn environment(method: &Method, ray: &Ray, sampled_by: SampledBy) -> Spectrum {
    let lights = &method.scene.lights;
    let SampledBy::Smooth { from, .. } = sampled_by else { return lights.environment_le(ray.d) };
    let (le, pdf) = lights.environment_le_and_pdf(&from, ray.d);
    le * weight_of_hit(method.strategy, sampled_by, |_| pdf)
}

/// Whether light that the light sampler finds is reflected.
fn sees_lights(shading: &Shading, scene: &Scene) -> bool {
    shading.bsdf.has_smooth() && !scene.lights.is_empty()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_heuristic_is_a_partition_of_one() {
        for (a, b) in [(1.0, 2.0), (1e-30, 1e-20), (1e30, 1e20), (0.0, 1.0), (3.0, 0.0)] {
            assert!((power_heuristic(a, b) + power_heuristic(b, a) - 1.0).abs() < 1e-6, "{a} {b}");
        }
        assert_eq!(power_heuristic(f32::INFINITY, 1.0), 1.0);
    }
}
