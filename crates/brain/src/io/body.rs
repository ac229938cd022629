//! What a brain knows of the body that it is in.

use alloc::string::String;
use alloc::vec::Vec;
use base::geometry::Rectangle;
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
    #[serde(default = "at_once", with = "crate::io::infinite::number")]
    #[schemars(with = "Option<f64>", range(min = 0.0))]
    pub max_acceleration_m_s2: f64,
    /// It turns at most so fast, either way.
    #[schemars(range(min = 0.0))]
    pub max_turn_rate_rad_s: f64,
    /// Time between two steps of the brain.
    #[schemars(range(min = 1e-6))]
    pub period_s: f64,
    /// Names of its sensors, in the order in which requests count them.
    #[serde(default)]
    pub sensors: Vec<String>,
    /// Its range rings, in the order in which percepts have their scans.
    #[serde(default)]
    pub rings: Vec<RangeRing>,
    /// What recognises items, in the order of its sensors.
    #[serde(default)]
    pub detectors: Vec<Detector>,
    /// Standard deviation of its position sensor along each axis.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub position_noise_m: f64,
    /// Standard deviation of its compass.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub heading_noise_rad: f64,
    /// Standard deviation of where other robots seem to be, along each axis.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub neighbour_noise_m: f64,
    /// Names of the kinds of items that there are.
    #[serde(default)]
    pub item_kinds: Vec<String>,
    /// Bodies of all kinds of robots that there are, in the order in which ids count them.
    #[serde(default)]
    pub others: Vec<Other>,
    /// Where its mission is; left out, it is not told.
    pub field: Option<Rectangle>,
}

impl Body {
    /// Whether it is the same body, though it may be told of other robots.
    #[must_use]
    pub fn is_same_but_for_others(&self, body: &Self) -> bool {
        let others = self.others.clone();
        *self
            == Self {
                others,
                ..body.clone()
            }
    }
}

/// What a brain knows of the bodies of another kind of robots.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Other {
    /// Of the disc that it covers.
    #[schemars(range(min = 0.0))]
    pub radius_m: f64,
    /// It gains and loses speed at most so fast; infinite if at once (`null` in JSON).
    #[serde(default = "at_once", with = "crate::io::infinite::number")]
    #[schemars(with = "Option<f64>", range(min = 0.0))]
    pub max_acceleration_m_s2: f64,
    /// Whether the two can run into each other: not if one of them flies.
    pub is_in_the_way: bool,
    /// What it recognises items with.
    #[serde(default)]
    pub detectors: Vec<Detector>,
}

/// A sensor that recognises items.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Detector {
    /// Its place in [`Body::sensors`].
    pub sensor: u16,
    /// It looks no farther from the robot's centre.
    #[schemars(range(min = 0.0))]
    pub range_m: f64,
    /// Angle that it covers.
    #[schemars(range(min = 0.0))]
    pub width_rad: f64,
    /// Its middle, from the robot's front.
    pub facing_rad: f64,
    /// For each kind of item, pairs of distance in metres and probability of detection in one look,
    /// by growing distance, linear between two; none if it never recognises that kind.
    pub detection_probability: Vec<Vec<[f64; 2]>>,
    /// False contacts of each kind in one look, for each square metre in view.
    pub false_alarms_per_m2: Vec<f64>,
    /// Standard deviation of where a contact seems to be, along each axis.
    #[schemars(range(min = 0.0))]
    pub noise_m: f64,
    /// Whether obstacles hide items from it.
    pub needs_line_of_sight: bool,
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
