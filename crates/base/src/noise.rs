//! An entity's own random numbers: a draw is a function of what it is for and when.
//!
//! Unlike a stream that is drawn from in turn, this gives the words of any look of any sensor at
//! once, so that what one sensor draws changes nothing for another, and skipping a look nothing for
//! the next. The generator is Philox4x32-10 (see [`crate::random`]), with a key for each entity.

use crate::random::{Entity, Purpose, stream};
use crate::trig::sin_cos;
use rand_philox::Philox;
use std::f64::consts::{LN_2, TAU};

/// 2^-32.
const WORD: f64 = 1.0 / 4_294_967_296.0;

/// The random numbers of one entity in one run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Noise {
    key: [u32; 2],
}

impl Noise {
    /// Those of an entity.
    #[must_use]
    pub fn of(seed: u64, run: u64, entity: Entity) -> Self {
        let mut stream = stream(seed, run, entity, Purpose::Noise);
        Self {
            key: [stream.next_u32(), stream.next_u32()],
        }
    }

    /// Four words for one use, at one time, for the `index`-th thing.
    #[must_use]
    #[inline]
    pub fn words(self, use_of: u32, time: u64, index: u32) -> [u32; 4] {
        let mut words = [0; 4];
        self.fill(use_of, time, index, &mut words);
        words
    }

    /// As many words as there is room for; they are those of the `index`-th thing and on.
    #[inline]
    pub fn fill(self, use_of: u32, time: u64, index: u32, words: &mut [u32]) {
        let counter = (u128::from(time) << 64) | (u128::from(use_of) << 32) | u128::from(index);
        Philox::new(self.key, counter).fill_u32(words);
    }
}

/// A number from 0 to 1, neither included.
#[must_use]
#[inline]
pub fn share(word: u32) -> f64 {
    (f64::from(word) + 0.5) * WORD
}

/// Two independent numbers of the standard normal distribution, at most 6.8 from 0.
///
/// Source: G. E. P. Box and M. E. Muller, *A note on the generation of random normal deviates*,
/// Annals of Mathematical Statistics 29 (1958).
#[must_use]
#[inline]
pub fn normal_pair(words: [u32; 2]) -> [f64; 2] {
    let radius = (-2.0 * ln_of_share(share(words[0]))).sqrt();
    let (sine, cosine) = sin_cos(TAU * (share(words[1]) - 0.5));
    [radius * cosine, radius * sine]
}

/// The natural logarithm of a number from 2^-33 to 1, within 1e-11; without branches.
#[inline]
fn ln_of_share(x: f64) -> f64 {
    // x = m 2^e with m from sqrt(1/2) to sqrt(2); ln m = 2 artanh((m - 1) / (m + 1)).
    const EXPONENT_ONE: u64 = 1023 << 52;
    const ROOT_HALF: u64 = 0x3FE6_A09E_667F_3BCD;
    let shifted = x
        .to_bits()
        .wrapping_sub(ROOT_HALF)
        .wrapping_add(EXPONENT_ONE);
    // The biased exponent as a float, without a conversion from 64-bit integers: it is put into
    // the last bits of 2^52.
    let biased = f64::from_bits(0x4330_0000_0000_0000 | (shifted >> 52)) - 4_503_599_627_370_496.0;
    let exponent = biased - 1023.0;
    let mantissa = f64::from_bits((shifted & 0x000F_FFFF_FFFF_FFFF).wrapping_add(ROOT_HALF));
    let z = (mantissa - 1.0) / (mantissa + 1.0);
    let square = z * z;
    let series = 1.0 / 13.0;
    let series = series * square + 1.0 / 11.0;
    let series = series * square + 1.0 / 9.0;
    let series = series * square + 1.0 / 7.0;
    let series = series * square + 1.0 / 5.0;
    let series = series * square + 1.0 / 3.0;
    let series = series * square + 1.0;
    2.0 * z * series + exponent * LN_2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_logarithm_is_that_of_the_reference() {
        for step in 0..=2_000_000_u32 {
            let x = share(step.wrapping_mul(2147));
            assert!((ln_of_share(x) - libm::log(x)).abs() < 1e-11, "{x}");
        }
        let least = share(0);
        assert!((ln_of_share(least) - libm::log(least)).abs() < 1e-11);
        assert!(
            (ln_of_share(std::f64::consts::FRAC_1_SQRT_2)
                - libm::log(std::f64::consts::FRAC_1_SQRT_2))
            .abs()
                < 1e-11
        );
    }

    /// Mean, variance and fourth moment of a million draws, each within five standard errors:
    /// wrong for a right generator less than once in a million; the seed is fixed.
    #[test]
    fn normal_numbers_have_the_moments_of_the_normal_distribution() {
        let noise = Noise::of(7, 0, Entity { kind: 0, index: 0 });
        let draws = 500_000_u32;
        let mut sums = [0.0; 3];
        for index in 0..draws {
            let [a, b, ..] = noise.words(1, 0, index);
            for value in normal_pair([a, b]) {
                sums[0] += value;
                sums[1] += value * value;
                sums[2] += value.powi(4);
            }
        }
        let count = 2.0 * f64::from(draws);
        let [mean, square, fourth] = sums.map(|sum| sum / count);
        assert!(mean.abs() < 5.0 / count.sqrt(), "{mean}");
        assert!(
            (square - 1.0).abs() < 5.0 * (2.0 / count).sqrt(),
            "{square}"
        );
        assert!(
            (fourth - 3.0).abs() < 5.0 * (96.0 / count).sqrt(),
            "{fourth}"
        );
    }

    #[test]
    fn words_depend_on_the_entity_the_use_the_time_and_the_thing() {
        let noise = |index| Noise::of(7, 3, Entity { kind: 1, index });
        let here = noise(2).words(3, 4, 5);
        assert_eq!(here, noise(2).words(3, 4, 5));
        let others = [
            noise(1).words(3, 4, 5),
            noise(2).words(4, 4, 5),
            noise(2).words(3, 5, 5),
            noise(2).words(3, 4, 6),
        ];
        assert!(others.iter().all(|other| *other != here));
        let mut many = [0; 8];
        noise(2).fill(3, 4, 5, &mut many);
        assert_eq!(many[..4], here);
        assert_eq!(many[4..], noise(2).words(3, 4, 6));
    }
}
