//! Eight f32 lanes in a register of x86-64, for the instruction sets that have them.

/// `Lanes` for these CPU features; `mask::<PREDICATE>(a, b)`, in scope, compares lane by lane.
macro_rules! lanes {
    ($features:literal) => {
        /// Eight f32 lanes in a register.
        #[derive(Clone, Copy)]
        struct Lanes(__m256);

        /// Asks for the cache lines of what is at `at`, if anything is.
        #[inline]
        #[target_feature(enable = $features)]
        fn prefetch<T>(at: *const T) {
            for line in 0..size_of::<T>().div_ceil(64) {
                _mm_prefetch::<_MM_HINT_T0>(at.cast::<i8>().wrapping_add(64 * line));
            }
        }

        impl Lanes {
            #[inline]
            #[target_feature(enable = $features)]
            fn splat(x: f32) -> Self {
                Self(_mm256_set1_ps(x))
            }

            #[inline]
            #[target_feature(enable = $features)]
            fn load(from: &[f32; 8]) -> Self {
                // SAFETY: the reference covers the 32 bytes that are read; the load asks for no alignment.
                Self(unsafe { _mm256_loadu_ps(from.as_ptr()) })
            }

            #[inline]
            #[target_feature(enable = $features)]
            fn to_array(self) -> [f32; 8] {
                let mut out = [0.0; 8];
                // SAFETY: the array covers the 32 bytes that are written; the store asks for no alignment.
                unsafe { _mm256_storeu_ps(out.as_mut_ptr(), self.0) };
                out
            }

            #[inline]
            #[target_feature(enable = $features)]
            fn abs(self) -> Self {
                Self(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0))
            }

            crate::bvh::kernel::register::lanewise! { $features;
                add: _mm256_add_ps;
                sub: _mm256_sub_ps;
                mul: _mm256_mul_ps;
                div: _mm256_div_ps;
                min: _mm256_min_ps;
                max: _mm256_max_ps;
            }

            crate::bvh::kernel::register::compare! { $features;
                lt: _CMP_LT_OQ;
                le: _CMP_LE_OQ;
                eq: _CMP_EQ_OQ;
            }
        }
    };
}

macro_rules! lanewise {
    ($features:literal; $($name:ident: $intrinsic:ident;)*) => {$(
        #[inline]
        #[target_feature(enable = $features)]
        fn $name(self, other: Self) -> Self {
            Self($intrinsic(self.0, other.0))
        }
    )*};
}

// Bit i: the comparison holds in lane i.
macro_rules! compare {
    ($features:literal; $($name:ident: $predicate:ident;)*) => {$(
        #[inline]
        #[target_feature(enable = $features)]
        fn $name(self, other: Self) -> u32 {
            mask::<$predicate>(self.0, other.0)
        }
    )*};
}

pub(super) use {compare, lanes, lanewise};
