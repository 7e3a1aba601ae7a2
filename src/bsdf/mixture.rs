//! A BSDF: the sum of its lobes, beneath their layers.

use super::entry::{Entry, Layers, MAX_LAYERS, transmitted};
use super::{Ggx, Layer, Lobe, Pdf, Sample, Transport};
use crate::math::Frame;
use crate::spectrum::Spectrum;
use arrayvec::ArrayVec;
use glam::Vec3;

/// Most lobes of one BSDF.
pub const MAX_LOBES: usize = 16;

/// One reflection, one straight line, and a refraction for each lobe.
pub const MOST_DELTAS: usize = MAX_LOBES + 2;

/// f = Σ scale · f_lobe, drawn from by choosing a lobe.
///
/// It is bound to no direction: [`Bsdf::towards`] looks up what draws from one direction need, and values for any pair are
/// those of either end.
///
/// Non-delta lobes form one density: whichever is chosen, a draw returns Σ f |cos θ| / Σ p·pdf, so that a lobe that is
/// bad at a direction is helped by one that is good at it. Delta lobes stand apart, each with its probability. Each is
/// chosen in proportion to about the energy that it scatters of light from the direction.
///
/// A lobe may have a frame of its own, and lie beneath [`Layer`]s that dim it; f is then as `layer` says.
#[derive(Clone, Debug, Default)]
pub struct Bsdf {
    pub(super) entries: ArrayVec<Entry, MAX_LOBES>,
    pub(super) layers: Layers,
    /// Albedo of the only lobe where it is Lambert's: most surfaces of most scenes, and worth a way of its own.
    pub(super) lambert: Option<Spectrum>,
    /// Some lobe is no delta; some other than a delta lets light through.
    smooth: bool,
    pub(super) transmits: bool,
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
        (self.lambert, self.smooth, self.transmits) = (None, false, false);
    }

    /// One lobe.
    #[inline]
    pub fn single(lobe: Lobe) -> Self {
        let mut bsdf = Self::new();
        bsdf.push(lobe, 1.0);
        bsdf
    }

    /// Adds `scale` times a lobe. False where there is no room left, or nothing to add: a lobe of scale 0.
    #[inline]
    pub fn push(&mut self, lobe: Lobe, scale: f32) -> bool {
        self.push_in(None, lobe, scale)
    }

    /// Adds `scale` times a lobe in a frame of its own, given in the shading frame.
    #[inline]
    pub fn push_in(&mut self, frame: Option<&Frame>, lobe: Lobe, scale: f32) -> bool {
        if scale.is_nan() || scale <= 0.0 || self.entries.is_full() {
            return false;
        }
        self.entries.push(Entry::new(lobe, frame, scale, self.entries.last()));
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

    /// Number of lobes.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Puts a layer over all lobes but the first `from`. What the layer itself reflects is a lobe to be added afterwards.
    /// False where there is no room for a further layer.
    pub fn cover(&mut self, from: usize, layer: Layer) -> bool {
        if self.layers.try_push(layer).is_err() {
            return false;
        }
        for entry in &mut self.entries[from..] {
            entry.cover(&self.layers);
        }
        self.lambert = None;
        true
    }

    /// Adds `scale` times the lobes of another BSDF with their layers. False, and nothing is added, where they find no room.
    pub fn add(&mut self, other: &Self, scale: f32) -> bool {
        let by = self.layers.len();
        if by + other.layers.len() > MAX_LAYERS || self.entries.len() + other.entries.len() > MAX_LOBES {
            return false;
        }
        for entry in &other.entries {
            let entry = entry.moved(scale, by as u8);
            if entry.scale > 0.0 {
                self.entries.push(entry);
                self.note_last();
            }
        }
        self.layers.extend(other.layers.iter().copied());
        true
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

    /// Every delta direction with its f |cos θ|, for branching: the weight is divided by no probability, and the pdf
    /// is `Discrete(1)`. Lobes that agree in direction are one.
    pub fn deltas(&self, wo: Vec3, mode: Transport) -> ArrayVec<Sample, MOST_DELTAS> {
        let mut samples: ArrayVec<Sample, MOST_DELTAS> = ArrayVec::new();
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
                    // One reflection, one straight line and a refraction for each lobe.
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
            match &e.lobe {
                Lobe::ThinTransmission(l) if !e.turned => {
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
        self.entries.iter().any(|e| e.turned || e.lobe.is_anisotropic())
    }

    /// Some lobe is a hundred times as long as it is wide, or more, and hardly wider than a mirror's: as a function it can be
    /// evaluated, but no quadrature over directions resolves it.
    pub fn has_needle(&self) -> bool {
        self.entries.iter().any(|e| match &e.lobe {
            Lobe::RoughReflection(l) => {
                let Ggx { ax, ay } = l.micro().surface();
                ax.min(ay) < 1e-3 && ax.max(ay) > 100.0 * ax.min(ay)
            }
            _ => false,
        })
    }

    /// Directional albedo, reflection and transmission together.
    pub fn albedo(&self, wo: Vec3) -> Spectrum {
        if let Some(albedo) = self.lambert {
            return albedo;
        }
        let t = transmitted(&self.layers, wo);
        self.entries.iter().map(|e| e.albedo(wo, &self.layers, &t)).sum()
    }

    /// What layers leave of f between two directions.
    pub(super) fn dimmed(&self, entry: &Entry, wo: Vec3, wi: Vec3) -> f32 {
        if self.layers.is_empty() {
            return 1.0;
        }
        entry.dimmed(&transmitted(&self.layers, wo), &transmitted(&self.layers, wi))
    }
}
