//! A detector of other robots.

use super::items::{Detection, yes};
use super::range::whole_circle;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What recognises other robots within a sector, and tells which they are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RobotsSpec {
    /// It looks no farther from the robot's centre, in metres.
    #[schemars(range(min = 0.0, max = 10_000.0))]
    pub range_m: f64,
    /// Angle that it covers, in degrees.
    #[serde(default = "whole_circle")]
    #[schemars(range(min = 0.0, max = 360.0))]
    pub fov_deg: f64,
    /// Its middle, in degrees anticlockwise from the robot's front.
    #[serde(default)]
    #[schemars(range(min = -180.0, max = 180.0))]
    pub facing_deg: f64,
    /// Probability of detection in one look; left out, always.
    pub detects: Option<Detection>,
    /// Standard deviation of where a robot seems to be, along each axis, in metres.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub noise_m: f64,
    /// Whether obstacles hide robots.
    #[serde(default = "yes")]
    pub needs_line_of_sight: bool,
}
