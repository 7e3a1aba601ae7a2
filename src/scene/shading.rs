//! The BSDF at a vertex, in world space.

use super::{MediumInterface, Vertex};
use crate::bsdf::{BsdfAt, Eval, Pdf, Sample, Scratch, Transport};
use crate::light::{Facing, LightSampleContext};
use crate::material::Material;
use crate::math::{Frame, Ray, offset_origin, renormalize};
use crate::spectrum::Spectrum;
use crate::texture::Textures;
use arrayvec::ArrayVec;
use glam::{Vec3, Vec3A};

/// The BSDF at a vertex for light that leaves towards the vertex's `wo`. It is that of the material, about the shading normal;
/// where this is bent away from the geometric normal, it is f′ of `bent.rs`.
#[derive(Clone, Copy, Debug)]
pub struct Shading<'a> {
    /// Where.
    pub vertex: &'a Vertex,
    /// The media on both sides.
    pub interface: &'a MediumInterface,
    /// Shading frame: z is the shading normal, on the front side.
    pub frame: Frame,
    /// Towards where the ray came from, local, as the shading normal sees it: on the front of it where the ray came from
    /// the front of the surface.
    pub wo: Vec3,
    /// What scatters about the shading normal, seen from `wo`.
    pub bsdf: BsdfAt<'a>,
    /// n·g, the cosine of the angle between shading and geometric normal; 1 where they differ by no more than rounding.
    pub(super) cos_bend: f32,
    /// Two random numbers of this visit, to be set where the normal is bent: the angle about the geometric normal by which
    /// leaked light is turned, and the choice of a way out when a direction is drawn.
    pub leak: [f32; 2],
}

/// f |cos θi| and density for a pair of directions, of all but deltas.
#[derive(Clone, Copy, Debug, Default)]
pub struct CosineEval {
    /// f |cos θi| \[1/sr\].
    pub f_cos: Spectrum,
    /// The part of it that specular lobes give.
    pub specular: Spectrum,
    /// Density \[1/sr\] with which [`Shading::sample`] draws the direction.
    pub pdf: f32,
}

/// A direction drawn from the BSDF at a vertex.
#[derive(Clone, Copy, Debug)]
pub struct DirectionSample {
    /// The direction, world space, unit.
    pub wi: Vec3A,
    /// f |cos θi| / pdf.
    pub weight: Spectrum,
    /// The part of it that specular lobes give.
    pub specular: Spectrum,
    /// Density or probability of the draw.
    pub pdf: Pdf,
    /// Relative index of refraction crossed.
    pub eta: f32,
    /// It passes a smooth thin sheet straight on, which light sampling looks through.
    pub straight: bool,
}

impl<'a> Shading<'a> {
    /// Evaluates the material in vacuum; lobes that vary over the surface are put into `scratch`.
    #[inline]
    pub fn new(material: &'a Material, vertex: &'a Vertex, textures: &Textures, scratch: &'a mut Scratch) -> Self {
        static VACUUM: MediumInterface = MediumInterface::VACUUM;
        Self::between(material, vertex, textures, &VACUUM, None, || [0.5; 2], scratch)
    }

    /// Evaluates the material between the media of `interface`, where the index behind the surface over the one before it is
    /// `eta`; `None`: the material's own. `leak` gives the numbers of [`Self::leak`], where the normal is bent.
    #[inline(always)]
    pub fn between(
        material: &'a Material,
        vertex: &'a Vertex,
        textures: &Textures,
        interface: &'a MediumInterface,
        eta: Option<f32>,
        leak: impl FnOnce() -> [f32; 2],
        scratch: &'a mut Scratch,
    ) -> Self {
        /// 1 − cos of an angle that is rounding.
        const ROUNDING: f32 = 2e-6;
        let s = &vertex.surface;
        let ns = material.shading_normal(s, textures).unwrap_or(s.ns);
        let frame = Frame::from_z_tangent(ns, s.tangent, s.handedness);
        let wo = seen(frame.to_local(vertex.wo), vertex.front);
        let bsdf = material.bsdf_between(s, wo, textures, eta, scratch);
        let cos_bend = ns.dot(s.ng);
        let (cos_bend, leak) = if 1.0 - cos_bend > ROUNDING { (cos_bend, leak()) } else { (1.0, [0.5; 2]) };
        Self { vertex, interface, frame, wo, bsdf, cos_bend, leak }
    }

    /// f |cos θi| and density towards the world direction `wi`.
    #[inline(always)]
    pub fn eval(&self, wi: Vec3A) -> CosineEval {
        let (local, cos) = (self.frame.to_local(wi), wi.dot(self.vertex.surface.ng));
        if self.is_bent() && !self.is_unchanged(cos, local.z) {
            return self.eval_bent(wi);
        }
        if cos * local.z <= 0.0 {
            return CosineEval::default();
        }
        CosineEval::new(self.bsdf.eval(local, Transport::Radiance), local.z.abs())
    }

