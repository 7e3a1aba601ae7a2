//! A lobe in its place: how much of it there is, in which frame, and beneath which layers.

use super::energy::Energy;
use super::layer::Layer;
use super::lobe::Aspect;
use super::smooth::Delta;
use super::{Coat, CoupledDiffuse, Lobe, Transport};
use crate::math::Frame;
use crate::spectrum::Spectrum;
use arrayvec::ArrayVec;
use glam::{Mat3, Quat, Vec3};

/// Most layers of one BSDF: four materials of a mixture with sheen and a coat each.
pub const MAX_LAYERS: usize = 8;

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

#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) lobe: Lobe,
    /// From the shading frame to the lobe's own, where it has one.
    turn: Quat,
    pub(super) turned: bool,
    /// It lets light in and out by the product of what both ways transmit, not by the smaller of the two.
    product: bool,
    /// Its microsurface and frame are those of the entry before, so that one look at the energies serves both.
    shares: bool,
    /// The layers over it: from, to.
    above: [u8; 2],
    /// Factor on f.
    pub(super) scale: f32,
}

const _: () = assert!(size_of::<Entry>() <= 128);

impl Entry {
    /// A lobe in the shading frame or in one of its own, after another.
    #[inline]
    pub(super) fn new(lobe: Lobe, frame: Option<&Frame>, scale: f32, before: Option<&Self>) -> Self {
        let turn = frame.map_or(Quat::IDENTITY, turn);
        let mut new = Self { lobe, turn, turned: frame.is_some(), product: false, shares: false, above: [0; 2], scale };
        new.shares = before.is_some_and(|before| new.looks_like(before));
        new
    }

    /// Its energies are those of the entry before.
    #[inline]
    fn looks_like(&self, before: &Self) -> bool {
        match (self.lobe.energy(), before.lobe.energy()) {
            (Some(a), Some(b)) => a.is(b) && self.turned == before.turned && self.turn == before.turn,
            _ => false,
        }
    }

    /// It has the shading frame and lies beneath nothing.
    #[inline]
    pub(super) fn is_plain(&self) -> bool {
        !self.turned && self.above[0] == self.above[1]
    }

    /// `w` in the lobe's frame.
    #[inline]
    pub(super) fn to_local(&self, w: Vec3) -> Vec3 {
        if self.turned { self.turn * w } else { w }
    }

    #[inline]
    fn to_shading(&self, w: Vec3) -> Vec3 {
        (self.turn.conjugate() * w).normalize()
    }

    /// Puts the last of the `layers` over it. Diffuse lobes are coupled to all over them anew.
    pub(super) fn cover(&mut self, layers: &Layers) {
        let last = layers.len() as u8;
        let before = self.above;
        if before[0] == before[1] {
            self.above = [last - 1, last];
        }
        self.above[1] = last;
        let diffuse = match &self.lobe {
            Lobe::Lambert(l) => CoupledDiffuse::new(l.reflectance, Coat::NONE),
            Lobe::CoupledDiffuse(l) => l.clone(),
            _ => return,
        };
        let range = |[from, to]: [u8; 2]| &layers[usize::from(from)..usize::from(to)];
        self.lobe = Lobe::CoupledDiffuse(diffuse.beneath(range(before), range(self.above)));
        self.product = true;
    }

    /// `scale` times as much of it, beneath as many layers that begin `by` later.
    pub(super) fn moved(&self, scale: f32, by: u8) -> Self {
        Self { scale: self.scale * scale, above: self.above.map(|i| i + by), ..self.clone() }
    }

    /// What is asked again and again of `w`, which is `local` in the lobe's frame, beneath layers that transmit `t`.
    /// `energy` is that of the entry before, and becomes this one's.
    #[inline]
    pub(super) fn aspect(&self, local: Vec3, t: &Transmitted, energy: &mut Energy) -> Aspect {
        if !self.shares
            && let Some(at) = self.lobe.energy()
        {
            *energy = at.at(local);
        }
        let mut aspect = self.lobe.aspect(local, *energy);
        // A weight that is never missed.
        let weight = aspect.weight * self.scale * self.through(t);
        aspect.weight = if weight > 1e-4 { weight } else { 1e-4 };
        aspect
    }

