//! Ids of goals.

use super::body::{NO_ROBOT, RobotId};
use base::geometry::Point;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Constants of the hash FNV-1a of 32 bits.
const FNV_OFFSET: u32 = 0x811c_9dc5;
const FNV_PRIME: u32 = 0x0100_0193;

/// The id of a goal. It alone decides whether two goals are the same: a goal may move, and two goals
/// may lie at one place.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    JsonSchema,
    Hashed,
)]
#[serde(deny_unknown_fields)]
pub struct GoalId {
    /// The robot that numbered the goal, by its id at that time. The kind 255 stands for others:
    /// with the index 0 for a person, otherwise for a list of waypoints, the same for all robots with
    /// the same list.
    pub issuer: RobotId,
    /// Its number among the goals of the issuer; in a list of waypoints, its index.
    pub number: u32,
}

/// A goal, and its place in the world.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub(crate) struct GoalPlace {
    pub(crate) id: GoalId,
    pub(crate) at: Point,
}

/// The issuer of the goals of a list of waypoints. It follows from the list, so that kinds of robots
/// with different lists do not confuse their goals, and kinds with the same list share them.
#[must_use]
pub fn issuer_of(waypoints: &[Point]) -> RobotId {
    // Adding 0 makes -0 the same as 0.
    let coordinates = waypoints.iter().flat_map(|at| [at.x + 0.0, at.y + 0.0]);
    let bytes = coordinates.flat_map(|along_m| along_m.to_bits().to_le_bytes());
    let hash = bytes.fold(FNV_OFFSET, |hash, byte| {
        (hash ^ u32::from(byte)).wrapping_mul(FNV_PRIME)
    });
    RobotId {
        kind: NO_ROBOT,
        // 0 is the index of the operator.
        index: hash.max(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list(coordinates: &[[f64; 2]]) -> Vec<Point> {
        coordinates.iter().map(|at| Point::from(*at)).collect()
    }

    #[test]
    fn equal_lists_have_one_issuer_and_different_lists_have_different_ones() {
        let issuer = issuer_of(&list(&[[1.0, 2.0], [0.0, 4.0]]));
        assert_eq!(issuer, issuer_of(&list(&[[1.0, 2.0], [-0.0, 4.0]])));
        for other in [
            list(&[]),
            list(&[[1.0, 2.0]]),
            list(&[[0.0, 4.0], [1.0, 2.0]]),
            list(&[[1.0, 2.0], [0.0, 4.001]]),
        ] {
            assert_ne!(issuer, issuer_of(&other), "{other:?}");
        }
    }
}
