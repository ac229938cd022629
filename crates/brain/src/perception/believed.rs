//! Items and robots as a robot believes them to be.

use crate::io::body::RobotId;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An item, as it is believed to be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BelievedItem {
    /// Place of its kind in [`Body::item_kinds`](crate::Body::item_kinds).
    pub kind: u16,
    /// Where in the world.
    pub at: Point,
    /// Standard deviation of that along each axis.
    pub deviation_m: f64,
    /// How surely it is there, 0 to 1.
    pub confidence: f64,
}

/// A robot, as it is believed to be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BelievedRobot {
    /// Which, if it is known for one.
    pub id: Option<RobotId>,
    /// From the robot's front.
    pub at: Point,
    /// Over ground, along the robot's front and left.
    pub velocity_m_s: Point,
    /// Time since it was last seen.
    pub age_s: f64,
}