    /// T of all layers over it.
    #[inline]
    fn through(&self, t: &Transmitted) -> f32 {
        t[usize::from(self.above[0])..usize::from(self.above[1])].iter().product()
    }

    /// What the layers over it leave of f.
    #[inline]
    pub(super) fn dimmed(&self, o: &Transmitted, i: &Transmitted) -> f32 {
        if self.above[0] == self.above[1] {
            return 1.0;
        }
        let (o, i) = (self.through(o), self.through(i));
        if self.product { o * i } else { o.min(i) }
    }

    /// f \[1/sr\], and the densities \[1/sr\] among the draws of this lobe of `wi`, and seen from there of `wo`; 0 for deltas.
    /// Both are also given in the lobe's frame.
    ///
    /// In a frame with a normal n' of its own, f is the lobe's times min(ρ(o), ρ(i)), ρ(w) = |w·n'|/|w·n|: reciprocal,
    /// and as f |i·n| ≤ f_lobe |i·n'| no more is scattered than by the lobe under its own normal. Where either
    /// direction lies on the other side of n' than of n, nothing is.
    #[inline]
    pub(super) fn eval(
        &self,
        shading: [Vec3; 2],
        local: [Vec3; 2],
        aspects: [&Aspect; 2],
        mode: Transport,
    ) -> (Spectrum, f32, f32) {
        if !self.turned {
            return self.lobe.eval(local, aspects, mode);
        }
        let (rho_o, rho_i) = (local[0].z / shading[0].z, local[1].z / shading[1].z);
        if !(rho_o > 0.0 && rho_i > 0.0) {
            return (Spectrum::ZERO, 0.0, 0.0);
        }
        let (f, pdf, pdf_rev) = self.lobe.eval(local, aspects, mode);
        (f * rho_o.min(rho_i), pdf, pdf_rev)
    }

    /// Draws `wi` and says which η it crossed; not for deltas.
    #[inline]
    pub(super) fn sample(&self, wo: Vec3, aspect: &Aspect, uc: f32, u: [f32; 2]) -> Option<(Vec3, f32)> {
        if !self.turned {
            return self.lobe.sample(wo, aspect, uc, u);
        }
        let o = self.to_local(wo);
        if o.z * wo.z <= 0.0 {
            return None;
        }
        let (i, eta) = self.lobe.sample(o, aspect, uc, u)?;
        let wi = self.to_shading(i);
        (i.z * wi.z > 0.0).then_some((wi, eta))
    }

    /// The directions of a delta lobe, before layers.
    #[inline]
    pub(super) fn deltas(&self, wo: Vec3, mode: Transport) -> [Option<Delta>; 2] {
        if !self.turned {
            return self.lobe.deltas(wo, mode);
        }
        let o = self.to_local(wo);
        let rho_o = o.z / wo.z;
        if rho_o.is_nan() || rho_o <= 0.0 {
            return [None, None];
        }
        self.lobe.deltas(o, mode).map(|delta| {
            let d = delta?;
            let wi = self.to_shading(d.wi);
            let rho_i = d.wi.z / wi.z;
            // f |i·n| is the lobe's f |i·n'| times min(ρ(o), ρ(i))/ρ(i).
            (rho_i > 0.0).then(|| Delta { wi, weight: d.weight * (rho_o / rho_i).min(1.0), ..d })
        })
    }

    /// Directional albedo towards `wo`: exact where the lobe is in the shading frame and beneath no layers, or beneath
    /// layers and diffuse; else a bound.
    pub(super) fn albedo(&self, wo: Vec3, layers: &Layers, t: &Transmitted) -> Spectrum {
        let o = self.to_local(wo);
        if self.turned && o.z * wo.z <= 0.0 {
            return Spectrum::ZERO;
        }
        let above = if self.product { usize::from(self.above[0])..usize::from(self.above[1]) } else { 0..0 };
        self.lobe.albedo(o, &layers[above]) * (self.scale * self.through(t))
    }
}

/// The rotation into a frame.
fn turn(frame: &Frame) -> Quat {
    // Lobes are alike on both sides of their xz plane, so that the handedness of the frame is of no account.
    let (s, n) = (Vec3::from(frame.s), Vec3::from(frame.n));
    Quat::from_mat3(&Mat3::from_cols(s, n.cross(s), n)).normalize().conjugate()
}
