//! Random numbers of an entity, as a function of their use and of the time.
//!
//! Unlike a sequential stream, this returns the words of any measurement of any sensor directly: the
//! draws of one sensor do not affect another, and a skipped measurement does not affect the next. The generator is Philox4x32-10 (see [`crate::random`]), with a key for each entity.

#![expect(clippy::inline_always, reason = "it is vectorised in its callers")]

use crate::philox::{Blocks, LANES, Words, blocks};
use crate::random::{Entity, Purpose, stream};
use rand_philox::philox4x32_10;
use std::f32::consts::{FRAC_PI_2, LN_2};

/// Number of entities that receive words together: one for each word of the blocks.
pub const BATCH: usize = 4 * LANES;

/// 2^-32.
const WORD: f64 = 1.0 / 4_294_967_296.0;

/// 2^-31, and 2^-30.
const HALF_WORD: f32 = 1.0 / 2_147_483_648.0;
const QUARTER: f32 = 1.0 / 1_073_741_824.0;

/// The low bits of this float can hold a whole number below 2^52, which converts such a number in the
/// same few instructions on every machine.
const WHOLE_BITS: u64 = 0x4330_0000_0000_0000;
const WHOLE: f64 = 4_503_599_627_370_496.0;

/// The lower half of a number.
const LOW: u64 = 0xFFFF_FFFF;

/// The random numbers of one entity in one run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Noise {
    key: [u32; 2],
}

impl Noise {
    /// The random numbers of an entity.
    #[must_use]
    pub fn of(seed: u64, run: u64, entity: Entity) -> Self {
        let mut stream = stream(seed, run, entity, Purpose::Noise);
        Self {
            key: [stream.next_u32(), stream.next_u32()],
        }
    }

    /// Four words for a use, a time and an index.
    #[must_use]
    #[inline]
    pub fn words(self, use_of: u32, time: u64, index: u32) -> [u32; 4] {
        #[expect(clippy::cast_possible_truncation, reason = "two halves")]
        let [low, high] = [time as u32, (time >> 32) as u32];
        philox4x32_10([index, use_of, low, high], self.key)
    }

    /// A word for each entity of a batch of [`BATCH`]: row `row` and lane `lane` hold that of entity
    /// `LANES * row + lane` of the batch.
    ///
    /// For loops: it is inlined and compiled for the instruction set of its caller.
    #[must_use]
    #[inline(always)]
    pub fn batch_words(self, use_of: u32, time: u64, batch: u32) -> Blocks {
        #[expect(clippy::cast_possible_truncation, reason = "a few")]
        let first = batch.wrapping_mul(LANES as u32);
        blocks(self.key, first, use_of, time)
    }
}

/// A uniform number from 0 to 1, both excluded.
#[must_use]
#[inline(always)]
pub fn share(word: u32) -> f64 {
    share_of(u64::from(word))
}

/// The same, from the lower half of a 64-bit number.
#[must_use]
#[inline(always)]
pub fn share_of(word: u64) -> f64 {
    (whole(word & LOW) + 0.5) * WORD
}

/// Two independent standard normal numbers, at most 6.7 from 0, with the precision of 32-bit floats:
/// no sensor is more precise than a millionth of its error.
///
/// Source: G. E. P. Box and M. E. Muller, *A note on the generation of random normal deviates*,
/// Annals of Mathematical Statistics 29 (1958).
#[must_use]
#[inline(always)]
pub fn normal_pair(words: [u32; 2]) -> [f64; 2] {
    let radius = (-2.0 * ln_of_share(words[0])).sqrt();
    on_circle(words[1]).map(|part| f64::from(radius * part))
}

/// [`normal_pair`] for each lane.
#[must_use]
#[inline(always)]
pub fn normal_pairs(words: [&Words; 2]) -> [[f64; LANES]; 2] {
    let mut pairs = [[0.0; LANES]; 2];
    for lane in 0..LANES {
        #[expect(clippy::cast_possible_truncation, reason = "the lower half")]
        let [one, other] = normal_pair(words.map(|words| words[lane] as u32));
        pairs[0][lane] = one;
        pairs[1][lane] = other;
    }
    pairs
}

