//! Percepts: the input of a brain.

use crate::io::act::Acted;
use crate::io::agent_id::AgentId;
use crate::io::command::Motion;
use crate::io::message::Message;
use alloc::vec::Vec;
use base::geometry::Point;
use base::hash::Hash;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

/// All that a robot knows at one moment; any part may be missing.
///
/// Angles are relative to the robot's front, anticlockwise, unless stated otherwise.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Percept {
    /// Time since the mission began. Without it, one period after the previous percept. A percept
    /// that is not later than the previous one is ignored.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "number")]
    #[schemars(with = "f64")]
    pub time_s: Option<f64>,
    /// Random bits of this step, the only source of randomness of a brain.
    pub random_words: [u32; 4],
    /// The id of the robot, known before the mission.
    pub id: AgentId,
    /// Number of robots of its kind, itself included; 0 if unknown.
    pub team_size: u32,
    /// Its position in the world.
    pub position: Option<Reading<Point>>,
    /// Its heading: 0 along x, anticlockwise.
    pub heading_rad: Option<Reading<f64>>,
    /// Its motion, measured by its wheels or rotors. The simulator provides motion, contact and
    /// battery exactly and without delay; everything that is as hard to know as in reality has a
    /// sensor.
    pub motion: Option<Reading<Motion>>,
    /// Remaining fraction of the battery's capacity, 0 to 1.
    pub battery: Option<Reading<f64>>,
    /// Whether it touches something.
    pub touch: Option<Reading<bool>>,
    /// Scans of its range rings, in the order of the body.
    pub scans: Vec<Scan>,
    /// Measurements of its item detectors since the last step, including those without a contact.
    pub observations: Vec<Observation>,
    /// Contacts since the last step: detected items, and false alarms.
    pub contacts: Vec<Contact>,
    /// Robots that its sensors detected since the last step.
    pub neighbours: Vec<Neighbour>,
    /// Messages received since the last step.
    pub inbox: Vec<ReceivedMessage>,
    /// Results of its acts since the last step.
    pub acted: Vec<Acted>,
    /// Number of charges that are left; only of a robot with a tool that needs them.
    pub charges: Option<u32>,
}

impl Hashed for Percept {
    /// Acts and charges are added only if there are any: without them, hashes are those of percepts before acts existed.
    fn add_to(&self, hash: &mut Hash) {
        let Self {
            time_s,
            random_words,
            id,
            team_size,
            position,
            heading_rad,
            motion,
            battery,
            touch,
            scans,
            observations,
            contacts,
            neighbours,
            inbox,
            acted,
            charges,
        } = self;
        time_s.add_to(hash);
        random_words.add_to(hash);
        id.add_to(hash);
        team_size.add_to(hash);
        position.add_to(hash);
        heading_rad.add_to(hash);
        motion.add_to(hash);
        battery.add_to(hash);
        touch.add_to(hash);
        scans.add_to(hash);
        observations.add_to(hash);
        contacts.add_to(hash);
        neighbours.add_to(hash);
        inbox.add_to(hash);
        if !acted.is_empty() || charges.is_some() {
            acted.add_to(hash);
            charges.add_to(hash);
        }
    }
}

/// A value, and its age.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "{T}Reading")]
pub struct Reading<T> {
    /// The measured value.
    pub value: T,
    /// Time since the measurement.
    pub age_s: f64,
}

/// A measurement of a range ring.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(default, deny_unknown_fields)]
pub struct Scan {
    /// Time since the measurement; `None` without a scan.
    pub age_s: Option<f64>,
    /// Distances from the centre of the robot, one per ray in the order of the ring's bearings;
    /// infinite without a return (`null` in JSON). Empty without a scan.
    #[serde(with = "crate::io::infinite::numbers")]
    #[schemars(with = "Vec<Option<f64>>")]
    pub ranges_m: Vec<f64>,
}

/// A measurement of an item detector.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Observation {
    /// Index of the sensor in [`Body::sensors`](crate::Body::sensors).
    pub sensor: u16,
    /// Time since the measurement.
    pub age_s: f64,
}

/// A detected item, or a false alarm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Index of the item's kind in [`Body::item_kinds`](crate::Body::item_kinds).
    pub kind: u16,
    /// Index of the sensor in [`Body::sensors`](crate::Body::sensors).
    #[serde(default)]
    pub sensor: u16,
    /// Distance from the centre of the robot at the time of measurement.
    pub range_m: f64,
    /// Relative to the robot's front at the time of measurement; above -pi, up to pi.
    pub bearing_rad: f64,
    /// Time since the measurement.
    pub age_s: f64,
}

/// A detected robot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Neighbour {
    /// Distance from centre to centre at the time of measurement.
    pub range_m: f64,
    /// Relative to the robot's front at the time of measurement; above -pi, up to pi.
    pub bearing_rad: f64,
    /// Its heading relative to the robot's front at the time of measurement, from -pi to pi; `None`
    /// if the sensor does not measure headings.
    #[serde(default)]
    pub course_rad: Option<f64>,
    /// Time since the measurement.
    pub age_s: f64,
    /// How far its centre may be from there, beyond the errors of the sensor, as that of a real robot
    /// among simulated ones.
    #[serde(default, skip_serializing_if = "is_exact")]
    #[schemars(range(min = 0.0))]
    pub uncertainty_m: f64,
    /// Its id.
    pub id: AgentId,
}

impl Hashed for Neighbour {
    /// An uncertainty is added only if there is one.
    fn add_to(&self, hash: &mut Hash) {
        let Self {
            range_m,
            bearing_rad,
            course_rad,
            age_s,
            uncertainty_m,
            id,
        } = self;
        range_m.add_to(hash);
        bearing_rad.add_to(hash);
        course_rad.add_to(hash);
        age_s.add_to(hash);
        id.add_to(hash);
        if !is_exact(uncertainty_m) {
            uncertainty_m.add_to(hash);
        }
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
fn is_exact(uncertainty_m: &f64) -> bool {
    *uncertainty_m == 0.0
}

/// A received message.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct ReceivedMessage {
    /// The sender.
    pub from: AgentId,
    /// Time since it was sent.
    pub age_s: f64,
    /// The message.
    pub message: Message,
}

/// Reads a number that may be omitted, but not be `null`, which stands for infinity in JSON.
fn number<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    f64::deserialize(from).map(Some)
}
