//! Owen-scrambled Sobol points by hashing (Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4)).
//!
//! Each dimension, or pair of dimensions, is the first one or two of Sobol's dimensions under its own Owen scrambling,
//! visited in its own nested-uniformly shuffled order. A pair is thus a (0,2)-sequence; different pairs are
//! independent. Everything is computed from the index, so there is no table and no largest index or dimension.

use super::hash::{GOLDEN, fork_key, mix, pixel_hash};
use super::{unit, unit_24};

/// Numbers of one sample.
#[derive(Clone, Copy, Debug)]
pub struct Sobol {
    /// Index within the replicate, bits reversed, after the part of its hash that needs no seed.
    reversed_index: u32,
    /// Whether replicates are so small that bytes hold the index.
    small: bool,
    dimension: u32,
    /// Hash of the seed, the pixel and the replicate.
    key: u64,
}

impl Sobol {
    /// At dimension 0 of sample `index`, which is point `index % replicate` of replicate `index / replicate`.
    /// `replicate` is a power of two (others are rounded up to one).
    #[inline]
    pub fn new(seed: u64, pixel: [u32; 2], index: u64, replicate: u32) -> Self {
        let size = (replicate.max(1) as u64).next_power_of_two();
        let within = (index & (size - 1)) as u32;
        let key = pixel_hash(seed, pixel, index >> size.trailing_zeros());
        Self { reversed_index: owen_start(within.reverse_bits()), small: size <= 256, dimension: 0, key }
    }

    /// This sample's point of an independent randomisation, at dimension 0; another randomisation for every `branch`.
    #[inline]
    pub fn fork(&self, branch: u32) -> Self {
        Self { dimension: 0, key: fork_key(self.key, branch), ..*self }
    }

    /// The number at this dimension; goes on to the next.
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        let [shuffle, x, _] = self.seeds();
        self.dimension = self.dimension.wrapping_add(1);
        let a = owen_end(self.reversed_index, shuffle);
        if self.small {
            short_fraction(owen_end(STARTS[(a >> 24) as usize][0], x))
        } else {
            unit(owen(a.reverse_bits(), x).reverse_bits())
        }
    }

    /// The pair at this dimension and the next; goes on by two.
    #[inline]
    pub fn next_2d(&mut self) -> [f32; 2] {
        let [shuffle, x, y] = self.seeds();
        self.dimension = self.dimension.wrapping_add(2);
        let a = owen_end(self.reversed_index, shuffle);
        if self.small {
            let [first, second] = STARTS[(a >> 24) as usize];
            [short_fraction(owen_end(first, x)), short_fraction(owen_end(second, y))]
        } else {
            // Both reversals at once: reversing 64 bits also swaps the halves.
            let j = a.reverse_bits();
            let both = ((owen(pascal(j), y) as u64) << 32 | owen(j, x) as u64).reverse_bits();
            [unit((both >> 32) as u32), unit(both as u32)]
        }
    }

    /// Goes to `dimension`.
    #[inline]
    pub fn skip_to(&mut self, dimension: u32) {
        self.dimension = dimension;
    }

    /// The dimension that comes next.
    #[inline]
    pub fn dimension(&self) -> u32 {
        self.dimension
    }

    /// Seeds of the shuffling and of the two scramblings at this dimension.
    #[inline]
    fn seeds(&self) -> [u32; 3] {
        let h = mix(self.key.wrapping_add((self.dimension as u64).wrapping_mul(GOLDEN)));
        [h as u32, (h >> 32) as u32, (h.wrapping_mul(GOLDEN) >> 32) as u32]
    }
}

/// Of each byte of reversed index: the first two dimensions of Sobol's sequence, bits reversed, after the part of their
/// hash that needs no seed.
static STARTS: [[u32; 2]; 256] = {
    let mut table = [[0; 2]; 256];
    let mut i = 0;
    while i < 256 {
        let j = (i as u8).reverse_bits() as u32;
        table[i] = [owen_start(j), owen_start(pascal(j))];
        i += 1;
    }
    table
};

