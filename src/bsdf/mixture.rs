//! A BSDF: the sum of its lobes, and one choice among them.

use super::energy::Slice;
use super::entry::{Entry, Layers, MAX_LAYERS, Transmitted, transmitted};
use super::lambert::sample_cosine;
use super::{Class, Eval, Ggx, Layer, Lobe, Pdf, Sample, Transport};
use crate::math::Frame;
use crate::spectrum::Spectrum;
use arrayvec::ArrayVec;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// Most lobes of one BSDF.
pub const MAX_LOBES: usize = 8;

/// f = Σ scale · f_lobe, drawn from by choosing a lobe.
///
/// Non-delta lobes form one density: whichever is chosen, `sample` returns Σ f |cos θ| / Σ p·pdf, so that a lobe that is
/// bad at a direction is helped by one that is good at it. Delta lobes stand apart, each with its probability.
///
/// A lobe may have a frame of its own, and lie beneath [`Layer`]s that dim it; f is then as `layer` says.
#[derive(Clone, Debug, Default)]
pub struct Bsdf {
    entries: ArrayVec<Entry, MAX_LOBES>,
    layers: Layers,
    /// Σ weight.
    total: f32,
    /// Albedo of the only lobe where it is Lambert's: most surfaces of most scenes, and worth a way of its own.
    lambert: Option<Spectrum>,
    /// Some lobe is no delta; some other than a delta lets light through.
    smooth: bool,
    transmits: bool,
    /// Energies of the direction that it is looked at from, last found.
    known: Option<Slice>,
}

/// A weight that is never missed.
#[inline]
fn heavier(weight: f32) -> f32 {
    if weight > 1e-4 { weight } else { 1e-4 }
}

impl Bsdf {
    /// Scatters nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// Forgets all lobes.
    #[inline]
    pub fn clear(&mut self) {
        self.entries.clear();
        self.layers.clear();
        self.total = 0.0;
        (self.lambert, self.smooth, self.transmits, self.known) = (None, false, false, None);
    }

    /// One lobe.
    #[inline]
    pub fn single(lobe: Lobe) -> Self {
        let mut bsdf = Self::new();
        bsdf.push(lobe, 1.0, 1.0);
        bsdf
    }

    /// Adds `scale` times a lobe, chosen in proportion to `weight`. False where there is no room left, or nothing to add:
    /// a lobe of scale 0. A lobe with scale but without weight gets a little, so that none is ever missed.
    #[inline]
    pub fn push(&mut self, lobe: Lobe, scale: f32, weight: f32) -> bool {
        self.push_entry(Entry::new(lobe, None, scale, weight))
    }

    /// The same with the lobe in a frame of its own, given in the shading frame.
    pub fn push_in(&mut self, frame: Frame, lobe: Lobe, scale: f32, weight: f32) -> bool {
        self.push_entry(Entry::new(lobe, Some(frame), scale, weight))
    }

    #[inline]
    fn push_entry(&mut self, entry: Entry) -> bool {
        let (scale, weight) = (entry.scale, entry.weight);
        if scale.is_nan() || scale <= 0.0 || self.entries.is_full() {
            return false;
        }
        let weight = heavier(weight);
        self.total += weight;
        self.entries.push(entry.weighing(weight));
        self.note_last();
        true
    }

    /// Notes what the last entry is.
    #[inline]
    fn note_last(&mut self) {
        let Some(entry) = self.entries.last() else { return };
        self.lambert = match &entry.lobe {
            Lobe::Lambert(l) if self.entries.len() == 1 && entry.is_plain() => Some(l.reflectance * entry.scale),
            _ => None,
        };
        self.smooth |= !entry.lobe.is_delta();
        self.transmits |= entry.lobe.transmits();
    }

    /// Adds `scale` times a lobe, chosen in proportion to about the energy that it scatters of light along `wo`, which is
    /// where the BSDF will be looked at from.
    pub fn push_by_albedo(&mut self, lobe: Lobe, scale: f32, wo: Vec3) -> bool {
        self.push_by_albedo_in(None, lobe, scale, wo)
    }

    /// The same with the lobe in a frame of its own, where there is one.
    pub fn push_by_albedo_in(&mut self, frame: Option<Frame>, lobe: Lobe, scale: f32, wo: Vec3) -> bool {
        if scale.is_nan() || scale <= 0.0 || self.entries.is_full() {
            return false;
        }
        // In its place first: lobes are large.
        self.entries.push(Entry::new(lobe, frame, scale, 0.0));
        let Some(entry) = self.entries.last_mut() else { return false };
        let wo = frame.map_or(wo, |frame| frame.to_local(wo));
        entry.lobe.look_from(wo, &mut self.known);
        let albedo = entry.lobe.importance(wo);
        entry.weight = heavier(scale * albedo.luminance().max(0.25 * albedo.max_element()));
        self.total += entry.weight;
        self.note_last();
        true
    }

