//! A BSDF seen from one direction: what is looked up of the direction once, and the choice among lobes.

use super::energy::Energy;
use super::entry::{Entry, MAX_LAYERS, Transmitted, transmitted};
use super::lambert::sample_cosine;
use super::lobe::Aspect;
use super::{Bsdf, Class, Eval, MAX_LOBES, Pdf, Sample, Transport};
use crate::spectrum::Spectrum;
use arrayvec::ArrayVec;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// What a BSDF looks up of a direction.
#[derive(Clone, Debug)]
pub struct Toward {
    aspects: ArrayVec<Aspect, MAX_LOBES>,
    /// Σ weight.
    total: f32,
    transmitted: Transmitted,
}

impl Default for Toward {
    #[inline]
    fn default() -> Self {
        Self { aspects: ArrayVec::new(), total: 0.0, transmitted: [1.0; MAX_LAYERS] }
    }
}

/// Room for the lobes of a hit and for what is looked up of them: kept from vertex to vertex.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// Lobes that vary over the surface.
    pub bsdf: Bsdf,
    /// Of the direction that they are seen from.
    pub toward: Toward,
}

impl Scratch {
    /// Empty.
    #[inline]
    pub fn new() -> Self {
        Self::default()
    }
}

/// A BSDF that is seen from `wo`: draws, and values for any other direction. Weights of lobes and energies of microsurfaces
/// towards `wo` are looked up once.
#[derive(Clone, Copy, Debug)]
pub struct BsdfAt<'a> {
    bsdf: &'a Bsdf,
    toward: &'a Toward,
    wo: Vec3,
}

impl Bsdf {
    /// The BSDF seen from `wo` (local, unit); `room` takes what is looked up.
    #[inline(always)]
    pub fn towards<'a>(&'a self, wo: Vec3, room: &'a mut Toward) -> BsdfAt<'a> {
        if self.lambert.is_none() {
            self.look(wo, room);
        }
        BsdfAt { bsdf: self, toward: room, wo }
    }

    #[inline(never)]
    fn look(&self, w: Vec3, room: &mut Toward) {
        if !self.layers.is_empty() {
            room.transmitted = transmitted(&self.layers, w);
        }
        room.aspects.clear();
        room.total = 0.0;
        let mut energy = Energy::default();
        for entry in &self.entries {
            let aspect = entry.aspect(entry.to_local(w), &room.transmitted, &mut energy);
            room.total += aspect.weight;
            room.aspects.push(aspect);
        }
    }

    /// A draw from `wo`, for those that ask but once: see [`BsdfAt::sample`].
    #[inline]
    pub fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2], mode: Transport) -> Option<Sample> {
        self.towards(wo, &mut Toward::default()).sample(uc, u, mode)
    }

    /// f and densities of a pair of directions, for those that ask but once: see [`BsdfAt::eval`].
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3, mode: Transport) -> Eval {
        self.towards(wo, &mut Toward::default()).eval(wi, mode)
    }

    /// Probability that a draw from `wo` takes a delta lobe.
    pub fn delta_probability(&self, wo: Vec3) -> f32 {
        self.towards(wo, &mut Toward::default()).delta_probability()
    }

    /// A draw among the delta lobes, for those that ask but once: see [`BsdfAt::sample_delta`].
    pub fn sample_delta(&self, wo: Vec3, uc: f32, mode: Transport) -> Option<Sample> {
        self.towards(wo, &mut Toward::default()).sample_delta(uc, mode)
    }
}

impl<'a> BsdfAt<'a> {
    /// The direction that it is seen from.
    #[inline]
    pub fn wo(&self) -> Vec3 {
        self.wo
    }

