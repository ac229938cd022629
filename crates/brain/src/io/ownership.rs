//! Messages between controllers about the ownership of goals.

use super::agent_id::AgentId;
use super::contract::Award;
use super::goal_id::GoalId;
use super::lease::Claim;
use super::work::Task;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A message between controllers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum OwnershipMessage {
    /// From a controller to all: it is present.
    Present {},
    /// From a controller to others: the position of a robot that they may not see.
    Seen(Seen),
    /// From the owner of a goal, or a candidate, to others of its kind: a request to vote for it, and to keep the description
    /// of the goal.
    Entrust(Entrust),
    /// The answer to it: a vote, which is an ownership lease of this duration from sending the request.
    Entrusted(Award),
    /// From an owner to its voters: a robot that has been awarded a goal. Of a goal that was taken over, only such
    /// a robot can report that it is done.
    Assigned(Assignment),
    /// From a controller to its voters: it neither owns the goal any more nor is a candidate. The number is that of the request
    /// by which the lease was granted.
    Release(Claim),
    /// From a controller to others of its kind: the goal has been served, or is not to be served any more.
    Ended(GoalId),
    /// The answer to it.
    Noted(GoalId),
}

impl OwnershipMessage {
    pub(super) fn urgency(&self) -> u8 {
        match self {
            Self::Entrust(_) | Self::Present {} => 2,
            Self::Seen(_) => 3,
            _ => 1,
        }
    }
}

/// A request to vote for the sender as the owner of a goal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Entrust {
    /// The number of the request.
    pub number: u32,
    /// The description of the goal.
    pub task: Task,
}

/// A robot that has been awarded a goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Assignment {
    /// The goal.
    pub goal: GoalId,
    /// The robot.
    pub robot: AgentId,
}

/// The position of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Seen {
    /// The robot.
    pub robot: AgentId,
    /// Its position in the world, in metres.
    pub at_m: [f32; 2],
}
