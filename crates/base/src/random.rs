//! Random streams that depend on what they are for, never on when they are asked.
//!
//! A draw is a pure function of (seed, run, entity, purpose, position in the stream). So any run
//! can be computed alone, on any thread, in any order; adding a robot of one kind changes nobody
//! else's stream; and two teams compared under one run number meet the same world (common random
//! numbers): the configuration is not part of the key.
//!
//! Generator: Philox4x32-10 (Salmon, Moraes, Dror and Shaw, *Parallel random numbers: as easy as
//! 1, 2, 3*, SC'11). The 64-bit key is the seed; the 128-bit counter is laid out as
//!
//! ```text
//! bit 127            64 63      56 55       36 35        28 27         0
//!     run (64)          kind (8)   index (20)  purpose (8)  block (28)
//! ```
//!
//! A stream holds 2^28 blocks of four 32-bit words.

pub use rand_philox::Philox as Stream;

/// Robots of one kind that can have streams of their own: indices are below this.
pub const MAX_INDEX: u32 = 1 << 20;

/// Whose stream it is: the `index`-th robot (or item, ...) of the `kind`-th kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Entity {
    /// Place of the kind in the scenario.
    pub kind: u8,
    /// Place within the kind, below [`MAX_INDEX`].
    pub index: u32,
}

/// What a stream is used for. A purpose keeps its number for ever: a change changes every result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Purpose {
    /// Where an entity starts.
    Start = 1,
    /// Where a cluster of starts has its centre; the index is the cluster's.
    StartCluster = 2,
    /// Which way an entity looks at its start.
    StartHeading = 3,
    /// Where an item lies.
    Item = 4,
    /// Where a cluster of items has its centre; the index is the cluster's.
    ItemCluster = 5,
    /// The key of its own random numbers in a run: [`crate::noise`].
    Noise = 6,
}

/// The stream of one entity for one purpose in one run, at its first draw.
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
    let place = (u64::from(entity.kind) << 56)
        | (u64::from(entity.index) << 36)
        | (u64::from(purpose as u8) << 28);
    let [s0, s1, s2, s3, s4, s5, s6, s7] = seed.to_le_bytes();
    let key = [
        u32::from_le_bytes([s0, s1, s2, s3]),
        u32::from_le_bytes([s4, s5, s6, s7]),
    ];
    Stream::new(key, (u128::from(run) << 64) | u128::from(place))
}

/// A number from 0 up to 1, exclusive: any multiple of 2^-53, each as likely.
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

    fn draws(seed: u64, run: u64, kind: u8, index: u32) -> [u32; 8] {
        let mut stream = stream(seed, run, Entity { kind, index }, Purpose::Start);
        std::array::from_fn(|_| stream.next_u32())
    }

    #[test]
    fn draws_are_the_same_bytes_for_ever() {
        // Philox4x32-10 with key (7, 0) and counter words (2^28, 3 << 4, 5, 0), computed apart.
        let expected = [1_168_190_557, 1_606_468_578, 1_880_442_423, 3_608_874_815];
        assert_eq!(draws(7, 5, 0, 3)[..4], expected);
    }

    proptest! {
        #[test]
        fn changing_any_part_of_the_key_changes_the_stream(
            seed: u64, run: u64, kind: u8, index in 0..MAX_INDEX,
        ) {
            let here = draws(seed, run, kind, index);
            prop_assert_ne!(here, draws(seed ^ 1, run, kind, index));
            prop_assert_ne!(here, draws(seed ^ (1 << 63), run, kind, index));
            prop_assert_ne!(here, draws(seed, run ^ 1, kind, index));
            prop_assert_ne!(here, draws(seed, run ^ (1 << 63), kind, index));
            prop_assert_ne!(here, draws(seed, run, kind ^ 1, index));
            prop_assert_ne!(here, draws(seed, run, kind, index ^ 1));
        }
    }
}
