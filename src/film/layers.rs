//! The layers of a film: where their sums are, and which values they take.

use super::layer::{CLASSES, GROUPS, Kind, Layer, TRANSPORT};
use super::sample::SampleSums;
use std::sync::Arc;

/// A value of a sample that is not finite, or negative where nothing is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Invalid {
    /// The layer that it was meant for.
    pub layer: &'static str,
    /// What came.
    pub value: [f32; 3],
}

/// The layers of a film, and their places in a pixel's sums.
#[derive(Clone, Debug)]
pub struct Layers {
    pub(super) slots: Arc<[Slot]>,
    /// Sums of a pixel.
    pub(super) sums: usize,
    /// Sums of squares of a pixel.
    pub(super) squares: usize,
    /// The least that a sample may give to each sum.
    pub(super) least: Arc<[f32]>,
    /// Whether one of them is a transport class.
    pub(super) split: bool,
}

/// Place of one layer.
#[derive(Debug, PartialEq)]
pub(super) struct Slot {
    pub(super) layer: &'static Layer,
    /// Its first sum.
    pub(super) sum: usize,
    /// Its first sum of squares, of an estimate.
    pub(super) square: Option<usize>,
}

impl Slot {
    /// Its sums.
    pub(super) fn range(&self) -> std::ops::Range<usize> {
        self.sum..self.sum + self.layer.channels.len()
    }
}

impl PartialEq for Layers {
    fn eq(&self, other: &Self) -> bool {
        self.slots == other.slots
    }
}

impl Layers {
    /// These layers, each at most once.
    pub fn new(layers: impl IntoIterator<Item = &'static Layer>) -> Self {
        let (mut slots, mut sums, mut squares, mut least) = (Vec::<Slot>::new(), 0, 0, Vec::new());
        for layer in layers {
            let estimate = layer.kind == Kind::Estimate;
            slots.push(Slot { layer, sum: sums, square: estimate.then_some(squares) });
            // Samples are counted for all layers together.
            sums += if layer.kind == Kind::Count { 0 } else { layer.channels.len() };
            least.resize(sums, if layer.signed { f32::MIN } else { 0.0 });
            squares += if estimate { layer.channels.len() } else { 0 };
        }
        let split = slots.iter().any(|slot| CLASSES.contains(&slot.layer.name));
        Self { slots: slots.into(), sums, squares, least: least.into(), split }
    }

    /// What films keep: the layers that all of them do, and transport classes where they are asked for.
    pub fn held(transport: bool) -> Self {
        let groups = GROUPS.iter().filter(|group| group.always || transport && group.name == TRANSPORT);
        Self::new(groups.flat_map(|group| group.layers))
    }

    /// The layers, in the order of their sums.
    pub fn iter(&self) -> impl Iterator<Item = &'static Layer> {
        self.slots.iter().map(|slot| slot.layer)
    }

    /// The place of the layer of this name.
    pub(super) fn slot(&self, name: &str) -> Option<&Slot> {
        self.slots.iter().find(|slot| slot.layer.name == name)
    }

    /// The sums of a pixel: what the layers keep of those of its samples.
    pub(super) fn of(&self, samples: &SampleSums) -> Vec<f64> {
        let mut sums = vec![0.0; self.sums];
        self.add(samples, &mut sums);
        sums
    }

    /// Adds to the sums of a pixel what the layers keep of those of some samples.
    pub(super) fn add(&self, samples: &SampleSums, sums: &mut [f64]) {
        for slot in self.slots.iter().filter(|slot| slot.layer.kind != Kind::Count) {
            sums[slot.range()].iter_mut().zip((slot.layer.of)(samples)).for_each(|(sum, x)| *sum += x);
        }
    }

    /// Sets to 0 what is invalid in the values of a sample, and after an invalid estimate all estimates, and returns the first.
    #[cold]
    pub(super) fn clear(&self, values: &mut [f64]) -> Option<Invalid> {
        let mut first: Option<Invalid> = None;
        let mut lost = false;
        for slot in self.slots.iter().filter(|slot| slot.layer.kind != Kind::Count) {
            let (estimate, least) = (slot.layer.kind == Kind::Estimate, &self.least[slot.range()]);
            let values = &mut values[slot.range()];
            let valid =
                values.iter().zip(least).all(|(x, least)| (f64::from(*least)..=f64::from(f32::MAX)).contains(x));
            if !valid {
                let value = std::array::from_fn(|c| values.get(c).map_or(0.0, |x| *x as f32));
                first = first.or(Some(Invalid { layer: slot.layer.name, value }));
                lost |= estimate;
            }
            if !valid || estimate && lost {
                values.fill(0.0);
            }
        }
        first
    }

    /// The estimates, and the places of their first squares.
    pub(super) fn estimates(&self) -> impl Iterator<Item = (&Slot, usize)> {
        self.slots.iter().filter_map(|slot| Some((slot, slot.square?)))
    }
}
