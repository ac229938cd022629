//! Counter-based random streams, keyed by their use.
//!
//! A draw is a pure function of (seed, run, entity, purpose, position in the stream). So any run can be
//! computed alone, on any thread, in any order; adding a robot, or a kind of robots, changes no other
//! stream; and two teams that are compared under one run number meet the same world (common random
//! numbers), because the configuration is not part of the key.
//!
//! Generator: Philox4x32-10 (Salmon, Moraes, Dror and Shaw, *Parallel random numbers: as easy as
//! 1, 2, 3*, SC'11). The 128-bit counter is laid out as
//!
//! ```text
//! bit 127            64 63      56 55       36 35        28 27         0
//!     run (64)          kind (8)   index (20)  purpose (8)  block (28)
//! ```
//!
//! and the 64-bit key is the seed, whose highest 24 bits are combined by exclusive or with the
//! highest 24 of the kind's 32: for seeds below 2^40 no two streams have the same key and counter.
//! A stream holds 2^28 blocks of four 32-bit words.

pub use rand_philox::Philox as Stream;

/// Maximum number of entities of one kind: indices are below this.
pub const MAX_INDEX: u32 = 1 << 20;

/// The owner of a stream: the `index`-th robot (or item, ...) of a kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Entity {
    /// Identifies the kind: the [`kind_key`] of its name, if it has one.
    pub kind: u32,
    /// Index within the kind, below [`MAX_INDEX`].
    pub index: u32,
}

/// Identifies a kind in random streams: a hash of its name, which does not depend on other kinds. Two
/// names have the same hash with a probability of 2^-32.
///
/// FNV-1a (G. Fowler, L. C. Noll, K.-P. Vo and D. Eastlake, *The FNV non-cryptographic hash
/// algorithm*).
#[must_use]
pub fn kind_key(name: &str) -> u32 {
    let hashed = |hash: u32, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193);
    name.bytes().fold(0x811c_9dc5, hashed)
}

/// The use of a stream. A purpose keeps its number forever: changing it changes every result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Purpose {
    /// Start position of a robot.
    Start = 1,
    /// Centre of a cluster of starts; the index is that of the cluster.
    StartCluster = 2,
    /// Heading of a robot at its start.
    StartHeading = 3,
    /// Position of an item.
    Item = 4,
    /// Centre of a cluster of items; the index is that of the cluster.
    ItemCluster = 5,
    /// Key of the random numbers of an entity during a run: [`crate::noise`].
    Noise = 6,
    /// Position of a goal.
    Goal = 7,
    /// Centre of a cluster of goals; the index is that of the cluster.
    GoalCluster = 8,
    /// Number of items of a kind.
    ItemNumber = 9,
}

/// The stream of an entity for a purpose in a run, before its first draw.
///
/// # Example
/// ```
/// use base::random::{stream, Entity, Purpose};
/// let robot = Entity { kind: 0, index: 3 };
/// let mut a = stream(7, 0, robot, Purpose::Start);
/// let mut b = stream(7, 0, robot, Purpose::Start);
/// assert_eq!(a.bounded(17), b.bounded(17));
/// ```
#[must_use]
#[inline]
pub fn stream(seed: u64, run: u64, entity: Entity, purpose: Purpose) -> Stream {
    debug_assert!(entity.index < MAX_INDEX, "entity index out of range");
    let [low_kind, high_kind @ ..] = entity.kind.to_le_bytes();
    let place = (u64::from(low_kind) << 56)
        | (u64::from(entity.index) << 36)
        | (u64::from(purpose as u8) << 28);
    let [s0, s1, s2, s3, s4, s5, s6, s7] = seed.to_le_bytes();
    let [k1, k2, k3] = high_kind;
    let key = [
        u32::from_le_bytes([s0, s1, s2, s3]),
        u32::from_le_bytes([s4, s5 ^ k1, s6 ^ k2, s7 ^ k3]),
    ];
    Stream::new(key, (u128::from(run) << 64) | u128::from(place))
}

/// A uniform number from 0 (included) to 1 (excluded), a multiple of 2^-53.
#[must_use]
#[inline]
#[expect(clippy::cast_precision_loss, reason = "53 bits are exact")]
pub fn unit(stream: &mut Stream) -> f64 {
    (stream.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn draws(seed: u64, run: u64, kind: u32, index: u32) -> [u32; 8] {
        let mut stream = stream(seed, run, Entity { kind, index }, Purpose::Start);
        std::array::from_fn(|_| stream.next_u32())
    }

    #[test]
    fn draws_are_the_same_bytes_for_ever() {
        // Philox4x32-10 with key (7, 0) and counter words (2^28, 3 << 4, 5, 0), computed apart.
        let expected = [1_168_190_557, 1_606_468_578, 1_880_442_423, 3_608_874_815];
        assert_eq!(draws(7, 5, 0, 3)[..4], expected);
    }

    #[test]
    fn keys_of_kinds_are_the_same_for_ever() {
        // Test vectors of FNV-1a, 32 bits, in the RFC draft of its makers.
        let expected = [0x811c_9dc5, 0xe40c_292c, 0xbf9c_f968];
        assert_eq!(["", "a", "foobar"].map(kind_key), expected);
    }

    #[test]
    fn the_whole_of_a_kind_s_key_is_in_its_streams() {
        // Philox4x32-10 with key (7, 0x01020300) and counter words (2^28, 0x04000030, 5, 0).
        let expected = rand_philox::philox4x32_10([1 << 28, 0x0400_0030, 5, 0], [7, 0x0102_0300]);
        assert_eq!(draws(7, 5, 0x0102_0304, 3)[..4], expected);
    }

    proptest! {
        #[test]
        fn changing_any_part_of_the_key_changes_the_stream(
            seed: u64, run: u64, kind: u32, index in 0..MAX_INDEX,
        ) {
            let here = draws(seed, run, kind, index);
            prop_assert_ne!(here, draws(seed ^ 1, run, kind, index));
            prop_assert_ne!(here, draws(seed ^ (1 << 63), run, kind, index));
            prop_assert_ne!(here, draws(seed, run ^ 1, kind, index));
            prop_assert_ne!(here, draws(seed, run ^ (1 << 63), kind, index));
            prop_assert_ne!(here, draws(seed, run, kind ^ 1, index));
            prop_assert_ne!(here, draws(seed, run, kind ^ (1 << 8), index));
            prop_assert_ne!(here, draws(seed, run, kind ^ (1 << 31), index));
            prop_assert_ne!(here, draws(seed, run, kind, index ^ 1));
        }
    }
}
