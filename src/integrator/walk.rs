//! One random walk from the camera, and its next step.

use super::{Classes, Method, Observer, SampledBy, emitted, environment, medium};
use crate::bsdf::Scratch;
use crate::math::Ray;
use crate::medium::MediumStack;
use crate::sampler::Sampler;
use crate::scene::{DirectionSample, MediumInterface, PrimitiveRef, Shading, Vertex};
use crate::spectrum::Spectrum;

/// A path as far as it has come: all that its next step depends on. A copy is a second path that begins with the same
/// vertices, of which a tree of paths makes one for each branch.
#[derive(Clone, Debug)]
pub struct Walk {
    /// The ray to be followed.
    pub ray: Ray,
    /// The primitive that the ray leaves, which it cannot meet again.
    pub excluded: PrimitiveRef,
    /// The media about the ray's origin.
    pub media: MediumStack,
    /// The only lane that is left behind a dispersive interface.
    pub lane: Option<usize>,
    /// Throughput: the product of f |cos| / pdf and of transmittances.
    pub beta: Spectrum,
    /// η² of all refractions: `beta` holds radiance, which they scale, and roulette looks at `beta` without.
    pub eta_scale: f32,
    /// How the ray was drawn.
    pub sampled_by: SampledBy,
    /// Specular shares of the last two reflections before the eye.
    pub classes: Classes,
    /// Vertices that the path has left.
    pub depth: u32,
    /// The sampler's dimension at the first vertex.
    first_dimension: u32,
}

/// What a ray leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A surface.
    Surface,
    /// Nothing: it leaves the scene.
    Escaped,
}

/// The random numbers of one vertex that every path needs. They do not wait for the vertex: the processor computes them
/// while the ray is traced.
#[derive(Clone, Copy, Debug)]
pub struct Numbers {
    /// Choice of a light.
    pub light_choice: f32,
    /// Point on the light.
    pub light: [f32; 2],
    /// Choice of a lobe.
    pub lobe_choice: f32,
    /// Direction of the lobe.
    pub lobe: [f32; 2],
}

/// Dimensions of the sampler that belong to a vertex. Every decision has a fixed one among them, whether it is taken or
/// not, so that each stays stratified over the samples of a pixel.
const DIMENSIONS: u32 = 11;
/// Whether the path goes on to the vertex.
const ROULETTE: u32 = 0;
/// Six of [`Numbers`].
const NUMBERS: u32 = 2;
/// The lane behind a dispersive interface.
const LANE: u32 = 8;
/// Two for light that a bent normal leaks.
const LEAK: u32 = 9;

impl Walk {
    /// At the camera; `sampler` stands where the numbers of the first vertex begin.
    #[inline(always)]
    pub fn new(method: &Method, ray: &Ray, sampler: &Sampler) -> Self {
        Self {
            ray: Ray { o: ray.o, d: ray.d, t_max: ray.t_max },
            excluded: PrimitiveRef::NONE,
            media: method.scene.media_at(&method.media, ray.o),
            lane: None,
            beta: Spectrum::ONE,
            eta_scale: 1.0,
            sampled_by: SampledBy::Camera,
            classes: Classes::default(),
            depth: 0,
            first_dimension: sampler.dimension(),
        }
    }

    /// Moves the sampler to a dimension of the next vertex.
    #[inline(always)]
    fn seek(&self, sampler: &mut Sampler, dimension: u32) {
        let vertex = self.depth.wrapping_mul(DIMENSIONS).wrapping_add(dimension);
        sampler.skip_to(self.first_dimension.wrapping_add(vertex));
    }

    /// Numbers of the next vertex.
    #[inline(always)]
    pub fn numbers(&self, sampler: &mut Sampler) -> Numbers {
        self.seek(sampler, NUMBERS);
        let [light_choice, lobe_choice] = sampler.next_2d();
        Numbers { light_choice, lobe_choice, light: sampler.next_2d(), lobe: sampler.next_2d() }
    }

