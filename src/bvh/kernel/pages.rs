//! Memory for large arrays that are read at random.

/// From this size \[bytes\] on huge pages are worth asking for.
const HUGE: usize = 1 << 22;

/// An empty vector for `n` items, on huge pages where the system grants them on request: an incoherent ray looks at memory
/// in dozens of places, and with pages of 4 KiB most of them miss the translation cache (up to a quarter of the time of a
/// traversal).
pub(in crate::bvh) fn with_capacity<T>(n: usize) -> Vec<T> {
    let mut vec = Vec::with_capacity(n);
    if n * size_of::<T>() >= HUGE {
        advise(vec.spare_capacity_mut());
    }
    vec
}

/// Asks for huge pages, before the memory is first touched.
#[cfg(target_os = "linux")]
fn advise<T>(memory: &mut [std::mem::MaybeUninit<T>]) {
    const PAGE: usize = 4096;
    let range = memory.as_mut_ptr_range();
    let (start, end) = (range.start.addr().next_multiple_of(PAGE), range.end.addr() & !(PAGE - 1));
    if start < end {
        // SAFETY: the whole pages between lie inside an allocation of ours, and the advice changes no content. Refusal is
        // no error: then pages are small.
        unsafe { libc::madvise(range.start.with_addr(start).cast(), end - start, libc::MADV_HUGEPAGE) };
    }
}

#[cfg(not(target_os = "linux"))]
fn advise<T>(_memory: &mut [std::mem::MaybeUninit<T>]) {}