    /// Number of lobes.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Puts a layer over all lobes but the first `from`; `wo` decides how often each is chosen. What the layer itself
    /// reflects is a lobe to be added afterwards. False where there is no room for a further layer.
    pub fn cover(&mut self, from: usize, layer: Layer, wo: Vec3) -> bool {
        if self.layers.try_push(layer).is_err() {
            return false;
        }
        for entry in &mut self.entries[from..] {
            entry.cover(&self.layers, wo);
        }
        self.lambert = None;
        self.total = self.entries.iter().map(|e| e.weight).sum();
        true
    }

    /// Adds `scale` times the lobes of another BSDF with their layers, chosen by what they scatter of light along `wo`.
    /// Lobes that find no room are left out.
    pub fn add(&mut self, other: &Self, scale: f32, wo: Vec3) {
        let by = self.layers.len() as u8;
        if self.layers.len() + other.layers.len() > MAX_LAYERS {
            return;
        }
        let t = transmitted(&other.layers, wo);
        for entry in &other.entries {
            let albedo = entry.albedo(wo, &t) * scale;
            let weight = albedo.luminance().max(0.25 * albedo.max_element());
            self.push_entry(entry.shifted(by).times(scale).weighing(weight));
        }
        self.layers.extend(other.layers.iter().copied());
    }

    /// Nothing scatters.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Some lobe is no delta: sampling lights makes sense.
    #[inline]
    pub fn has_smooth(&self) -> bool {
        self.smooth
    }

    /// Light can come from below, other than as a delta.
    #[inline]
    pub fn transmits(&self) -> bool {
        self.transmits
    }

    /// Probability that [`Self::sample`] chooses a delta lobe.
    #[inline]
    pub fn delta_probability(&self) -> f32 {
        self.entries.iter().filter(|e| e.lobe.is_delta()).map(|e| e.weight).sum::<f32>() / self.total.max(1e-30)
    }