    /// The lobes, bound to no direction.
    #[inline]
    pub fn bsdf(&self) -> &'a Bsdf {
        self.bsdf
    }

    /// Nothing scatters.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.bsdf.is_empty()
    }

    /// Some lobe is no delta: sampling lights makes sense.
    #[inline]
    pub fn has_smooth(&self) -> bool {
        self.bsdf.has_smooth()
    }

    /// Light can come from below, other than as a delta.
    #[inline]
    pub fn transmits(&self) -> bool {
        self.bsdf.transmits()
    }

    /// Directional albedo, reflection and transmission together.
    pub fn albedo(&self) -> Spectrum {
        self.bsdf.albedo(self.wo)
    }

    /// Lobes and what is known of them towards `wo`.
    #[inline]
    fn entries(&self) -> impl Iterator<Item = (&'a Entry, &'a Aspect)> {
        self.bsdf.entries.iter().zip(&self.toward.aspects)
    }

    fn delta_weight(&self) -> f32 {
        self.entries().filter(|(e, _)| e.lobe.is_delta()).map(|(_, a)| a.weight).sum()
    }

    /// Probability that [`Self::sample`] chooses a delta lobe.
    pub fn delta_probability(&self) -> f32 {
        self.delta_weight() / self.toward.total.max(1e-30)
    }

    /// Chooses a direction: `uc` picks the lobe (and what it picks itself), `u` the direction. `None` where nothing
    /// scatters, where the draw failed (its share of the density is lost: it counts as 0), or at a grazing `wo`.
    #[inline(always)]
    pub fn sample(&self, uc: f32, u: [f32; 2], mode: Transport) -> Option<Sample> {
        self.sample_and(uc, u, mode, Some)
    }

    /// [`Self::sample`] and what follows it, `then`: which is inlined twice, so that the draw of a Lambertian lobe stays in
    /// registers. Where it met the result of a call, both would pass through memory.
    #[inline(always)]
    pub(crate) fn sample_and<T>(
        &self,
        uc: f32,
        u: [f32; 2],
        mode: Transport,
        then: impl Fn(Sample) -> Option<T>,
    ) -> Option<T> {
        if self.wo.z == 0.0 {
            return None;
        }
        match self.bsdf.lambert {
            Some(weight) => {
                let wi = sample_cosine(self.wo, u);
                let pdf = Pdf::SolidAngle(wi.z.abs() * FRAC_1_PI);
                let draw = Sample { wi, weight, specular: Spectrum::ZERO, pdf, eta: 1.0 };
                if wi.z == 0.0 { None } else { then(draw) }
            }
            None => then(self.sample_mixture(uc, u, mode)?),
        }
    }

    #[inline(never)]
    fn sample_mixture(&self, uc: f32, u: [f32; 2], mode: Transport) -> Option<Sample> {
        let (entry, aspect, uc) = self.choose(uc, self.toward.total, |_| true)?;
        if entry.lobe.is_delta() {
            return self.draw_delta(entry, aspect, uc, mode);
        }
        let (wi, eta) = entry.sample(self.wo, aspect, uc, u)?;
        let Eval { f, specular, pdf, .. } = self.eval_mixture(wi, mode);
        let k = wi.z.abs() / pdf;
        // A density below the range of f32 gives no number to divide by.
        (pdf > 0.0 && k.is_finite() && wi.z != 0.0).then(|| Sample {
            wi,
            weight: f * k,
            specular: specular * k,
            pdf: Pdf::SolidAngle(pdf),
            eta,
        })
    }

    /// f and densities of the non-delta lobes for `wo` and any `wi`.
    #[inline]
    pub fn eval(&self, wi: Vec3, mode: Transport) -> Eval {
        match self.bsdf.lambert {
            Some(_) if self.wo.z * wi.z <= 0.0 => Eval::default(),
            Some(albedo) => Eval {
                f: albedo * FRAC_1_PI,
                specular: Spectrum::ZERO,
                pdf: wi.z.abs() * FRAC_1_PI,
                pdf_rev: self.wo.z.abs() * FRAC_1_PI,
            },
            None => self.eval_mixture(wi, mode),
        }
    }

    #[inline(never)]
    fn eval_mixture(&self, wi: Vec3, mode: Transport) -> Eval {
        let mut eval = Eval::default();
        let Self { bsdf, toward, wo } = self;
        if !bsdf.transmits && wo.z * wi.z <= 0.0 {
            return eval;
        }
        let layered = !bsdf.layers.is_empty();
        let from_wi = if layered { transmitted(&bsdf.layers, wi) } else { [1.0; MAX_LAYERS] };
        let (mut energy, mut total) = (Energy::default(), 0.0);
        for (e, seen_o) in self.entries() {
            let i = e.to_local(wi);
            let seen_i = e.aspect(i, &from_wi, &mut energy);
            total += seen_i.weight;
            let (f, pdf, pdf_rev) = e.eval([*wo, wi], [e.to_local(*wo), i], [seen_o, &seen_i], mode);
            let f = f * (e.scale * if layered { e.dimmed(&toward.transmitted, &from_wi) } else { 1.0 });
            eval.f += f;
            if e.lobe.class() == Class::Specular {
                eval.specular += f;
            }
            eval.pdf += pdf * seen_o.weight;
            eval.pdf_rev += pdf_rev * seen_i.weight;
        }
        eval.pdf /= toward.total.max(1e-30);
        eval.pdf_rev /= total.max(1e-30);
        eval
    }

    /// Chooses among the delta lobes only; the probability is the one that [`Self::sample`] would have had.
    pub fn sample_delta(&self, uc: f32, mode: Transport) -> Option<Sample> {
        let (entry, aspect, uc) = self.choose(uc, self.delta_weight(), |e| e.lobe.is_delta())?;
        if self.wo.z == 0.0 { None } else { self.draw_delta(entry, aspect, uc, mode) }
    }

    /// The lobe at `uc` of those that `among` admits, whose weights sum to `sum`, and `uc` rescaled to [0, 1) in it.
    #[inline]
    fn choose(&self, uc: f32, sum: f32, among: impl Fn(&Entry) -> bool) -> Option<(&'a Entry, &'a Aspect, f32)> {
        let mut rest = uc * sum;
        let mut last = None;
        for (entry, aspect) in self.entries().filter(|(e, _)| among(e)) {
            if rest < aspect.weight {
                return Some((entry, aspect, (rest / aspect.weight).min(crate::warp::ONE_MINUS_EPSILON)));
            }
            rest -= aspect.weight;
            last = Some((entry, aspect, crate::warp::ONE_MINUS_EPSILON));
        }
        last
    }

    fn draw_delta(&self, entry: &Entry, aspect: &Aspect, uc: f32, mode: Transport) -> Option<Sample> {
        let chosen = aspect.weight / self.toward.total;
        let deltas = entry.deltas(self.wo, mode);
        let first = deltas[0].filter(|d| uc < d.probability);
        let d = first.or(deltas[1]).or(deltas[0])?;
        let scale = entry.scale * self.bsdf.dimmed(entry, self.wo, d.wi);
        let weight = d.weight * (scale / (chosen * d.probability));
        Some(Sample { wi: d.wi, weight, specular: weight, pdf: Pdf::Discrete(chosen * d.probability), eta: d.eta })
    }
}
