//! The stack of a traversal: fixed size, not cleared, no heap.

use crate::bvh::node::STACK;
use std::mem::MaybeUninit;

const _: () = assert!(STACK.is_power_of_two());

/// A child to visit and the distance at which the ray enters it, in one number: distances are not negative, so that their
/// bits are in their order, and so are entries.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::bvh) struct Entry(u64);

impl Entry {
    /// `near` ≥ 0.
    #[inline(always)]
    pub(in crate::bvh) fn new(near: f32, child: u32) -> Self {
        Self(u64::from(near.to_bits()) << 32 | u64::from(child))
    }

    /// Where the ray enters it.
    #[inline(always)]
    pub(in crate::bvh) fn near(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    /// Which child.
    #[inline(always)]
    pub(in crate::bvh) fn child(self) -> u32 {
        self.0 as u32
    }
}

/// Children to visit. How many are held is the caller's to keep, as a variable of its own: beside entries that are written
/// at any index it would not stay in a register.
pub(in crate::bvh) struct Stack([MaybeUninit<Entry>; STACK]);

impl Stack {
    /// Holds nothing.
    #[inline(always)]
    pub(in crate::bvh) fn new() -> Self {
        Self([const { MaybeUninit::uninit() }; STACK])
    }

    /// Adds on top.
    #[inline(always)]
    pub(in crate::bvh) fn push(&mut self, size: &mut usize, entry: Entry) {
        self.set(*size, entry);
        *size += 1;
    }

    /// Adds to the entries from `first` on, which are sorted with the nearest on top, and keeps them so.
    #[inline(always)]
    pub(in crate::bvh) fn insert(&mut self, first: usize, size: &mut usize, entry: Entry) {
        let mut i = *size;
        while i > first {
            let below = self.get(i - 1);
            if below >= entry {
                break;
            }
            self.set(i, below);
            i -= 1;
        }
        self.set(i, entry);
        *size += 1;
    }

    /// Takes from the top.
    #[inline(always)]
    pub(in crate::bvh) fn pop(&self, size: &mut usize) -> Option<Entry> {
        *size = size.checked_sub(1)?;
        Some(self.get(*size))
    }

    /// Trees that could need more than [`STACK`] entries are rebuilt: the remainder is the index.
    #[inline(always)]
    fn set(&mut self, i: usize, entry: Entry) {
        self.0[i % STACK].write(entry);
    }

    #[inline(always)]
    fn get(&self, i: usize) -> Entry {
        // SAFETY: entries below the size were written by `push` or `insert`; callers ask for those, or for the one that
        // `pop` has just taken.
        unsafe { self.0[i % STACK].assume_init() }
    }
}
