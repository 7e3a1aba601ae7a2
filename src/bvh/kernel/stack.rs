//! The stack of a traversal: fixed size, not cleared, no heap.

use crate::bvh::node::STACK;
use std::mem::MaybeUninit;

/// Children to visit, with the distance at which the ray enters them.
pub(in crate::bvh) struct Stack {
    items: [MaybeUninit<(f32, u32)>; STACK],
    size: usize,
}

impl Stack {
    /// Holds nothing.
    #[inline(always)]
    pub(in crate::bvh) fn new() -> Self {
        Self { items: [const { MaybeUninit::uninit() }; STACK], size: 0 }
    }

    /// Entries held.
    #[inline(always)]
    pub(in crate::bvh) fn len(&self) -> usize {
        self.size
    }

    /// Adds on top.
    #[inline(always)]
    pub(in crate::bvh) fn push(&mut self, item: (f32, u32)) {
        self.items[self.size].write(item);
        self.size += 1;
    }

    /// Adds to the entries from `first` on, which are sorted with the nearest on top, and keeps them so.
    #[inline(always)]
    pub(in crate::bvh) fn insert(&mut self, first: usize, item: (f32, u32)) {
        let mut i = self.size;
        while i > first {
            let below = self.get(i - 1);
            if below.0 >= item.0 {
                break;
            }
            self.items[i].write(below);
            i -= 1;
        }
        self.items[i].write(item);
        self.size += 1;
    }

    /// Takes from the top.
    #[inline(always)]
    pub(in crate::bvh) fn pop(&mut self) -> Option<(f32, u32)> {
        self.size = self.size.checked_sub(1)?;
        Some(self.get(self.size))
    }

    #[inline(always)]
    fn get(&self, i: usize) -> (f32, u32) {
        // SAFETY: entries below `size` were written by `push` or `insert`; callers ask for those, or for the one that
        // `pop` has just taken.
        unsafe { self.items[i].assume_init() }
    }
}
