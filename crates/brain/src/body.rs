//! What a brain knows of the body that it is in.

use alloc::string::String;
use alloc::vec::Vec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which robot: the `index`-th of its kind, both counted from 0.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    JsonSchema,
)]
#[serde(deny_unknown_fields)]
pub struct RobotId {
    /// Place of the robot's kind in the scenario.
    pub kind: u8,
    /// Place within the kind.
    pub index: u32,
}

/// What a brain knows of its body, the same for every robot of a kind.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Of the disc that it covers.
    #[schemars(range(min = 0.0))]
    pub radius_m: f64,
    /// At most so fast ahead.
    #[schemars(range(min = 0.0))]
    pub max_speed_m_s: f64,
    /// At most so fast backwards; 0 if it cannot.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub max_reverse_speed_m_s: f64,
    /// It gains and loses speed at most so fast; infinite if at once (`null` in JSON).
    #[serde(default = "at_once", with = "crate::infinite::number")]
    #[schemars(with = "Option<f64>", range(min = 0.0))]
    pub max_acceleration_m_s2: f64,
    /// It turns at most so fast, either way.
    #[schemars(range(min = 0.0))]
    pub max_turn_rate_rad_s: f64,
    /// Time between two steps of the brain.
    #[schemars(range(min = 0.0))]
    pub period_s: f64,
    /// Names of its sensors, in the order in which requests count them.
    #[serde(default)]
    pub sensors: Vec<String>,
    /// Its range rings, in the order in which percepts have their scans.
    #[serde(default)]
    pub rings: Vec<RangeRing>,
    /// Names of the kinds of items that there are.
    #[serde(default)]
    pub item_kinds: Vec<String>,
}

/// The rays of a range sensor.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RangeRing {
    /// Direction of each ray from the robot's front, anticlockwise; above -pi, up to pi.
    pub bearings_rad: Vec<f64>,
    /// Nothing farther from the robot's centre is measured.
    #[schemars(range(min = 0.0))]
    pub range_m: f64,
    /// Time between two scans.
    #[schemars(range(min = 0.0))]
    pub period_s: f64,
    /// Time from a scan until the brain has it.
    #[schemars(range(min = 0.0))]
    pub latency_s: f64,
}

fn at_once() -> f64 {
    f64::INFINITY
}
