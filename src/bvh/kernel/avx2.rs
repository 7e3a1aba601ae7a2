//! The kernels for AVX2.

use std::arch::x86_64::*;

/// Bit i: the comparison holds in lane i.
#[inline]
#[target_feature(enable = "avx2")]
fn mask<const PREDICATE: i32>(a: __m256, b: __m256) -> u32 {
    _mm256_movemask_ps(_mm256_cmp_ps::<PREDICATE>(a, b)) as u32
}

super::register::lanes!("avx2");
super::traverse::kernels!(#[target_feature(enable = "avx2")]);
