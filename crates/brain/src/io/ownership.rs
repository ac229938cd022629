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
    /// From a controller to all: it is present, and has this serial number.
    Serial(u32),
    /// From a controller to others: the position of a robot that they may not see.
    Seen(Seen),
    /// From an owner to another controller: it is to be the backup of a goal.
    Entrust(Task),
    /// The answer to it, and to a binding: it is ready to be the backup, and grants ownership leases of this
    /// duration.
    Entrusted(Award),
    /// From an owner to its backup: from now on, it owns the goal only while the backup renews its lease.
    /// The number is that of the answer to which it refers, the duration that of its longest service
    /// lease.
    Bind(Award),
    /// From an owner to its backup: a robot that has been awarded a goal. Of a goal that was taken over, only such
    /// a robot can report that it is done.
    Assigned(Assignment),
    /// From an owner to its backup: a request to be the backup no longer.
    Relieve(Claim),
    /// The answer to it: it is no longer the backup.
    Relieved(Claim),
    /// From a backup that has taken a goal over to the previous owner: it can have it back.
    Restore(Task),
}

impl OwnershipMessage {
    pub(super) fn urgency(&self) -> u8 {
        match self {
            Self::Entrust(_) | Self::Serial(_) => 2,
            Self::Seen(_) => 3,
            _ => 1,
        }
    }
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
