//! Radios: range, loss and delay.

pub(crate) mod arrivals;
pub(crate) mod channel;

use crate::schedule::steps_of;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A radio that broadcasts to every robot in range.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RadioSpec {
    /// Range within which other robots receive its messages, in metres.
    #[schemars(range(min = 0.0, max = 1e6))]
    pub range_m: f64,
    /// Probability that one receiver misses a message.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub loss_probability: f64,
    /// Delay from sending to receiving, in seconds; at least one step.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub delay_s: f64,
    /// Maximum number of messages that the radio sends in one step, and that it receives in one
    /// step. Of more, it receives those to itself first, then one of each sender, in random order.
    #[serde(default = "four")]
    #[schemars(range(max = 1000))]
    pub messages_per_step: u32,
    /// Whether obstacles block its messages.
    #[serde(default)]
    pub needs_line_of_sight: bool,
    /// Power while the robot is active, in watts.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e6))]
    pub power_w: f64,
}

impl RadioSpec {
    /// Time from sending a message to receiving it, where steps have this duration.
    pub(crate) fn trip_s(&self, step_s: f64) -> f64 {
        self.delay_s.max(step_s)
    }
}

fn four() -> u32 {
    4
}

/// A radio, converted for the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Radio {
    pub(crate) range_m: f64,
    pub(crate) loss_probability: f64,
    /// At least 1.
    pub(crate) delay_steps: u64,
    pub(crate) messages_per_step: usize,
    pub(crate) needs_line_of_sight: bool,
    pub(crate) power_w: f64,
}

impl Radio {
    pub(crate) fn new(spec: &RadioSpec, step_s: f64) -> Self {
        Self {
            range_m: spec.range_m,
            loss_probability: spec.loss_probability,
            delay_steps: steps_of(spec.delay_s, step_s).max(1),
            messages_per_step: spec.messages_per_step as usize,
            needs_line_of_sight: spec.needs_line_of_sight,
            power_w: spec.power_w,
        }
    }
}
