//! Why a goal is not served.

use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Why a goal is not served.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// No path leads there, or the robot does not come nearer.
    Unreachable,
    /// It lacks the capability.
    Capability,
    /// It would be too late.
    Deadline,
    /// The battery does not last.
    Battery,
    /// It serves the maximum number of goals.
    Full,
    /// The lease has ended, or is shorter than the service takes.
    Lease,
    /// It has been taken out of service.
    OutOfService,
    /// No robot is in range.
    NoRobot,
    /// No majority of controllers votes for an owner.
    OwnershipLost,
    /// No controller that could own it works.
    NoController,
    /// The robot does not know its position well enough.
    Position,
    /// A robot has reported that it served it, which it had not.
    DoneInError,
    /// Its numbers are impossible, such as a radius of 0.
    Invalid,
}
