//! Bent shading normals as BSDFs.
//!
//! A shading normal n that is not the geometric one g, from a normal map or interpolated, stands for a facet too small to see.
//! Taken as it is, its BSDF f sends light into the surface and is seen from directions that look at the facet's back. The
//! BSDF f′ of the surface is made of f and two rules.
//!
//! *Seen*: a direction o on the facet's other side, (o·n)(o·g) < 0, sees it as its reflection in the facet's plane does,
//! ô = o − 2(o·n)n. Else ô = o.
//!
//! *Leaving*: light that f scatters towards w leaves as it is with probability
//!
//! ```text
//! G(w) = min(1, c (w·g)/(w·n)),   0 where w is on different sides of both;   c = 2
//! ```
//!
//! and otherwise as if the facet lay flat: towards Tw, where T turns n to g, and then by an angle about g that is
//! uniformly random. (Such light would meet the neighbouring facets, of which a flat surface has as many on every side.) Given that
//! angle, T is a rotation and f′ a function: with c = T⁻¹i,
//!
//! ```text
//! f′(o, i) |i·g|  =  G(i) f(ô, i) |i·n|  +  (1 − G(T⁻¹i)) f(ô, T⁻¹i) |i·g|
//! pdf′(o, i)      =  G(i) pdf(ô, i)      +  (1 − G(T⁻¹i)) pdf(ô, T⁻¹i)
//! ```
//!
//! since T⁻¹i·n = i·g. As T preserves solid angle and both ways out have probability 1 together, the albedo of f′ at o is that of f at ô
//! exactly: white stays white, and nothing is created. f′|i·g| is continuous, vanishes at the horizon (where shading by
//! normals alone ends at a hard line: c = 2 lets light fade at twice the slope of Lambert's; Chiang et al. 2019, "Taming the Shadow
//! Terminator", take 1/(n·g)), and f′ is at most a bounded multiple of f.
//!
//! f′ is not reciprocal: a facet of Lambert's law as bright as a painter wants it, (i·n) from every side, cannot be.
//! Its adjoint, which particles from lights need, is f′ with the directions exchanged, and bounded too (Veach 1997, section 5.3,
//! has the unbounded adjoint of normals alone). The facets of Schüssler et al. (2017, "Microfacet-based Normal Mapping for Robust
//! Monte Carlo Path Tracing") are reciprocal, and Lambert's law hardly shows their slope.
//!
//! What a thin sheet lets pass straight on is exempt: it goes straight on.

use super::shading::{CosineEval, DirectionSample, Shading, seen};
use crate::bsdf::{Eval, Pdf, Sample, Transport};
use crate::math::{Frame, renormalize};
use arrayvec::ArrayVec;
use glam::{Vec3, Vec3A};

/// c.
const FADE: f32 = 2.0;

/// G for the cosines of a direction to the geometric and to the shading normal.
#[inline]
fn direct(cos_g: f32, cos_n: f32) -> f32 {
    // 0/0 is a direction in both planes, which nothing leaves by.
    let ratio = FADE * cos_g / cos_n;
    if ratio > 0.0 { ratio.min(1.0) } else { 0.0 }
}

