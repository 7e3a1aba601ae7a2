//! The kernels for AVX-512 with vectors of 256 bits: comparisons make masks at once, and there are registers for all that a
//! leaf needs.

use std::arch::x86_64::*;

/// Bit i: the comparison holds in lane i.
#[inline]
#[target_feature(enable = "avx512f,avx512vl")]
fn mask<const PREDICATE: i32>(a: __m256, b: __m256) -> u32 {
    _mm256_cmp_ps_mask::<PREDICATE>(a, b).into()
}

super::register::lanes!("avx512f,avx512vl");
super::traverse::kernels!(#[target_feature(enable = "avx512f,avx512vl")]);
