//! What enters a brain.

use crate::io::body::RobotId;
use crate::io::command::Motion;
use crate::io::message::Message;
use alloc::vec::Vec;
use base::geometry::Point;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// All that a robot knows of this moment; any part of it may be missing.
///
/// Angles are from the robot's own front, anticlockwise, unless said otherwise.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Percept {
    /// Time since the mission began.
    pub time_s: f64,
    /// Random bits of this step, the only chance that a brain has.
    pub dice: [u32; 4],
    /// Which robot it is: it was told so before the mission.
    pub id: RobotId,
    /// How many robots of its kind there are, itself among them; 0 if it was not told.
    pub of_kind: u32,
    /// Where it is in the world.
    pub position: Option<Reading<Point>>,
    /// Its course: 0 along x, anticlockwise.
    pub heading_rad: Option<Reading<f64>>,
    /// How it moves, from its wheels or rotors. The simulator knows this, and what touches it and is
    /// in its battery, exactly and at once: what is as hard to know as in life has a sensor.
    pub motion: Option<Reading<Motion>>,
    /// Share of the battery's capacity that is left, 0 to 1.
    pub battery: Option<Reading<f64>>,
    /// Whether it touches something.
    pub touch: Option<Reading<bool>>,
    /// Of each range ring that its body has, in the body's order.
    pub scans: Vec<Scan>,
    /// Looks for items that its sensors took since the last step, also those that recognised none.
    pub looks: Vec<Look>,
    /// Items that its sensors recognised since the last step, or took for such.
    pub contacts: Vec<Contact>,
    /// Robots that its sensors recognised since the last step.
    pub neighbours: Vec<Neighbour>,
    /// What other robots told since the last step.
    pub inbox: Vec<Heard>,
}

/// A value, and how old it is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reading<T> {
    /// What was measured.
    pub value: T,
    /// Time since it was.
    pub age_s: f64,
}

/// What a range ring measured.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Scan {
    /// Time since it was measured; `None` if there is no scan.
    pub age_s: Option<f64>,
    /// From the robot's centre to what reflects, a value a ray in the order of the ring's bearings;
    /// infinite where nothing came back (`null` in JSON). Empty if there is no scan.
    #[serde(with = "crate::io::infinite::numbers")]
    #[schemars(with = "Vec<Option<f64>>")]
    pub ranges_m: Vec<f64>,
}

/// A look for items.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Look {
    /// Place of the sensor in [`Body::sensors`](crate::Body::sensors).
    pub sensor: u16,
    /// Time since it was taken.
    pub age_s: f64,
}

/// An item that a sensor recognised, or something that it took for one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Place of the item's kind in [`Body::item_kinds`](crate::Body::item_kinds).
    pub kind: u16,
    /// Place of the sensor in [`Body::sensors`](crate::Body::sensors).
    #[serde(default)]
    pub sensor: u16,
    /// From the robot's centre, when it was measured.
    pub range_m: f64,
    /// From the robot's front, when it was measured; above -pi, up to pi.
    pub bearing_rad: f64,
    /// Time since it was measured.
    pub age_s: f64,
}

/// A robot that a sensor recognised.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Neighbour {
    /// From centre to centre, when it was measured.
    pub range_m: f64,
    /// From the robot's front, when it was measured; above -pi, up to pi.
    pub bearing_rad: f64,
    /// Where it goes, from the robot's front, when it was measured, from -pi to pi; `None` if the
    /// sensor tells no courses.
    #[serde(default)]
    pub course_rad: Option<f64>,
    /// Time since it was measured.
    pub age_s: f64,
    /// Which robot it is.
    pub id: RobotId,
}

/// A message that came in.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Heard {
    /// Who sent it.
    pub from: RobotId,
    /// Time since it was sent.
    pub age_s: f64,
    /// What was sent.
    pub message: Message,
}
