//! Several blocks of Philox4x32-10 at once, for loops that are compiled for wide vectors.
//!
//! The crate `rand_philox` is faster for sixteen blocks or more, with the instructions that every
//! machine has. A ring of sixteen rays needs four blocks, and its loop is compiled for the
//! instruction set of the machine: with eight 64-bit lanes, each round takes six instructions.

#![expect(clippy::inline_always, reason = "it is vectorised in its callers")]

/// Number of blocks that are computed together.
pub const LANES: usize = 8;

/// A word of each block, in the lower half of a number; the upper half is undefined.
pub type Words = [u64; LANES];

/// The words of several blocks: the first word of each, then the second word of each, ...
pub type Blocks = [Words; 4];

const MULTIPLIERS: [u64; 2] = [0xD251_1F53, 0xCD9E_8D57];
const BUMPS: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];
const LOW: u64 = 0xFFFF_FFFF;

/// Blocks for the counters `time`, `use_of` and `first`, `first + 1`, ... from the highest word to
/// the lowest.
#[inline(always)]
pub(crate) fn blocks(mut key: [u32; 2], first: u32, use_of: u32, time: u64) -> Blocks {
    #[expect(clippy::cast_possible_truncation, reason = "below LANES")]
    let index = |lane| u64::from(first.wrapping_add(lane as u32));
    let mut words = [
        std::array::from_fn(index),
        [u64::from(use_of); LANES],
        [time & LOW; LANES],
        [time >> 32; LANES],
    ];
    for _ in 0..10 {
        words = round(words, key);
        key = [key[0].wrapping_add(BUMPS[0]), key[1].wrapping_add(BUMPS[1])];
    }
    words
}

/// One round of all blocks.
#[inline(always)]
fn round([a, b, c, d]: [Words; 4], key: [u32; 2]) -> [Words; 4] {
    let product = |words: Words, by: u64| words.map(|word| (word & LOW) * by);
    let mixed = |product: Words, with: Words, key: u32| {
        std::array::from_fn(|lane| (product[lane] >> 32) ^ with[lane] ^ u64::from(key))
    };
    let even = product(a, MULTIPLIERS[0]);
    let odd = product(c, MULTIPLIERS[1]);
    [mixed(odd, b, key[0]), odd, mixed(even, d, key[1]), even]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rand_philox::philox4x32_10;

    proptest! {
        #[test]
        fn blocks_are_those_of_the_reference(key: [u32; 2], first: u32, use_of: u32, time: u64) {
            let blocks = blocks(key, first, use_of, time);
            for lane in 0..LANES {
                let [low, high] = [time, time >> 32].map(|time| u32::try_from(time & LOW).unwrap());
                let index = first.wrapping_add(u32::try_from(lane).unwrap());
                let expected = philox4x32_10([index, use_of, low, high], key);
                prop_assert_eq!(blocks.map(|words| words[lane] & LOW), expected.map(u64::from));
            }
        }
    }
}
