//! Hashes of integers.

/// A permutation of 64 bits in which every input bit flips every output bit with probability near one half (Stafford
/// 2011, "Better Bit Mixing", variant 13; the finaliser of SplitMix64, Steele, Lea & Flood 2014).
#[inline]
pub const fn mix(x: u64) -> u64 {
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Odd number nearest to 2⁶⁴/φ: successive multiples are far from each other.
pub(super) const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Hash of a sequence of words.
#[inline]
pub fn hash(words: &[u64]) -> u64 {
    words.iter().fold(GOLDEN, |h, &word| mix((h ^ word).wrapping_add(GOLDEN)))
}

/// Hash of what a pixel's numbers depend on.
#[inline]
pub(super) fn pixel_hash(seed: u64, pixel: [u32; 2], index: u64) -> u64 {
    hash(&[seed, (pixel[1] as u64) << 32 | pixel[0] as u64, index])
}

/// Key of branch `branch` of the numbers that `key` gives: apart from the keys of all dimensions, `key` plus multiples of
/// [`GOLDEN`], as it is hashed twice.
#[inline]
pub(super) fn fork_key(key: u64, branch: u32) -> u64 {
    mix(mix(!key).wrapping_add(u64::from(branch).wrapping_mul(GOLDEN)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::Family;

    #[test]
    fn every_input_bit_flips_every_output_bit_half_the_time() {
        let (mut family, n) = (Family::new("avalanche of hash"), 4000);
        let se = 0.5 / (n as f64).sqrt();
        for bit in 0..64 {
            let mut flips = [0u32; 64];
            for k in 0..n {
                // Each pair once: the bit is 0 in k and 1 in its partner.
                let k = ((k >> bit) << bit) + k;
                let change = hash(&[k, 1]) ^ hash(&[k ^ (1 << bit), 1]);
                (0..64).for_each(|o| flips[o] += (change >> o & 1) as u32);
            }
            for (o, &count) in flips.iter().enumerate() {
                family.estimate(format!("{bit} → {o}"), 0.5, count as f64 / n as f64, se);
            }
        }
        assert!(family.passes(), "{:?}", family.failures().collect::<Vec<_>>());
    }
}
