//! Messages by which the holder of leases renews them: a robot those of its service, a controller those of its ownership.

use super::goal_id::GoalId;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A message about leases between their holder and their grantor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum LeaseMessage {
    /// From the holder of leases: a request to renew all that it has of the receiver.
    Renew(Renewal),
    /// The renewal of this number is granted.
    Renewed(u32),
    /// The lists of leases differ; the holder is to renew each one.
    Differs(u32),
    /// From the holder of a lease: a request to renew it.
    RenewOne(Claim),
    /// The renewal of a lease is granted.
    RenewedOne(Claim),
}

/// A goal, and the number of a request of the robot or controller that holds its lease.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// The goal.
    pub goal: GoalId,
    /// The number that the holder gave its request, which is different for each.
    pub number: u32,
}

/// A request to renew all leases between two agents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Renewal {
    /// The number that the holder gave the request.
    pub number: u32,
    /// Number of leases.
    pub count: u16,
    /// Hash of the goals.
    pub hash: [u32; 2],
}