/// Each byte with its bits reversed.
static REVERSED: [u8; 256] = {
    let mut table = [0; 256];
    let mut i = 0;
    while i < 256 {
        table[i] = (i as u8).reverse_bits();
        i += 1;
    }
    table
};

/// Fraction of 24 bits from a reversed one in which only the low 8 bits tell points apart: these are reversed; all
/// others are independent random bits, of which the most hashed are taken as they are.
#[inline]
fn short_fraction(reversed: u32) -> f32 {
    let upper = REVERSED[(reversed & 0xff) as usize] as u32;
    unit_24(upper << 16 | reversed >> 16)
}

/// Point `index` of the first two dimensions of Sobol's sequence, as 32-bit fractions, not scrambled.
pub fn sobol_2d(index: u32) -> [u32; 2] {
    [index.reverse_bits(), pascal(index).reverse_bits()]
}

/// Owen scrambling (nested uniform scrambling) of a 32-bit fraction: a random permutation of the binary tree of
/// intervals, chosen by `seed`.
#[inline]
pub fn owen_scramble(x: u32, seed: u32) -> u32 {
    owen(x.reverse_bits(), seed).reverse_bits()
}

/// Owen scrambling of a fraction whose bits are reversed: a hash in which bits act only on higher ones (Laine & Karras
/// 2011, "Stratified Sampling for Stochastic Transparency", with the constants of N. Vegdahl, "Building a Better LK
/// Hash", 2021).
#[inline]
fn owen(x: u32, seed: u32) -> u32 {
    owen_end(owen_start(x), seed)
}

/// The part of [`owen`] before the seed.
#[inline]
pub(super) const fn owen_start(x: u32) -> u32 {
    x ^ x.wrapping_mul(0x3d20_adea)
}

/// The part of [`owen`] from the seed on.
#[inline]
pub(super) fn owen_end(x: u32, seed: u32) -> u32 {
    let x = x.wrapping_add(seed).wrapping_mul((seed >> 16) | 1);
    let x = x ^ x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// Sobol's second dimension with its bits reversed. Its generator matrix is Pascal's triangle modulo 2, the map
/// p(t) → p(t + 1) of polynomials over GF(2) whose coefficients are the bits of `x`. As (t + 1)^(2^k) = t^(2^k) + 1
/// there, the upper half of each block of 2^(k+1) coefficients is added to the lower, for every k.
#[inline]
const fn pascal(mut x: u32) -> u32 {
    x ^= x >> 16;
    x ^= (x & 0xff00_ff00) >> 8;
    x ^= (x & 0xf0f0_f0f0) >> 4;
    x ^= (x & 0xcccc_cccc) >> 2;
    x ^ (x & 0xaaaa_aaaa) >> 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closed_form_is_sobol_s_second_dimension() {
        // Direction numbers of the primitive polynomial t + 1: v₀ = 2³¹, vₖ₊₁ = vₖ ⊕ vₖ/2 (Sobol 1967).
        let direct = |mut index: u32| {
            let (mut v, mut y) = (1u32 << 31, 0);
            while index != 0 {
                y ^= if index & 1 == 1 { v } else { 0 };
                v ^= v >> 1;
                index >>= 1;
            }
            y
        };
        for k in 0..2000u32 {
            let index = k.wrapping_mul(0x9e37_79b9);
            assert_eq!(sobol_2d(index), [index.reverse_bits(), direct(index)]);
        }
    }

    #[test]
    fn scrambling_permutes_every_level_of_the_tree() {
        for seed in 0..50 {
            let seed = mix(seed) as u32;
            for bits in 1..10 {
                // Which interval of 2^−bits a fraction comes to depends on the interval it came from alone.
                let shift = 32 - bits;
                let image: Vec<u32> = (0..1 << bits).map(|i: u32| owen_scramble(i << shift, seed) >> shift).collect();
                for i in 0..1u32 << bits {
                    let elsewhere = (i << shift) | (mix(i as u64) as u32 >> bits);
                    assert_eq!(owen_scramble(elsewhere, seed) >> shift, image[i as usize]);
                }
                let mut sorted = image;
                sorted.sort_unstable();
                assert!(sorted.iter().enumerate().all(|(i, &x)| i as u32 == x));
            }
        }
    }
}
