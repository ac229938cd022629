//! A detector of items.

use super::range::whole_circle;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What detects items within a sector; each look at an item is a draw of its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ItemsSpec {
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
    /// Probability of detection in one look, for each kind of item that it can recognise; left out,
    /// it recognises all kinds always.
    pub detects: Option<BTreeMap<String, Detection>>,
    /// False contacts a second for each square metre in view, by the kind that they are taken for.
    #[serde(default)]
    pub false_alarms_per_m2_s: BTreeMap<String, f64>,
    /// Standard deviation of where a contact seems to be, along each axis, in metres.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub noise_m: f64,
    /// Whether obstacles hide items.
    #[serde(default = "yes")]
    pub needs_line_of_sight: bool,
}

/// Probability of detection in one look.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Detection {
    /// The same at any distance in range.
    Constant(#[schemars(range(min = 0.0, max = 1.0))] f64),
    /// Pairs of distance in metres and probability, by growing distance; between two, linear.
    Table(Vec<[f64; 2]>),
    /// A bell: best at the robot, half of that at some distance.
    Curve {
        /// Probability at no distance.
        #[schemars(range(min = 0.0, max = 1.0))]
        best: f64,
        /// Where it is half of that, in metres.
        #[schemars(range(min = 0.001, max = 10_000.0))]
        half_m: f64,
    },
}

pub(super) fn yes() -> bool {
    true
}
