//! Commands: the output of a brain.

use super::message::Message;
use alloc::vec::Vec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// All that a brain wants of its body in this step.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Command {
    /// How to move; the body does what it can of it.
    pub motion: Motion,
    /// Sensors to switch; each stays so until it is switched again. All are on at first.
    pub requests: Vec<SensorRequest>,
    /// What to tell other robots.
    pub outbox: Vec<Message>,
}

/// A speed and a rate of turn.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Motion {
    /// Ahead; negative is backwards.
    pub speed_m_s: f64,
    /// Anticlockwise.
    pub turn_rate_rad_s: f64,
}

/// A sensor to be switched on or off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SensorRequest {
    /// Place of the sensor in [`Body::sensors`](crate::Body::sensors).
    pub sensor: u16,
    /// Whether it is to measure.
    pub on: bool,
}
