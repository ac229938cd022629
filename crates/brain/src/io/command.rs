//! Commands: the output of a brain.

use super::act::Act;
use super::message::Message;
use alloc::vec::Vec;
use base::hash::Hash;
use base::hashed::Hashed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The output of a brain in one step.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Command {
    /// The motion setpoint; the body executes it as far as it can.
    pub motion: Motion,
    /// The heading at which the turn that `motion` is part of ends, in radians from the x axis,
    /// anticlockwise, above -pi and at most pi; only while the robot turns on the spot to a known
    /// heading. A body that has a heading controller can turn there by itself; others ignore it.
    pub heading_rad: Option<f64>,
    /// Sensors to switch on or off; each stays so until it is switched again. Initially all are on.
    pub requests: Vec<SensorRequest>,
    /// Messages to other robots.
    pub outbox: Vec<Message>,
    /// What to do to items; at most 4 in a step. One that takes time continues while the commands repeat it and the robot
    /// is stationary.
    pub acts: Vec<Act>,
}

impl Hashed for Command {
    /// Acts are added only if there are any: without them, hashes are those of commands before acts existed.
    fn add_to(&self, hash: &mut Hash) {
        let Self {
            motion,
            heading_rad,
            requests,
            outbox,
            acts,
        } = self;
        motion.add_to(hash);
        heading_rad.add_to(hash);
        requests.add_to(hash);
        outbox.add_to(hash);
        if !acts.is_empty() {
            acts.add_to(hash);
        }
    }
}

/// A speed and a turn rate.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(default, deny_unknown_fields)]
pub struct Motion {
    /// Forward; negative is reverse.
    pub speed_m_s: f64,
    /// Anticlockwise.
    pub turn_rate_rad_s: f64,
}

/// A request to switch a sensor on or off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Hashed)]
#[serde(deny_unknown_fields)]
pub struct SensorRequest {
    /// Index of the sensor in [`Body::sensors`](crate::Body::sensors).
    pub sensor: u16,
    /// Whether it measures.
    pub on: bool,
}
