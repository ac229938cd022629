//! A ring of rays that measure distances.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Rays from the robot's centre, evenly spread over the field of view.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RangeSpec {
    /// Rays; a whole circle has the first ahead, a sector one on each edge.
    #[schemars(range(min = 1, max = 1440))]
    pub rays: u32,
    /// Angle that they cover, in degrees.
    #[serde(default = "whole_circle")]
    #[schemars(range(min = 0.0, max = 360.0))]
    pub fov_deg: f64,
    /// Its middle, in degrees anticlockwise from the robot's front.
    #[serde(default)]
    #[schemars(range(min = -180.0, max = 180.0))]
    pub facing_deg: f64,
    /// Nothing farther from the robot's centre is measured, in metres.
    #[schemars(range(min = 0.01, max = 10_000.0))]
    pub range_m: f64,
    /// Standard deviation of each distance, in metres.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub noise_m: f64,
    /// More standard deviation, as a share of the distance.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub noise_share: f64,
    /// Probability that a ray's echo is lost.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub miss: f64,
    /// Probability that a ray has an echo of nothing, at any distance up to what is there.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub false_echo: f64,
}

pub(super) fn whole_circle() -> f64 {
    360.0
}
