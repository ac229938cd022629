//! What a brain knows of its body.

use super::act::{ActKind, Tool};
use alloc::string::String;
use alloc::vec::Vec;
use base::geometry::Rectangle;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a brain knows of its body, the same for all robots of a kind.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Radius of its footprint.
    #[schemars(range(min = 0.0))]
    pub radius_m: f64,
    /// Maximum forward speed.
    #[schemars(range(min = 0.0))]
    pub max_speed_m_s: f64,
    /// Maximum reverse speed; 0 if it cannot reverse.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub max_reverse_speed_m_s: f64,
    /// Maximum acceleration and deceleration; infinite if speed changes instantly (`null` in JSON).
    #[serde(default = "at_once", with = "crate::io::infinite::number")]
    #[schemars(with = "Option<f64>", range(min = 0.0))]
    pub max_acceleration_m_s2: f64,
    /// Maximum turn rate, in either direction.
    #[schemars(range(min = 0.0))]
    pub max_turn_rate_rad_s: f64,
    /// Time between two steps of the brain.
    #[schemars(range(min = 1e-6))]
    pub period_s: f64,
    /// Names of its sensors, in the order in which requests count them.
    #[serde(default)]
    pub sensors: Vec<String>,
    /// Its range rings, in the order of the scans of percepts.
    #[serde(default)]
    pub rings: Vec<RangeRing>,
    /// Its item detectors, in the order of its sensors.
    #[serde(default)]
    pub detectors: Vec<Detector>,
    /// Standard deviation of its position sensor, along each axis.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub position_noise_m: f64,
    /// Standard deviation of the slow error of its position sensor, along each axis.
    #[serde(default, skip_serializing_if = "is_exactly_zero")]
    #[schemars(range(min = 0.0))]
    pub position_drift_m: f64,
    /// Time after which that slow error is independent of what it was; 0 without one.
    #[serde(default, skip_serializing_if = "is_exactly_zero")]
    #[schemars(range(min = 0.0))]
    pub position_drift_s: f64,
    /// Standard deviation of its compass.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub heading_noise_rad: f64,
    /// Standard deviation of the measured positions of other robots, along each axis.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub neighbour_noise_m: f64,
    /// Names of all kinds of items.
    #[serde(default)]
    pub item_kinds: Vec<String>,
    /// For each kind of item, the distance from its footprint at which an item may destroy it; `null` for kinds that
    /// do not. Empty if no kind does.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(inner(range(min = 0.0)))]
    pub hazards_m: Vec<Option<f64>>,
    /// Bodies of all kinds of robots, in the order in which ids count them.
    #[serde(default)]
    pub others: Vec<Other>,
    /// Numbers of its capabilities, from 1; goals require them by number.
    #[serde(default)]
    pub capabilities: Vec<u8>,
    /// Its tools for acts, one for each kind of act that it can do.
    #[serde(default)]
    pub tools: Vec<Tool>,
    /// The area of its mission; without it, unknown.
    pub field: Option<Rectangle>,
}

impl Body {
    /// Standard deviation of one position, along each axis, with both parts of its error.
    #[must_use]
    pub fn position_error_m(&self) -> f64 {
        libm::hypot(self.position_noise_m, self.position_drift_m)
    }

    /// Its tool for a kind of acts.
    #[must_use]
    pub fn tool(&self, act: ActKind) -> Option<&Tool> {
        self.tools.iter().find(|tool| tool.act == act)
    }

    /// Whether it is the same body, except for what it knows of other robots.
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
    /// Radius of its footprint.
    #[schemars(range(min = 0.0))]
    pub radius_m: f64,
    /// Maximum acceleration and deceleration; infinite if speed changes instantly (`null` in JSON).
    #[serde(default = "at_once", with = "crate::io::infinite::number")]
    #[schemars(with = "Option<f64>", range(min = 0.0))]
    pub max_acceleration_m_s2: f64,
    /// Whether the two kinds can collide: not if one of them flies.
    pub is_in_the_way: bool,
    /// Its item detectors.
    #[serde(default)]
    pub detectors: Vec<Detector>,
}

/// An item detector.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Detector {
    /// Its index in [`Body::sensors`].
    pub sensor: u16,
    /// Maximum range from the centre of the robot.
    #[schemars(range(min = 0.0))]
    pub range_m: f64,
    /// Field of view.
    #[schemars(range(min = 0.0))]
    pub width_rad: f64,
    /// Direction of its centre, relative to the robot's front.
    pub facing_rad: f64,
    /// For each kind of item, pairs of distance in metres and probability of detection per
    /// measurement, by increasing distance, linear in between; none if it never detects that kind.
    pub detection_probability: Vec<Vec<[f64; 2]>>,
    /// Share of the items of each kind that it never detects, however often it looks; empty if it
    /// is 0 for all kinds.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(inner(range(min = 0.0, max = 1.0)))]
    pub blind_share: Vec<f64>,
    /// Share of the items of each kind (row) that look like each kind (column) to its model, however
    /// often it looks; empty if all look like what they are.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lookalike_share: Vec<Vec<f64>>,
    /// Probability of each reported kind (column) by the kind that a detected item looks like (row);
    /// empty if kinds are reported as they are.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub confusion: Vec<Vec<f64>>,
    /// The sensor model: detectors with the same number are blind to the same items, and the same
    /// items look like another kind to them.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub model: u32,
    /// False alarms of each kind per measurement and square metre in view.
    pub false_alarms_per_m2: Vec<f64>,
    /// Standard deviation of the measured position of a contact, along each axis.
    #[schemars(range(min = 0.0))]
    pub noise_m: f64,
    /// Whether obstacles hide items.
    pub needs_line_of_sight: bool,
}

/// The rays of a range sensor.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RangeRing {
    /// Direction of each ray relative to the robot's front, anticlockwise; above -pi, up to pi.
    #[schemars(inner(range(min = -3.15, max = 3.15)))]
    pub bearings_rad: Vec<f64>,
    /// Maximum range from the centre of the robot.
    #[schemars(range(min = 0.0))]
    pub range_m: f64,
    /// Time between two scans.
    #[schemars(range(min = 0.0))]
    pub period_s: f64,
    /// Delay from a scan until the brain has it.
    #[schemars(range(min = 0.0))]
    pub latency_s: f64,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
fn is_zero(number: &u32) -> bool {
    *number == 0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
fn is_exactly_zero(error: &f64) -> bool {
    *error == 0.0
}

fn at_once() -> f64 {
    f64::INFINITY
}
