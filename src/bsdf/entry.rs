//! A lobe in its place: how much of it there is, in which frame, and beneath which layers.

use super::layer::{self, Layer};
use super::smooth::Delta;
use super::{Coat, CoupledDiffuse, Lobe, Transport};
use crate::math::Frame;
use crate::spectrum::Spectrum;
use arrayvec::ArrayVec;
use glam::Vec3;

/// Most layers of one BSDF: two materials of a mixture with sheen and a coat each.
pub const MAX_LAYERS: usize = 4;

/// The layers of a BSDF.
pub(super) type Layers = ArrayVec<Layer, MAX_LAYERS>;

/// T of each layer towards a direction.
pub(super) type Transmitted = [f32; MAX_LAYERS];

/// T of each layer towards `w`.
#[inline]
pub(super) fn transmitted(layers: &Layers, w: Vec3) -> Transmitted {
    let mut t = [1.0; MAX_LAYERS];
    for (t, layer) in t.iter_mut().zip(layers) {
        *t = layer.transmitted(w);
    }
    t
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) lobe: Lobe,
    /// Factor on f.
    pub(super) scale: f32,
    /// Selection probability × the sum over all entries.
    pub(super) weight: f32,
    /// The lobe's own frame in the shading frame, where it has one.
    pub(super) frame: Option<Frame>,
    /// The layers over it: from, to.
    above: [u8; 2],
    /// It lets light in and out by the product of what both ways transmit, not by the smaller of the two.
    product: bool,
}

impl Entry {
    #[inline]
    pub(super) fn new(lobe: Lobe, frame: Option<Frame>, scale: f32, weight: f32) -> Self {
        Self { lobe, scale, weight, frame, above: [0; 2], product: false }
    }

    /// It has the shading frame and lies beneath nothing.
    #[inline]
    pub(super) fn is_plain(&self) -> bool {
        self.frame.is_none() && self.above[0] == self.above[1]
    }

    /// Puts the last of the `layers` over it, which is seen from `wo`. Diffuse lobes are coupled to all over them anew.
    pub(super) fn cover(&mut self, layers: &Layers, wo: Vec3) {
        let last = layers.len() as u8;
        if self.above[0] == self.above[1] {
            self.above = [last - 1, last];
        }
        self.above[1] = last;
        if let Some(top) = layers.last() {
            self.weight *= top.transmitted(wo);
        }
        let above = &layers[usize::from(self.above[0])..];
        let diffuse = match self.lobe {
            Lobe::Lambert(l) => Some(CoupledDiffuse::new(l.reflectance, Coat::NONE)),
            Lobe::CoupledDiffuse(l) => Some(l),
            _ => None,
        };
        if let Some(diffuse) = diffuse {
            let t = |mu: f32| above.iter().map(|layer| layer.transmitted_at(mu)).product::<f32>();
            self.lobe =
                Lobe::CoupledDiffuse(diffuse.beneath(|slice, t_base| layer::mean(slice, |w| t_base(w) * t(w.z))));
            self.product = true;
        }
    }

    /// The same, chosen in proportion to `weight`.
    #[inline]
    pub(super) fn weighing(self, weight: f32) -> Self {
        Self { weight, ..self }
    }

    /// `scale` times as much of it.
    pub(super) fn times(self, scale: f32) -> Self {
        Self { scale: self.scale * scale, ..self }
    }

    /// The same entry beneath as many layers that begin `by` later.
    pub(super) fn shifted(mut self, by: u8) -> Self {
        self.above = self.above.map(|i| i + by);
        self
    }

    /// What the layers over it leave of f.
    #[inline]
    pub(super) fn dimmed(&self, o: &Transmitted, i: &Transmitted) -> f32 {
        let range = usize::from(self.above[0])..usize::from(self.above[1]);
        let (o, i) = (o[range.clone()].iter().product::<f32>(), i[range].iter().product::<f32>());
        if self.product { o * i } else { o.min(i) }
    }

    /// f \[1/sr\] and density \[1/sr\] of `wi` among the draws of this lobe; 0 for deltas.
    ///
    /// In a frame with a normal n' of its own, f is the lobe's times min(ρ(o), ρ(i)), ρ(w) = |w·n'|/|w·n|: reciprocal,
    /// and as f |i·n| ≤ f_lobe |i·n'| no more is scattered than by the lobe under its own normal. Where either
    /// direction lies on the other side of n' than of n, nothing is.
    #[inline]
    pub(super) fn eval(&self, wo: Vec3, wi: Vec3, mode: Transport) -> (Spectrum, f32) {
        let Some(frame) = &self.frame else { return self.lobe.eval(wo, wi, mode) };
        let (o, i) = (frame.to_local(wo), frame.to_local(wi));
        let (rho_o, rho_i) = (o.z / wo.z, i.z / wi.z);
        if !(rho_o > 0.0 && rho_i > 0.0) {
            return (Spectrum::ZERO, 0.0);
        }
        let (f, pdf) = self.lobe.eval(o, i, mode);
        (f * rho_o.min(rho_i), pdf)
    }

    /// Draws `wi` and says which η it crossed; not for deltas.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2]) -> Option<(Vec3, f32)> {
        let Some(frame) = &self.frame else { return self.lobe.sample(wo, uc, u) };
        let o = frame.to_local(wo);
        if o.z * wo.z <= 0.0 {
            return None;
        }
        let (i, eta) = self.lobe.sample(o, uc, u)?;
        let wi = Vec3::from(frame.to_world(i)).normalize();
        (i.z * wi.z > 0.0).then_some((wi, eta))
    }

    /// The directions of a delta lobe, before layers.
    #[inline]
    pub(super) fn deltas(&self, wo: Vec3, mode: Transport) -> [Option<Delta>; 2] {
        let Some(frame) = &self.frame else { return self.lobe.deltas(wo, mode) };
        let o = frame.to_local(wo);
        let rho_o = o.z / wo.z;
        if rho_o.is_nan() || rho_o <= 0.0 {
            return [None, None];
        }
        self.lobe.deltas(o, mode).map(|delta| {
            let d = delta?;
            let wi = Vec3::from(frame.to_world(d.wi)).normalize();
            let rho_i = d.wi.z / wi.z;
            // f |i·n| is the lobe's f |i·n'| times min(ρ(o), ρ(i))/ρ(i).
            (rho_i > 0.0).then(|| Delta { wi, weight: d.weight * (rho_o / rho_i).min(1.0), ..d })
        })
    }

    /// Directional albedo towards `wo`: exact where the lobe is in the shading frame and beneath no layers, or beneath
    /// layers and diffuse; else a bound.
    pub(super) fn albedo(&self, wo: Vec3, t: &Transmitted) -> Spectrum {
        let range = usize::from(self.above[0])..usize::from(self.above[1]);
        let t = self.scale * t[range].iter().product::<f32>();
        match &self.frame {
            None => self.lobe.albedo(wo) * t,
            Some(frame) => {
                let o = frame.to_local(wo);
                if o.z * wo.z > 0.0 { self.lobe.albedo(o) * t } else { Spectrum::ZERO }
            }
        }
    }
}
