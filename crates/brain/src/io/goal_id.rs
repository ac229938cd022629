//! Ids of goals.

use super::agent_id::{AgentId, NO_KIND};
use base::geometry::Point;
use base::hash::Hash;
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
    /// What numbered the goal.
    pub issuer: Issuer,
    /// Its number among the goals of the issuer; in a list of waypoints, its index.
    pub number: u32,
}

/// What numbers goals.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(untagged)]
pub enum Issuer {
    /// An agent, by its id at that time.
    Agent(AgentId),
    /// A list of waypoints, or the goals of a kind in the scenario.
    List(GoalList),
}

/// A list of goals.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(deny_unknown_fields)]
pub struct GoalList {
    /// A number that follows from the waypoints, or from the name of the kind: robots with different lists do not
    /// confuse their goals, and robots with the same list share them.
    pub list: u32,
}

impl Issuer {
    /// The agent, if it is one.
    #[must_use]
    pub fn agent(self) -> Option<AgentId> {
        match self {
            Self::Agent(id) => Some(id),
            Self::List(_) => None,
        }
    }

    /// The index of the agent within its kind, or the number of the list.
    #[must_use]
    pub fn number(self) -> u32 {
        match self {
            Self::Agent(id) => id.index,
            Self::List(GoalList { list }) => list,
        }
    }
}

impl Default for Issuer {
    fn default() -> Self {
        Self::Agent(AgentId::default())
    }
}

impl From<AgentId> for Issuer {
    fn from(id: AgentId) -> Self {
        Self::Agent(id)
    }
}

impl Hashed for Issuer {
    fn add_to(&self, hash: &mut Hash) {
        match *self {
            Self::Agent(id) => id.add_to(hash),
            Self::List(GoalList { list }) => (NO_KIND, list).add_to(hash),
        }
    }
}

/// A goal, and its place in the world.
#[derive(Debug, Clone, Copy, PartialEq, Hashed)]
pub(crate) struct GoalPlace {
    pub(crate) id: GoalId,
    pub(crate) at: Point,
}

/// The issuer of the goals of a list of waypoints.
#[must_use]
pub fn issuer_of(waypoints: &[Point]) -> Issuer {
    // Adding 0 makes -0 the same as 0.
    let coordinates = waypoints.iter().flat_map(|at| [at.x + 0.0, at.y + 0.0]);
    let bytes = coordinates.flat_map(|along_m| along_m.to_bits().to_le_bytes());
    let hash = bytes.fold(FNV_OFFSET, |hash, byte| {
        (hash ^ u32::from(byte)).wrapping_mul(FNV_PRIME)
    });
    Issuer::List(GoalList { list: hash.max(1) })
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