    /// Chooses a direction: `uc` picks the lobe (and what it picks itself), `u` the direction. `None` where nothing
    /// scatters, where the draw failed (its share of the density is lost: it counts as 0), or at a grazing `wo`.
    #[inline(always)]
    pub fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2], mode: Transport) -> Option<Sample> {
        if wo.z == 0.0 {
            return None;
        }
        match self.lambert {
            Some(weight) => {
                let wi = sample_cosine(wo, u);
                let pdf = Pdf::SolidAngle(wi.z.abs() * FRAC_1_PI);
                (wi.z != 0.0).then_some(Sample { wi, weight, specular: Spectrum::ZERO, pdf, eta: 1.0 })
            }
            None => self.sample_mixture(wo, uc, u, mode),
        }
    }

    #[inline(never)]
    fn sample_mixture(&self, wo: Vec3, uc: f32, u: [f32; 2], mode: Transport) -> Option<Sample> {
        let (entry, uc) = self.choose(uc, self.total, |_| true)?;
        if entry.lobe.is_delta() {
            return self.draw_delta(entry, wo, uc, mode);
        }
        let (wi, eta) = entry.sample(wo, uc, u)?;
        let Eval { f, specular, pdf } = self.eval(wo, wi, mode);
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

    /// f and density of the non-delta lobes for a pair of directions.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3, mode: Transport) -> Eval {
        match self.lambert {
            Some(_) if wo.z * wi.z <= 0.0 => Eval::default(),
            Some(albedo) => {
                let pdf = wi.z.abs() * FRAC_1_PI;
                Eval { f: albedo * FRAC_1_PI, specular: Spectrum::ZERO, pdf }
            }
            None => self.eval_mixture(wo, wi, mode),
        }
    }

    #[inline(never)]
    fn eval_mixture(&self, wo: Vec3, wi: Vec3, mode: Transport) -> Eval {
        let mut eval = Eval::default();
        let layers = self.transmitted(wo).zip(self.transmitted(wi));
        for e in &self.entries {
            let (f, pdf) = e.eval(wo, wi, mode);
            let mut f = f * e.scale;
            if let Some((o, i)) = &layers {
                f *= e.dimmed(o, i);
            }
            eval.f += f;
            if e.lobe.class() == Class::Specular {
                eval.specular += f;
            }
            eval.pdf += pdf * e.weight;
        }
        eval.pdf /= self.total.max(1e-30);
        eval
    }

    /// Chooses among the delta lobes only; the probability is the one that [`Self::sample`] would have had.
    pub fn sample_delta(&self, wo: Vec3, uc: f32, mode: Transport) -> Option<Sample> {
        let sum = self.entries.iter().filter(|e| e.lobe.is_delta()).map(|e| e.weight).sum();
        let (entry, uc) = self.choose(uc, sum, |e| e.lobe.is_delta())?;
        if wo.z == 0.0 { None } else { self.draw_delta(entry, wo, uc, mode) }
    }

    /// Every delta direction with its f |cos θ|, for branching: the weight is divided by no probability, and the pdf
    /// is `Discrete(1)`. Lobes that agree in direction are one.
    pub fn deltas(&self, wo: Vec3, mode: Transport) -> ArrayVec<Sample, 10> {
        let mut samples: ArrayVec<Sample, 10> = ArrayVec::new();
        if wo.z == 0.0 {
            return samples;
        }
        for e in &self.entries {
            for d in e.deltas(wo, mode).into_iter().flatten() {
                let weight = d.weight * (e.scale * self.dimmed(e, wo, d.wi));
                if let Some(same) = samples.iter_mut().find(|s| s.wi == d.wi && s.eta == d.eta) {
                    same.weight += weight;
                    same.specular += weight;
                } else {
                    // One reflection, one straight line and a refraction for each of eight lobes: ten suffice.
                    let sample = Sample { wi: d.wi, weight, specular: weight, pdf: Pdf::Discrete(1.0), eta: d.eta };
                    let _ = samples.try_push(sample);
                }
            }
        }
        samples
    }

    /// Share of light that passes straight through thin sheets, where no other lobe sends a delta the same way: then the
    /// surface may be looked through without a choice. `None`: it may not.
    pub fn straight(&self, wo: Vec3) -> Option<Spectrum> {
        let mut sum = None;
        for e in &self.entries {
            match e.lobe {
                Lobe::ThinTransmission(l) if e.frame.is_none() => {
                    *sum.get_or_insert(Spectrum::ZERO) += l.albedo(wo) * (e.scale * self.dimmed(e, wo, -wo));
                }
                Lobe::ThinTransmission(_) | Lobe::SmoothDielectric(_) | Lobe::FilmedDielectric(_) => return None,
                _ => {}
            }
        }
        sum
    }

    /// Some lobe scatters otherwise where it is turned about the normal.
    pub fn is_anisotropic(&self) -> bool {
        self.entries.iter().any(|e| e.frame.is_some() || e.lobe.is_anisotropic())
    }

    /// Some lobe is a hundred times as long as it is wide, or more, and hardly wider than a mirror's: as a function it can be
    /// evaluated, but no quadrature over directions resolves it.
    pub fn has_needle(&self) -> bool {
        self.entries.iter().any(|e| match &e.lobe {
            Lobe::RoughReflection(l) => {
                let Ggx { ax, ay } = *l.micro().surface();
                ax.min(ay) < 1e-3 && ax.max(ay) > 100.0 * ax.min(ay)
            }
            _ => false,
        })
    }

    /// Directional albedo, reflection and transmission together.
    pub fn albedo(&self, wo: Vec3) -> Spectrum {
        let t = transmitted(&self.layers, wo);
        self.entries.iter().map(|e| e.albedo(wo, &t)).sum()
    }

    /// What each layer lets through towards `w`; `None` without layers.
    #[inline]
    fn transmitted(&self, w: Vec3) -> Option<Transmitted> {
        (!self.layers.is_empty()).then(|| transmitted(&self.layers, w))
    }

    /// What layers leave of f between two directions.
    fn dimmed(&self, entry: &Entry, wo: Vec3, wi: Vec3) -> f32 {
        match self.transmitted(wo).zip(self.transmitted(wi)) {
            Some((o, i)) => entry.dimmed(&o, &i),
            None => 1.0,
        }
    }

    /// The lobe at `uc` of those that `among` admits, whose weights sum to `sum`, and `uc` rescaled to [0, 1) in it.
    #[inline]
    fn choose(&self, uc: f32, sum: f32, among: impl Fn(&Entry) -> bool) -> Option<(&Entry, f32)> {
        if let [entry] = self.entries.as_slice() {
            return among(entry).then_some((entry, uc));
        }
        let mut rest = uc * sum;
        let mut last = None;
        for entry in self.entries.iter().filter(|e| among(e)) {
            if rest < entry.weight {
                return Some((entry, (rest / entry.weight).min(crate::warp::ONE_MINUS_EPSILON)));
            }
            rest -= entry.weight;
            last = Some(entry);
        }
        last.map(|entry| (entry, crate::warp::ONE_MINUS_EPSILON))
    }

    fn draw_delta(&self, entry: &Entry, wo: Vec3, uc: f32, mode: Transport) -> Option<Sample> {
        let chosen = entry.weight / self.total;
        let deltas = entry.deltas(wo, mode);
        let first = deltas[0].filter(|d| uc < d.probability);
        let d = first.or(deltas[1]).or(deltas[0])?;
        let scale = entry.scale * self.dimmed(entry, wo, d.wi);
        let weight = d.weight * (scale / (chosen * d.probability));
        Some(Sample { wi: d.wi, weight, specular: weight, pdf: Pdf::Discrete(chosen * d.probability), eta: d.eta })
    }
}
