//! The verdict on a goal.

use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The state of a goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The robot has reached it.
    Complete,
    /// There is no known path, the battery does not last, or the robot has tried for too long.
    Impossible,
    /// The robot comes nearer.
    Approaching,
    /// The robot has not come nearer for some time.
    Receding,
}
