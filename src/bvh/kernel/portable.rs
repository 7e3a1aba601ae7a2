//! The kernels for any target.

use super::lanes::Lanes;

/// There is no portable way to ask for memory.
#[inline]
fn prefetch<T>(_at: *const T) {}

super::traverse::kernels!();
