//! What is in the way of a shadow ray.

/// What a ray that only asks whether it arrives has met.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Obstacle {
    /// Nothing.
    None,
    /// Nothing but primitives that light may pass; which, and how much of it, is for others to find.
    Passable,
    /// A primitive that lets nothing pass.
    Opaque,
}

/// For which reasons light may pass a primitive, a bit each of [`PASSAGES`].
pub type Passages = u8;

/// Number of reasons that a leaf tells apart.
pub const PASSAGES: usize = 4;

/// The reasons that count for a ray: in a leaf a byte each, with a bit for every lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Passing(u32);

impl Passing {
    /// Everything is opaque.
    pub const NOTHING: Self = Self(0);

    /// Where one of these reasons holds.
    #[inline]
    pub fn of(reasons: [bool; PASSAGES]) -> Self {
        Self(u32::from_le_bytes(reasons.map(|counts| if counts { 0xff } else { 0 })))
    }

    /// Whether it passes a primitive.
    #[inline]
    pub fn passes(self, passages: Passages) -> bool {
        (0..PASSAGES).any(|i| passages >> i & 1 == 1 && self.0 >> (8 * i) & 1 == 1)
    }

    /// Lanes that it passes.
    #[inline]
    pub(super) fn lanes(self, leaf: LeafPassages) -> u32 {
        let found = leaf.0 & self.0;
        let found = found | found >> 16;
        (found | found >> 8) & 0xff
    }
}

/// The passages of up to eight primitives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct LeafPassages(u32);

impl LeafPassages {
    pub(super) fn put(&mut self, lane: usize, passages: Passages) {
        for i in (0..PASSAGES).filter(|i| passages >> i & 1 == 1) {
            self.0 |= 1 << (8 * i + lane % 8);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_pass_for_the_reasons_that_count() {
        let mut leaf = LeafPassages::default();
        leaf.put(0, 0b0001);
        leaf.put(3, 0b0110);
        leaf.put(7, 0b1000);
        let of = |reasons: [bool; 4]| Passing::of(reasons).lanes(leaf);
        assert_eq!(of([true, false, false, false]), 1);
        assert_eq!(of([false, true, false, false]), 1 << 3);
        assert_eq!(of([true, false, true, true]), 1 | 1 << 3 | 1 << 7);
        assert_eq!(Passing::NOTHING.lanes(leaf), 0);
        assert!(Passing::of([false, true, false, false]).passes(0b0110));
        assert!(!Passing::of([true, false, false, true]).passes(0b0110));
    }
}