    /// Follows the ray to the next event. `vertex` is written where a surface is met. Opacities on the way draw from a branch
    /// of the sampler, as their number is unknown.
    #[inline(always)]
    pub fn advance<O: Observer>(
        &mut self,
        method: &Method,
        sampler: &Sampler,
        vertex: &mut Vertex,
        watch: &mut O,
    ) -> Event {
        watch.ray();
        let (mut branch, depth) = (None, self.depth);
        let mut opacity = || branch.get_or_insert_with(|| sampler.fork(!depth)).next_1d();
        let met = method.scene.intersect_into(&self.ray, self.excluded, &mut self.media, &mut opacity, vertex);
        self.beta *= medium::transmittance(method, &self.ray, met.then_some(vertex), &self.media);
        if met {
            return Event::Surface;
        }
        watch.escaped(self.depth, &self.ray, self.beta);
        Event::Escaped
    }

    /// β Le of what the ray led to, weighted for how the ray was drawn.
    #[inline(always)]
    pub fn emission<O: Observer>(&self, method: &Method, event: Event, vertex: &Vertex, watch: &mut O) -> Spectrum {
        let le = match event {
            Event::Surface => emitted(method, vertex, self.sampled_by),
            Event::Escaped => environment(method, &self.ray, self.sampled_by),
        };
        let light = self.beta * le;
        watch.light(light, &self.classes);
        light
    }

    /// A path that meets its first dispersive interface goes on with one lane alone.
    #[inline(always)]
    pub fn choose_lane(&mut self, method: &Method, interface: &MediumInterface, sampler: &mut Sampler) {
        if self.lane.is_none() && method.scene.media.disperses(interface) {
            self.seek(sampler, LANE);
            let (lane, factor) = medium::choose_lane(self.beta, sampler.next_1d());
            self.lane = Some(lane);
            self.beta *= factor;
        }
    }

    /// The BSDF at the vertex, between the media of `interface`; `scratch` holds lobes that vary over the surface.
    #[inline(always)]
    pub fn shade<'a>(
        &self,
        method: &Method<'a>,
        sampler: &mut Sampler,
        vertex: &'a Vertex,
        interface: &'a MediumInterface,
        scratch: &'a mut Scratch,
    ) -> Shading<'a> {
        let leak = || {
            self.seek(sampler, LEAK);
            sampler.next_2d()
        };
        method.scene.shade(vertex, interface, self.lane, leak, scratch)
    }

    /// Goes on as `next` was drawn at the vertex of `shading`.
    #[inline(always)]
    pub fn scatter<O: Observer>(&mut self, shading: &Shading, next: &DirectionSample, watch: &mut O) {
        let sampled_by = SampledBy::new(next.pdf, shading);
        self.beta *= next.weight;
        self.eta_scale *= next.eta * next.eta;
        // Light sampling looks through thin sheets. What passes one straight on meets lights as if it were not there: as
        // the direction was drawn, or the light would count twice.
        if !next.straight {
            self.sampled_by = sampled_by;
        }
        if let Some(across) = shading.interface.crossed(shading.vertex, next.wi) {
            self.media = across.clone();
        }
        (self.ray, self.excluded) = (shading.ray(next.wi), shading.vertex.primitive);
        self.depth += 1;
        watch.sampled(sampled_by, self.beta);
        if O::CLASSES {
            self.classes = self.classes.reflected(next.weight, next.specular);
        }
    }

    /// Russian roulette: whether the path goes on; its `beta` is then divided by the probability that it does.
    #[inline(always)]
    pub fn survives(&mut self, sampler: &mut Sampler) -> bool {
        /// Throughput below which roulette is played; the survivors are held there. What a game at greater throughput saves
        /// it costs in variance: on the Cornell box error times seconds is least, and flat, from 1/2 to 1/6, and 40 %
        /// greater where the game is played from the start.
        const THRESHOLD: f32 = 1.0 / 3.0;
        /// From this many reflections on it is played at any throughput, so that lossless paths end.
        const DEPTH: u32 = 8;
        /// Greatest probability of survival.
        const MOST: f32 = 0.999;
        if self.beta.is_black() {
            return false;
        }
        let throughput = self.beta.max_element() * self.eta_scale;
        throughput >= THRESHOLD && self.depth <= DEPTH || self.plays(sampler, (throughput / THRESHOLD).min(MOST))
    }

    /// Goes on with `probability`.
    #[inline(always)]
    pub(super) fn plays(&mut self, sampler: &mut Sampler, probability: f32) -> bool {
        self.seek(sampler, ROULETTE);
        if sampler.next_1d() >= probability {
            return false;
        }
        self.beta *= 1.0 / probability;
        true
    }
}