impl Shading<'_> {
    /// Whether f′ |i·g| = f |i·n| towards a direction of these cosines to the geometric and the shading normal: it leaves
    /// as it is, and whatever the angle of the leak, nothing leaks there. That is so where c (T⁻¹i·g) ≥ i·g, and since
    /// T⁻¹i is at the angle θ of i from n, and so at most at θ + β from g, where
    ///
    /// ```text
    /// (c cos β − 1) cos θ ≥ c sin β sin θ
    /// ```
    #[inline(always)]
    pub(super) fn is_unchanged(&self, cos_g: f32, cos_n: f32) -> bool {
        let k = (FADE * self.cos_bend - 1.0) * cos_g.abs();
        let sin2 = (1.0 - self.cos_bend * self.cos_bend) * (1.0 - cos_g * cos_g);
        cos_g * cos_n > 0.0 && FADE * cos_g.abs() >= cos_n.abs() && k > 0.0 && k * k >= FADE * FADE * sin2
    }

    /// T: local directions about the shading normal are those about the geometric one in this frame.
    fn leak_frame(&self) -> Frame {
        let Frame { s, t, n } = Frame::from_z(self.vertex.surface.ng);
        let (sin, cos) = (std::f32::consts::TAU * self.leak[0]).sin_cos();
        Frame { s: s * cos + t * sin, t: t * cos - s * sin, n }
    }

    /// The two local directions in which f may have sent what leaves towards the world direction `i`, each with its
    /// probability to leave this way.
    fn origins(&self, i: Vec3A) -> [(Vec3, f32); 2] {
        let ng = self.vertex.surface.ng;
        let (as_it_is, leaked) = (self.frame.to_local(i), self.leak_frame().to_local(i));
        let stays = direct(self.frame.to_world(leaked).dot(ng), leaked.z);
        [(as_it_is, direct(i.dot(ng), as_it_is.z)), (leaked, 1.0 - stays)]
    }

    /// f′ |i·g| and its density.
    #[inline(never)]
    pub(super) fn eval_bent(&self, wi: Vec3A) -> CosineEval {
        let mut sum = CosineEval::default();
        for (w, share) in self.origins(wi) {
            if share > 0.0 && w.z != 0.0 {
                sum.add(self.bsdf.eval(w, Transport::Radiance), w.z.abs(), share);
            }
        }
        sum
    }

    /// The adjoint of f′, for importance that arrives along the vertex's `wo` and leaves towards `wi`: f′(wi, wo) |wi·g|, with
    /// the density \[1/sr\] of the reverse, with which a path that arrives along `wi` is sent towards `wo`.
    pub fn eval_adjoint(&self, wi: Vec3A) -> CosineEval {
        let (cos, arriving) = (wi.dot(self.vertex.surface.ng), self.vertex.wo.dot(self.vertex.surface.ng).abs());
        let seen = seen(self.frame.to_local(wi), cos > 0.0);
        let mut sum = CosineEval::default();
        for (w, share) in self.origins(self.vertex.wo) {
            if share > 0.0 && w.z != 0.0 {
                // Of what f sends from ô to w, importance goes the other way.
                let k = w.z.abs() * cos.abs() / arriving;
                let eval = self.bsdf.bsdf().eval(w, seen, Transport::Importance);
                let pdf = self.bsdf.bsdf().eval(seen, w, Transport::Radiance).pdf;
                sum.add(Eval { pdf, ..eval }, k, share);
            }
        }
        sum
    }

    /// The ways out of light that `draw`, a delta, sends to `draw.wi`, each with its probability.
    pub(super) fn ways_out(&self, draw: &Sample) -> ArrayVec<DirectionSample, 2> {
        let mut ways = ArrayVec::new();
        let w = self.frame.to_world(draw.wi);
        let p = direct(w.dot(self.vertex.surface.ng), draw.wi.z);
        if self.is_straight(draw) {
            let straight = self.bsdf.bsdf().straight(self.wo).is_some();
            ways.push(DirectionSample::new(-self.vertex.wo, draw, draw.pdf, straight));
            return ways;
        }
        for (wi, p) in [(w, p), (self.leak_frame().to_world(draw.wi), 1.0 - p)] {
            if p > 0.0 {
                let mut way = DirectionSample::new(renormalize(wi), draw, draw.pdf, false);
                way.weight *= p;
                way.specular *= p;
                ways.push(way);
            }
        }
        ways
    }

    /// Where a draw leaves.
    #[inline(never)]
    pub(super) fn leave_bent(&self, draw: &Sample) -> Option<DirectionSample> {
        let ng = self.vertex.surface.ng;
        if self.is_straight(draw) {
            let straight = self.bsdf.bsdf().straight(self.wo).is_some();
            return Some(DirectionSample::new(-self.vertex.wo, draw, draw.pdf, straight));
        }
        let w = self.frame.to_world(draw.wi);
        let p = direct(w.dot(ng), draw.wi.z);
        let leaks = self.leak[1] >= p;
        let wi = renormalize(if leaks { self.leak_frame().to_world(draw.wi) } else { w });
        if wi.dot(ng) * draw.wi.z <= 0.0 {
            return None;
        }
        match draw.pdf {
            Pdf::Discrete(lobe) => {
                let p = if leaks { 1.0 - p } else { p };
                Some(DirectionSample::new(wi, draw, Pdf::Discrete(lobe * p), false))
            }
            Pdf::SolidAngle(_) => {
                let CosineEval { f_cos, specular, pdf } = self.eval_bent(wi);
                let k = 1.0 / pdf;
                (k.is_finite()).then(|| DirectionSample {
                    wi,
                    weight: f_cos * k,
                    specular: specular * k,
                    pdf: Pdf::SolidAngle(pdf),
                    eta: draw.eta,
                    straight: false,
                })
            }
        }
    }
}