    /// Draws a direction: `choice` picks the lobe, `u` the direction in it.
    #[inline(always)]
    pub fn sample(&self, choice: f32, u: [f32; 2]) -> Option<DirectionSample> {
        self.bsdf.sample_and(choice, u, Transport::Radiance, |draw| self.leave(draw))
    }

    /// Draws from the delta lobes alone, with the probability that [`Self::sample`] has.
    pub fn sample_delta(&self, choice: f32) -> Option<DirectionSample> {
        self.leave(self.bsdf.sample_delta(choice, Transport::Radiance)?)
    }

    /// Where a draw about the shading normal leaves the surface.
    #[inline(always)]
    fn leave(&self, draw: Sample) -> Option<DirectionSample> {
        let wi = renormalize(self.frame.to_world(draw.wi));
        let (cos, is_delta) = (wi.dot(self.vertex.surface.ng), matches!(draw.pdf, Pdf::Discrete(_)));
        if self.is_bent() && (is_delta || !self.is_unchanged(cos, draw.wi.z)) {
            // A copy: the draw itself, whose address nobody has, stays in registers.
            let Sample { wi, weight, specular, pdf, eta } = draw;
            return self.leave_bent(&Sample { wi, weight, specular, pdf, eta });
        }
        let straight = self.is_straight(&draw) && self.bsdf.bsdf().straight(self.wo).is_some();
        (cos * draw.wi.z > 0.0).then(|| DirectionSample::new(wi, &draw, draw.pdf, straight))
    }

    /// A delta passes straight on.
    #[inline]
    pub(super) fn is_straight(&self, draw: &Sample) -> bool {
        matches!(draw.pdf, Pdf::Discrete(_)) && draw.eta == 1.0 && draw.wi == -self.wo
    }

    /// Every delta direction with its f |cos θ|, for branching: the weight is divided by no probability, and the pdf
    /// is `Discrete(1)`.
    pub fn deltas(&self) -> ArrayVec<DirectionSample, 20> {
        let mut all = ArrayVec::new();
        for draw in self.bsdf.bsdf().deltas(self.wo, Transport::Radiance) {
            if self.is_bent() {
                all.extend(self.ways_out(&draw));
            } else {
                all.extend(self.leave(draw));
            }
        }
        all
    }

    /// Directional albedo, reflection and transmission together.
    pub fn albedo(&self) -> Spectrum {
        self.bsdf.albedo()
    }

    /// Who asks for light here: the half-space above the surface on the side of `wo`, or both where something is transmitted.
    #[inline]
    pub fn receiver(&self) -> LightSampleContext {
        let (p, n) = (self.vertex.surface.p, self.vertex.surface.ng);
        let n = if self.vertex.front { n } else { -n };
        LightSampleContext { p, facing: if self.bsdf.transmits() { Facing::Both(n) } else { Facing::Half(n) } }
    }

    /// The shading normal differs from the geometric one by more than rounding.
    #[inline]
    pub fn is_bent(&self) -> bool {
        self.cos_bend < 1.0
    }

    /// The ray that leaves along the world direction `wi`, off the surface by its error bound.
    #[inline]
    pub fn ray(&self, wi: Vec3A) -> Ray {
        let s = &self.vertex.surface;
        Ray::new(offset_origin(s.p, s.p_error, s.ng, wi), wi)
    }
}

impl CosineEval {
    #[inline]
    fn new(eval: Eval, cos: f32) -> Self {
        Self { f_cos: eval.f * cos, specular: eval.specular * cos, pdf: eval.pdf }
    }

    /// Adds `share` of another.
    pub(super) fn add(&mut self, eval: Eval, cos: f32, share: f32) {
        let k = cos * share;
        self.f_cos += eval.f * k;
        self.specular += eval.specular * k;
        self.pdf += eval.pdf * share;
    }
}

impl DirectionSample {
    #[inline]
    pub(super) fn new(wi: Vec3A, draw: &Sample, pdf: Pdf, straight: bool) -> Self {
        Self { wi, weight: draw.weight, specular: draw.specular, pdf, eta: draw.eta, straight }
    }
}

/// The local direction `w` as a facet sees it from its front, or from its back: reflected in its plane where it lies on the other
/// side, and never quite in the plane.
#[inline]
pub(super) fn seen(w: Vec3, front: bool) -> Vec3 {
    const LEAST: f32 = 1e-6;
    let z = w.z.abs().max(LEAST);
    Vec3::new(w.x, w.y, if front { z } else { -z })
}
