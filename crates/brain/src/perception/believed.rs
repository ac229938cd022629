//! Estimates of items and robots, as the belief state shows them.

use crate::io::agent_id::AgentId;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The estimate of an item.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BelievedItem {
    /// Index of its kind in [`Body::item_kinds`](crate::Body::item_kinds).
    pub kind: u16,
    /// Its position in the world.
    pub at: Point,
    /// Standard deviation of the position along each axis.
    pub deviation_m: f64,
    /// Probability that it exists, 0 to 1.
    pub confidence: f64,
}

/// The estimate of another robot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BelievedRobot {
    /// Its id, if it was identified.
    pub id: Option<AgentId>,
    /// Its position in the robot's frame: x forwards, y to the left.
    pub at: Point,
    /// Its velocity over ground, in the same frame.
    pub velocity_m_s: Point,
    /// Time since it was last detected.
    pub age_s: f64,
}