/// A uniform point of the unit circle, within 2e-7; without branches.
///
/// The first two bits select the quadrant, the others the position in it.
#[inline(always)]
fn on_circle(word: u32) -> [f32; 2] {
    let x = ((short(word & (u32::MAX >> 2)) + 0.5) * QUARTER - 0.5) * FRAC_PI_2;
    let q = x * x;
    // Pairwise sums (Estrin's scheme) have shorter dependency chains than Horner's rule.
    let last = -1.0 / 5_040.0 + q * (1.0 / 362_880.0);
    let sine = x + x * (q * ((-1.0 / 6.0 + q * (1.0 / 120.0)) + (q * q) * last));
    let last = 1.0 / 24.0 - q * (1.0 / 720.0);
    let cosine = (1.0 - q * 0.5) + (q * q) * (last + (q * q) * (1.0 / 40_320.0));
    let quarter = word >> 30;
    let [one, other] = if quarter & 1 == 0 {
        [cosine, sine]
    } else {
        [sine, cosine]
    };
    let flip = |is_negative: u32, value: f32| f32::from_bits(value.to_bits() ^ (is_negative << 31));
    [
        flip((quarter ^ quarter >> 1) & 1, one),
        flip(quarter >> 1, other),
    ]
}

/// The natural logarithm of a word divided by 2^32, within a millionth; without branches.
#[inline(always)]
fn ln_of_share(word: u32) -> f32 {
    // x = m 2^e with m from sqrt(1/2) to sqrt(2); ln m = 2 artanh((m - 1) / (m + 1)).
    const EXPONENT_ONE: u32 = 127 << 23;
    const ROOT_HALF: u32 = 0x3F35_04F3;
    let x = (short(word >> 1) + 0.5) * HALF_WORD;
    let shifted = x
        .to_bits()
        .wrapping_sub(ROOT_HALF)
        .wrapping_add(EXPONENT_ONE);
    let exponent = short(shifted >> 23) - 127.0;
    let mantissa = f32::from_bits((shifted & 0x007F_FFFF).wrapping_add(ROOT_HALF));
    let z = (mantissa - 1.0) / (mantissa + 1.0);
    let q = z * z;
    let last = (1.0 / 5.0 + q * (1.0 / 7.0)) + (q * q) * (1.0 / 9.0);
    let first = 1.0 + q * (1.0 / 3.0);
    2.0 * z * (first + (q * q) * last) + exponent * LN_2
}

/// A number below 2^31 as a 32-bit float, by way of a signed integer, which all machines convert directly.
#[inline(always)]
#[expect(
    clippy::cast_possible_wrap,
    clippy::cast_precision_loss,
    reason = "below 2^31; within the precision of 32-bit floats"
)]
fn short(number: u32) -> f32 {
    number as i32 as f32
}

/// A number below 2^52 as a float.
#[inline(always)]
fn whole(number: u64) -> f64 {
    f64::from_bits(WHOLE_BITS | number) - WHOLE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_logarithm_is_that_of_the_reference() {
        let near = (0..1000).flat_map(|word| [word, u32::MAX - word, (1 << 31) + word]);
        let all = (0..=2_000_000_u32).map(|step| step.wrapping_mul(2147));
        for word in near.chain(all) {
            let x = (f64::from(word >> 1) + 0.5) / 2_147_483_648.0;
            let off = f64::from(ln_of_share(word)) - libm::log(x);
            // Next to 1 it is the share that is rounded.
            assert!(off.abs() < 1e-6 * libm::log(x).abs().max(0.1), "{word}");
        }
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
    }

    #[test]
    fn a_batch_has_the_words_of_its_entities() {
        let noise = Noise::of(7, 3, Entity { kind: 1, index: 2 });
        let batch = noise.batch_words(3, 1 << 40, 5);
        let words = |lane: usize| {
            let index = u32::try_from(5 * LANES + lane).unwrap();
            noise.words(3, 1 << 40, index)
        };
        for (row, drawn) in batch.iter().enumerate() {
            assert_eq!(
                drawn.map(|word| word & LOW),
                std::array::from_fn(|lane| u64::from(words(lane)[row]))
            );
        }
    }

    #[test]
    fn points_of_the_circle_are_those_of_the_reference() {
        for step in 0..=2_000_000_u32 {
            let word = step.wrapping_mul(2147);
            let [x, y] = on_circle(word).map(f64::from);
            // The first quarter is that about the x-axis.
            let angle = (share(word) - 0.125) * std::f64::consts::TAU;
            assert!((x - libm::cos(angle)).abs() < 2e-7, "{word}");
            assert!((y - libm::sin(angle)).abs() < 2e-7, "{word}");
        }
    }

    #[test]
    fn normal_numbers_by_lanes_are_those_one_by_one() {
        let words = Noise::of(7, 3, Entity { kind: 1, index: 2 }).batch_words(3, 4, 5);
        let pairs = normal_pairs([&words[0], &words[1]]);
        for lane in 0..LANES {
            let word = |row: usize| u32::try_from(words[row][lane] & LOW).unwrap();
            let expected = normal_pair([word(0), word(1)]);
            assert_eq!(
                [pairs[0][lane], pairs[1][lane]].map(f64::to_bits),
                expected.map(f64::to_bits)
            );
        }
    }
}
