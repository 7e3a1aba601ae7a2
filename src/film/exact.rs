//! Sums without rounding, which are the same in any order.

use std::sync::atomic::{AtomicU64, Ordering};

/// Words of a sum: f32 reaches from 2⁻¹⁴⁹ to 2¹²⁸, and 2⁴³ of the largest still fit.
const WORDS: usize = 5;

/// Exponent of the lowest bit.
const LOWEST: i32 = -149;

/// A sum of finite f32 ≥ 0 as one integer of 320 bits in units of 2⁻¹⁴⁹, the least positive f32 (Kulisch 2002): nothing is
/// rounded until it is read, so that the order of the summands, and which thread adds them, changes no bit. Threads add
/// without locks: each carry out of a word is added once to the next, and once all have come the words are those of the sum.
#[derive(Debug, Default)]
pub(super) struct ExactSum([AtomicU64; WORDS]);

impl ExactSum {
    /// Adds `x`, finite and not negative.
    #[inline]
    pub(super) fn add(&self, x: f32) {
        debug_assert!(x.is_finite() && x >= 0.0);
        // x = m 2^(shift − 149) with 24 bits m.
        let bits = x.to_bits() & 0x7fff_ffff;
        let exponent = bits >> 23;
        let m = u64::from(if exponent == 0 { bits } else { bits & 0x007f_ffff | 0x0080_0000 });
        let shift = exponent.max(1) - 1;
        let wide = u128::from(m) << (shift % 64);
        let parts = [wide as u64, (wide >> 64) as u64];
        // Carry until there is nothing more to add.
        let mut carry = 0;
        for (k, word) in self.0[(shift / 64) as usize..].iter().enumerate() {
            let part = parts.get(k).copied().unwrap_or(0) + carry;
            if part == 0 && k > 0 {
                break;
            }
            let before = word.fetch_add(part, Ordering::Relaxed);
            carry = u64::from(before.checked_add(part).is_none());
        }
    }

    /// The sum, rounded to the nearest f64, once all who add are known to have ended.
    pub(super) fn value(&self) -> f64 {
        let words = self.0.each_ref().map(|word| word.load(Ordering::Relaxed));
        let Some(top) = words.iter().rposition(|word| *word != 0) else { return 0.0 };
        if top == 0 {
            return words[0] as f64 * power_of_two(LOWEST);
        }
        // The 64 bits below and with the highest; where any bit below them is set, so is their last, which f64's 53 round away
        // in the right direction.
        let pair = u128::from(words[top]) << 64 | u128::from(words[top - 1]);
        let space = pair.leading_zeros();
        let high = (pair << space >> 64) as u64;
        let rest = (pair << space) as u64 != 0 || words[..top - 1].iter().any(|word| *word != 0);
        (high | u64::from(rest)) as f64 * power_of_two(LOWEST + 64 * top as i32 - space as i32)
    }
}

/// 2^k, of a normal f64.
fn power_of_two(k: i32) -> f64 {
    f64::from_bits(((1023 + k) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn single_numbers_come_back() {
        for x in [0.0, 1.0, 0.1, f32::from_bits(1), f32::from_bits(0x007f_ffff), f32::MIN_POSITIVE, 3e-20, f32::MAX] {
            let sum = ExactSum::default();
            sum.add(x);
            assert_eq!(sum.value(), f64::from(x), "{x}");
        }
        assert_eq!(ExactSum::default().value(), 0.0);
    }

    #[test]
    fn carries_cross_words() {
        // 2^128 − 1 units and one more.
        let sum = ExactSum::default();
        sum.0[0].store(u64::MAX, Ordering::Relaxed);
        sum.0[1].store(u64::MAX, Ordering::Relaxed);
        sum.add(f32::from_bits(1));
        assert_eq!(sum.value(), power_of_two(LOWEST + 128));
        let sum = ExactSum::default();
        (0..1000).for_each(|_| sum.add(f32::MAX));
        assert_eq!(sum.value(), 1000.0 * f64::from(f32::MAX));
    }

    #[test]
    fn what_is_small_is_not_lost_beside_what_is_large() {
        let sum = ExactSum::default();
        [1.0, 1e30, 2f32.powi(-100)].iter().for_each(|&x| sum.add(x));
        assert_eq!(sum.value(), f64::from(1e30f32));
        // 2^53 is even, so that half a unit more rounds down, and the least more than that up.
        let sum = ExactSum::default();
        [2f32.powi(53), 1.0].iter().for_each(|&x| sum.add(x));
        assert_eq!(sum.value(), 2f64.powi(53));
        sum.add(f32::from_bits(1));
        assert_eq!(sum.value(), 2f64.powi(53) + 2.0);
    }

    #[test]
    fn order_and_threads_change_no_bit() {
        let mut rng = Pcg64Mcg::seed_from_u64(5);
        let numbers: Vec<f32> =
            (0..40_000).map(|_| rng.random::<f32>() * 10f32.powi(rng.random_range(-30..30))).collect();
        let straight = ExactSum::default();
        numbers.iter().for_each(|&x| straight.add(x));
        let backwards = ExactSum::default();
        numbers.iter().rev().for_each(|&x| backwards.add(x));
        let together = ExactSum::default();
        std::thread::scope(|scope| {
            for part in numbers.chunks(10_000) {
                let together = &together;
                scope.spawn(move || part.iter().for_each(|&x| together.add(x)));
            }
        });
        assert_eq!(straight.value(), backwards.value());
        assert_eq!(straight.value(), together.value());
        // f64 alone is near, and depends on the order.
        let (up, down) = (
            numbers.iter().map(|&x| f64::from(x)).sum::<f64>(),
            numbers.iter().rev().map(|&x| f64::from(x)).sum::<f64>(),
        );
        assert!(up != down && (straight.value() / up - 1.0).abs() < 1e-12);
    }
}
